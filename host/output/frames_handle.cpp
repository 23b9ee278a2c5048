#include "output/frames_handle.hpp"

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <system_error>

#include "error.hpp"
#include "output/file.hpp"

namespace rouleau::host {

namespace {

/// HDF5 keeps the system's errno only in the text of its innermost error: "..., errno = 28, error message = '...',
/// ...".
struct Innermost {
  int error = 0;
  std::string words;
};

herr_t visit(unsigned, const H5E_error2_t* entry, void* client) {
  auto& innermost = *static_cast<Innermost*>(client);
  const std::string_view words = entry->desc != nullptr ? entry->desc : "";
  if (innermost.words.empty()) innermost.words = words;
  constexpr std::string_view key = "errno = ";
  const auto at = words.find(key);
  if (innermost.error == 0 && at != std::string_view::npos) innermost.error = std::atoi(words.data() + at + key.size());
  return 0;
}

}  // namespace

Hdf5File::Hdf5File(std::filesystem::path file, Mode mode) : file_(std::move(file)), mode_(mode) {
  // HDF5's own clean-up at exit crashes on a file that could not be closed because the disk is full. It has nothing to
  // do: every identifier here is owned. Only the first call counts, and it must come before any other of HDF5.
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown, not printed
  const auto access = owned(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "");
  // Smaller object headers than the default; readable by every HDF5 since 1.8, and after a crash too.
  check(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18), "");
  if (mode == Mode::read) {
    handle_ = owned(H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "");
    return;
  }
  const auto creation = untimed(H5P_FILE_CREATE, "");
  handle_ = owned(H5Fcreate(file_.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose, "");
}

Hdf5Handle Hdf5File::untimed(hid_t kind, const std::string& path) const {
  auto properties = owned(H5Pcreate(kind), H5Pclose, path);
  check(H5Pset_obj_track_times(properties.id(), false), path);
  return properties;
}

Hdf5Handle Hdf5File::owned(hid_t id, Hdf5Handle::Close closer, const std::string& path) const {
  if (id < 0) fail(path);
  return {id, closer};
}

void Hdf5File::check(herr_t status, const std::string& path) const {
  if (status < 0) fail(path);
}

void Hdf5File::fail(const std::string& path) const {
  Innermost innermost;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, visit, &innermost);
  const std::string what =
      std::string(path.empty() ? "" : path + " ") + (mode_ == Mode::create ? "cannot be written" : "cannot be read");
  if (innermost.error != 0 && mode_ == Mode::create) fail_file(file_, what, innermost.error);
  if (innermost.error != 0)
    throw Error(ExitCode::input_output, Place{file_.string(), "", 0, 0},
                what + ": " + std::generic_category().message(innermost.error));
  throw Error(ExitCode::input_output, Place{file_.string(), "", 0, 0},
              what + ": HDF5 says \"" + (innermost.words.empty() ? "unknown error" : innermost.words) + "\"");
}

