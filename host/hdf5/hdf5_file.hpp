// HDF5 files, and HDF5's failures as the host's errors.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "handle.hpp"

namespace rouleau::hdf5 {

class Rows;  // hdf5_rows.hpp

/// Makes and reads what Rouleau's HDF5 files are made of. Every member throws Error(input_output) naming the file.
/// Nothing is read from elsewhere: a link leads to a regular file in the same folder, as frames.h5 does to its
/// segments, or is refused, and so is a dataset whose values lie in other files (external storage, virtual datasets).
class File {
 public:
  enum class Mode {
    create,
    read,
    memory  ///< create, without a file
  };
  /// `user_block`: bytes at the beginning of a new file that HDF5 leaves alone; a power of two from 512 on, or 0.
  File(std::filesystem::path file, Mode mode, hsize_t user_block = 0);

  [[nodiscard]] const std::filesystem::path& path() const { return file_; }
  Handle make_group(const std::string& path);
  [[nodiscard]] bool has(const std::string& path) const;
  /// Number of members of a group.
  [[nodiscard]] int members(const std::string& path) const;

  /// Writes a dataset of this shape (slowest index first), with its unit as an attribute. `stored` is the type in the
  /// file, `given` that of `data`. A compressed one is chunked by rows of about 1 MiB, shuffled and deflated with
  /// that level (1 to 9; level 4 takes twice as long as 1 for files 2 % smaller).
  void write(const std::string& path, const std::vector<hsize_t>& shape, hid_t stored, hid_t given, const void* data,
             const std::string& unit, int compression = 0);
  /// The same dataset, byte for byte, from some of its rows at a time. They are counted over the first axis, in a
  /// dataset of layers of rows over the second one and then the first. Nothing else is written to the file before it is
  /// full.
  [[nodiscard]] Rows begin(const std::string& path, const std::vector<hsize_t>& shape, bool layers, hid_t stored,
                           hid_t given, const std::string& unit, int compression = 0);
  void write(const std::string& path, const std::vector<double>& values, const std::string& unit);
  void write(const std::string& path, const std::vector<int>& values, const std::string& unit);
  /// Names of a group's members, sorted.
  [[nodiscard]] std::vector<std::string> names(const std::string& path) const;
  /// Where an object lies in the file: equal for two names of one object.
  [[nodiscard]] haddr_t address(const std::string& path) const;
  /// What the values of a dataset are: H5T_FLOAT, H5T_STRING, ...
  [[nodiscard]] H5T_class_t kind(const std::string& path) const;
  /// A dataset of texts, of at most 1000 letters where they are of one length.
  [[nodiscard]] std::vector<std::string> read_texts(const std::string& path) const;
  /// Elements of a dataset.
  [[nodiscard]] std::size_t elements(const std::string& path) const;
  /// Copies an object's attributes to an object that exists here.
  void copy_attributes(const File& from, const std::string& path);
  /// A name for an object at the same place in another file; a relative path is one from this file's folder.
  void link_to(const std::filesystem::path& file, const std::string& path);
  /// A second name for a dataset.
  void link(const std::string& existing, const std::string& path);

  void attribute(const std::string& path, const std::string& name, double value);
  void attribute(const std::string& path, const std::string& name, long value);
  void attribute(const std::string& path, const std::string& name, const std::string& value);
  void attribute(const std::string& path, const std::string& name, const char* value) {
    attribute(path, name, std::string(value));
  }
  void attribute(const std::string& path, const std::string& name, const std::vector<double>& value);

  [[nodiscard]] std::vector<double> read(const std::string& path) const;
  /// All elements of a dataset, as values of type `wanted`.
  void read(const std::string& path, hid_t wanted, void* values) const;
  /// The elements [begin[k], end[k]) along every axis k of a dataset, slowest first.
  void read(const std::string& path, hid_t wanted, const std::vector<hsize_t>& begin, const std::vector<hsize_t>& end,
            void* values) const;
  /// Sizes of a dataset, slowest index first.
  [[nodiscard]] std::vector<std::size_t> shape(const std::string& path) const;
  [[nodiscard]] bool has_attribute(const std::string& path, const std::string& name) const;
  [[nodiscard]] double read_attribute(const std::string& path, const std::string& name, std::size_t index = 0) const;

  /// Hands everything written so far to the system.
  void flush();
  void close();

 private:
  friend class Rows;
  void attribute(const std::string& path, const std::string& name, hid_t stored, hid_t given, hsize_t count,
                 const void* value);
  /// Refuses a number that the file cannot hold.
  [[nodiscard]] std::size_t elements_of(const Handle& dataset, const std::string& path) const;
  Handle owned(hid_t id, Handle::Close closer, const std::string& path) const;
  /// Creation properties without time stamps, which would make the same run give other bytes at another time.
  [[nodiscard]] Handle untimed(hid_t kind, const std::string& path) const;
  void check(herr_t status, const std::string& path) const;
  [[noreturn]] void fail(const std::string& path) const;
  [[noreturn]] void refuse(const std::string& path, const std::string& why) const;
  [[nodiscard]] Handle dataset(const std::string& path) const;

  std::filesystem::path file_;
  Mode mode_;
  std::unique_ptr<std::string> foreign_ = std::make_unique<std::string>();  ///< file that a link must not lead to
  Handle links_;                                                            ///< how links are followed
  Handle handle_;
};

}  // namespace rouleau::hdf5
