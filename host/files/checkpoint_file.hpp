// checkpoint.h5: the state of a run in a file that is whole or not there, and that knows when it is damaged.
//
// The first 512 bytes are text: the format, and the length and checksum (XXH3, 64 bits) of the HDF5 file that follows
// them; HDF5's own programs and h5py skip them.
//
//   /facts   JSON text: whose state it is and when (run/checkpoint.hpp)
//   /state   CBOR (RFC 8949), which holds every number to its last bit, not-a-number too: everything that is small
//   others   arrays, in lattice units
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "json/json.hpp"

namespace rouleau::files {

/// The checkpoint of a directory, and the one before it, which is kept.
std::filesystem::path checkpoint_file(const std::filesystem::path& directory);
std::filesystem::path previous_checkpoint_file(const std::filesystem::path& directory);

/// Every member throws Error(input_output).
class CheckpointWriter {
 public:
  /// Begins a file beside the directory's checkpoint.
  explicit CheckpointWriter(std::filesystem::path directory);
  /// Removes a file that has not taken its place.
  ~CheckpointWriter();
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;

  void facts(const nlohmann::json& facts);
  void state(const nlohmann::json& state);
  /// Begins an array of `rows` times `columns` values, or of so many without columns, at "/name" or "/group/name";
  /// groups are made. append() adds its rows, or values, the first ones first; nothing else is written before they are
  /// all there.
  /// `single`: the file has them in single precision.
  void begin_array(const std::string& path, std::size_t rows, std::size_t columns, bool single = false);
  void begin_array(const std::string& path, std::size_t count);
  void append(const std::vector<double>& rows);
  /// Nothing can be added after it: the file is whole and on the disk, and still beside the checkpoint.
  void finish();
  /// After finish(): it becomes the directory's checkpoint, and that becomes the previous one.
  void take_place();
  [[nodiscard]] std::uintmax_t bytes() const { return bytes_; }

 private:
  struct File;
  std::filesystem::path directory_, partial_;
  std::unique_ptr<File> file_;
  std::uintmax_t bytes_ = 0;
};

/// Every member throws Error(input_output).
class CheckpointReader {
 public:
  /// Opens a checkpoint after its checksum has been found right.
  explicit CheckpointReader(const std::filesystem::path& file);
  ~CheckpointReader();
  CheckpointReader(const CheckpointReader&) = delete;
  CheckpointReader& operator=(const CheckpointReader&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Where it is the directory's previous checkpoint, it becomes the last one again, in place of a damaged one.
  void take_place(const std::filesystem::path& directory) const;
  [[nodiscard]] nlohmann::json facts() const;
  [[nodiscard]] nlohmann::json state() const;
  /// Throws Error(input_output): the file is whole, but not what this program keeps in a checkpoint.
  [[noreturn]] void refuse(const std::string& what) const;
  [[nodiscard]] bool has(const std::string& path) const;
  [[nodiscard]] std::vector<double> array(const std::string& path) const;
  /// An array that must have just so many values.
  void array(const std::string& path, std::size_t count, double* values) const;
  /// Values [begin, end) of it.
  void part(const std::string& path, std::size_t count, std::size_t begin, std::size_t end, double* values) const;
  /// Rows [begin[1], end[1]) and columns [begin[0], end[0]) of an array of size[1] times size[0] values.
  using Pair = std::array<int, 2>;
  void block(const std::string& path, Pair size, Pair begin, Pair end, double* values) const;

 private:
  struct File;
  std::filesystem::path path_;
  std::unique_ptr<File> file_;
};

}  // namespace rouleau::files
