// Where the fields of a run lie, read back from its frames.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "hdf5_file.hpp"

namespace rouleau::files {

/// The nodes that fields were written at: the lattice, or where the scene says so a region of it, or one in so many.
struct FieldNodes {
  /// Of a field of a frames.h5. Throws Error(input_output).
  FieldNodes(const Hdf5File& file, const std::string& dataset);
  /// Lower left corner and size of what the nodes stand for, m.
  struct Box {
    std::array<double, 2> first, size;
  };
  [[nodiscard]] Box box() const;
  /// A field's values on these nodes; in three dimensions on those of the layer in the middle of z.
  [[nodiscard]] std::vector<double> section(const Hdf5File& file, const std::string& dataset) const;
  std::size_t nx = 0, ny = 0;
  std::size_t nz = 1;                        ///< layers that the field has
  std::array<double, 2> spacing{}, first{};  ///< m
  std::array<bool, 2> periodic{};
};

}  // namespace rouleau::files
