// Where the fields of a run lie, and its last velocities, read back from its frames.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hdf5/hdf5_file.hpp"

namespace rouleau::files {

struct VelocityField {
  double time;        ///< s
  std::size_t stage;  ///< number of the scene's stage
  std::size_t nx;
  std::vector<double> y, z;      ///< of the rows, m; in two dimensions one z, 0
  std::vector<double> velocity;  ///< m/s, three components beside each other, then x, y, z
};

/// Nothing where no frame has a velocity. Throws Error(input_output).
std::optional<VelocityField> last_velocity(const std::filesystem::path& frames);

/// The nodes that fields were written at: the lattice, or where the scene says so a region of it, or one in so many.
struct FieldNodes {
  /// Of a field of a frames.h5. Throws Error(input_output).
  FieldNodes(const hdf5::File& file, const std::string& dataset);
  /// Lower left corner and size of what the nodes stand for, m.
  struct Box {
    std::array<double, 2> first, size;
  };
  [[nodiscard]] Box box() const;
  /// A field's values on rows [begin, end) of these nodes, a vector's components beside each other; in three dimensions
  /// of the layer in the middle of z. Throws Error(input_output), also where the field is one of other nodes.
  [[nodiscard]] std::vector<double> rows(const hdf5::File& file, const std::string& dataset, std::size_t begin,
                                         std::size_t end) const;
  /// Of all rows.
  [[nodiscard]] std::vector<double> section(const hdf5::File& file, const std::string& dataset) const {
    return rows(file, dataset, 0, ny);
  }
  /// Of all rows of all layers.
  [[nodiscard]] std::vector<double> all(const hdf5::File& file, const std::string& dataset) const {
    return values(file, dataset, {0, nz}, {0, ny}, {0, nx});
  }
  /// On the plane across x through node nx / 2, all rows of all layers.
  [[nodiscard]] std::vector<double> across(const hdf5::File& file, const std::string& dataset) const {
    return values(file, dataset, {0, nz}, {0, ny}, {nx / 2, nx / 2 + 1});
  }
  std::size_t nx = 0, ny = 0;
  std::size_t nz = 1;                        ///< layers that the field has
  std::array<double, 3> spacing{}, first{};  ///< m; along z 0 in two dimensions
  std::array<bool, 2> periodic{};

 private:
  using Range = std::array<std::size_t, 2>;
  [[nodiscard]] std::vector<double> values(const hdf5::File& file, const std::string& dataset, Range layers, Range rows,
                                           Range columns) const;
};

}  // namespace rouleau::files