Hdf5Handle Hdf5File::make_group(const std::string& path) {
  const auto creation = untimed(H5P_GROUP_CREATE, path);
  return owned(H5Gcreate2(handle_.id(), path.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Gclose, path);
}

bool Hdf5File::has(const std::string& path) const {
  // H5Lexists wants every step of the way to exist.
  for (std::size_t at = path.find('/', 1); at != std::string::npos; at = path.find('/', at + 1))
    if (H5Lexists(handle_.id(), path.substr(0, at).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(handle_.id(), path.c_str(), H5P_DEFAULT) > 0;
}

int Hdf5File::members(const std::string& path) const {
  H5G_info_t info;
  check(H5Gget_info_by_name(handle_.id(), path.c_str(), &info, H5P_DEFAULT), path);
  return static_cast<int>(info.nlinks);
}

void Hdf5File::write(const std::string& path, const std::vector<hsize_t>& shape, hid_t stored, hid_t given,
                     const void* data, const std::string& unit, bool compressed) {
  const auto space = owned(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose, path);
  const auto layout = untimed(H5P_DATASET_CREATE, path);
  const bool any = std::all_of(shape.begin(), shape.end(), [](hsize_t n) { return n > 0; });
  if (compressed && any) {
    auto chunk = shape;
    hsize_t row = H5Tget_size(stored);
    for (std::size_t i = 1; i < shape.size(); ++i) row *= shape[i];
    chunk[0] = std::clamp<hsize_t>((hsize_t{1} << 20) / row, 1, shape[0]);
    check(H5Pset_chunk(layout.id(), static_cast<int>(chunk.size()), chunk.data()), path);
    check(H5Pset_shuffle(layout.id()), path);
    check(H5Pset_deflate(layout.id(), 1), path);  // level 4 takes twice as long for files 2 % smaller
  }
  auto dataset =
      owned(H5Dcreate2(handle_.id(), path.c_str(), stored, space.id(), H5P_DEFAULT, layout.id(), H5P_DEFAULT), H5Dclose,
            path);
  if (any) check(H5Dwrite(dataset.id(), given, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), path);
  if (!dataset.close()) fail(path);
  attribute(path, "unit", unit);
}

void Hdf5File::write(const std::string& path, const std::vector<double>& values, const std::string& unit) {
  write(path, {values.size()}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data(), unit);
}

void Hdf5File::write(const std::string& path, const std::vector<int>& values, const std::string& unit) {
  write(path, {values.size()}, H5T_STD_I32LE, H5T_NATIVE_INT, values.data(), unit);
}

void Hdf5File::link(const std::string& existing, const std::string& path) {
  check(H5Lcreate_hard(handle_.id(), existing.c_str(), handle_.id(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT), path);
}

void Hdf5File::attribute(const std::string& path, const std::string& name, hid_t stored, hid_t given, hsize_t count,
                         const void* value) {
  const auto space = count == 0 ? owned(H5Screate(H5S_SCALAR), H5Sclose, path)
                                : owned(H5Screate_simple(1, &count, nullptr), H5Sclose, path);
  auto attribute = owned(H5Acreate_by_name(handle_.id(), path.c_str(), name.c_str(), stored, space.id(), H5P_DEFAULT,
                                           H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, path);
  check(H5Awrite(attribute.id(), given, value), path);
  if (!attribute.close()) fail(path);
}

void Hdf5File::attribute(const std::string& path, const std::string& name, double value) {
  attribute(path, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 0, &value);
}

void Hdf5File::attribute(const std::string& path, const std::string& name, long value) {
  attribute(path, name, H5T_STD_I64LE, H5T_NATIVE_LONG, 0, &value);
}

void Hdf5File::attribute(const std::string& path, const std::string& name, const std::vector<double>& value) {
  attribute(path, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, value.size(), value.data());
}

void Hdf5File::attribute(const std::string& path, const std::string& name, const std::string& value) {
  const auto type = owned(H5Tcopy(H5T_C_S1), H5Tclose, path);
  check(H5Tset_size(type.id(), H5T_VARIABLE), path);  // h5py makes these str and fixed ones bytes
  check(H5Tset_cset(type.id(), H5T_CSET_UTF8), path);
  const char* const text = value.c_str();
  attribute(path, name, type.id(), type.id(), 0, &text);
}

std::vector<double> Hdf5File::read(const std::string& path) const {
  const auto dataset = owned(H5Dopen2(handle_.id(), path.c_str(), H5P_DEFAULT), H5Dclose, path);
  const auto space = owned(H5Dget_space(dataset.id()), H5Sclose, path);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  if (count < 0) fail(path);
  std::vector<double> values(static_cast<std::size_t>(count));
  if (count > 0) check(H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
  return values;
}

double Hdf5File::read_attribute(const std::string& path, const std::string& name, std::size_t index) const {
  const auto attribute = owned(H5Aopen_by_name(handle_.id(), path.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose, path + "@" + name);
  const auto space = owned(H5Aget_space(attribute.id()), H5Sclose, path);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  if (count <= static_cast<hssize_t>(index)) fail(path + "@" + name);
  std::vector<double> values(static_cast<std::size_t>(count));
  check(H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, values.data()), path + "@" + name);
  return values[index];
}

void Hdf5File::flush() { check(H5Fflush(handle_.id(), H5F_SCOPE_GLOBAL), ""); }

void Hdf5File::close() {
  if (!handle_.close()) fail("");
}

}  // namespace rouleau::host
