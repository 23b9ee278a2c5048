// HDF5's identifiers as values that close themselves, and its failures as the host's errors.
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace rouleau::host {

/// Owns one HDF5 identifier.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close closer) : id_(id), close_(closer) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  ~Hdf5Handle() { close(); }

  [[nodiscard]] hid_t id() const { return id_; }
  [[nodiscard]] bool valid() const { return id_ >= 0; }
  /// False when closing failed (a file's last data could not be written).
  bool close() noexcept { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// Makes and reads what Rouleau's HDF5 files are made of. Every member throws Error(input_output) naming the file.
class Hdf5File {
 public:
  enum class Mode { create, read };
  Hdf5File(std::filesystem::path file, Mode mode);

  Hdf5Handle make_group(const std::string& path);
  [[nodiscard]] bool has(const std::string& path) const;
  /// Number of members of a group.
  [[nodiscard]] int members(const std::string& path) const;

  /// Writes a dataset of this shape (slowest index first), with its unit as an attribute. `stored` is the type in the
  /// file, `given` that of `data`. A compressed one is chunked by rows of about 1 MiB, shuffled and deflated.
  void write(const std::string& path, const std::vector<hsize_t>& shape, hid_t stored, hid_t given, const void* data,
             const std::string& unit, bool compressed = false);
  void write(const std::string& path, const std::vector<double>& values, const std::string& unit);
  void write(const std::string& path, const std::vector<int>& values, const std::string& unit);
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
  [[nodiscard]] double read_attribute(const std::string& path, const std::string& name, std::size_t index = 0) const;

  /// Hands everything written so far to the system.
  void flush();
  void close();

 private:
  void attribute(const std::string& path, const std::string& name, hid_t stored, hid_t given, hsize_t count,
                 const void* value);
  Hdf5Handle owned(hid_t id, Hdf5Handle::Close closer, const std::string& path) const;
  /// Creation properties without time stamps, which would make the same run give other bytes at another time.
  [[nodiscard]] Hdf5Handle untimed(hid_t kind, const std::string& path) const;
  void check(herr_t status, const std::string& path) const;
  [[noreturn]] void fail(const std::string& path) const;

  std::filesystem::path file_;
  Mode mode_;
  Hdf5Handle handle_;
};

}  // namespace rouleau::host
