// Datasets that are written some rows at a time.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "hdf5_file.hpp"

namespace rouleau::hdf5 {

/// A dataset that is being written, its first rows first. Belongs to its file, which must outlive it. Every member
/// throws Error(input_output) naming the file.
class Rows {
 public:
  /// The next `count` rows. Of a compressed dataset rows are kept, a copy of them, until they fill a chunk: HDF5 would
  /// compress one that is filled in two goes twice. With the last row the dataset is finished.
  void append(const void* rows, std::size_t count);
  [[nodiscard]] bool full() const { return written_ == all_; }

 private:
  friend class File;
  Rows(File& file, std::string path, std::vector<hsize_t> shape, bool layers, hid_t given, std::string unit)
      : file_(&file),
        path_(std::move(path)),
        shape_(std::move(shape)),
        layers_(layers),
        given_(given),
        unit_(std::move(unit)) {}
  void put(const std::byte* rows, hsize_t count);
  void finish();

  File* file_;
  std::string path_;
  std::vector<hsize_t> shape_;
  bool layers_;
  hid_t given_;
  std::string unit_;
  Handle dataset_;
  hsize_t all_ = 0, written_ = 0;   ///< rows
  hsize_t together_ = 1;            ///< rows are written in multiples of this
  std::size_t bytes_of_row_ = 0;    ///< as they are given
  std::vector<std::byte> waiting_;  ///< rows that fill no chunk yet
};

}  // namespace rouleau::hdf5
