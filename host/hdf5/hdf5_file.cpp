#include "hdf5_file.hpp"

#include <atomic>
#include <cerrno>
#include <string_view>
#include <system_error>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/text.hpp"

namespace rouleau::hdf5 {

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

/// Lets a link lead to a file in the same folder alone, where the segments of a run lie, and keeps the name of another.
herr_t stay_in_folder(const char* from, const char*, const char* to, const char*, unsigned* flags, hid_t,
                      void* foreign) {
  *flags = H5F_ACC_RDONLY;  // HDF5 refuses those of a file that is being made
  const std::filesystem::path file = std::filesystem::absolute(from).parent_path();
  std::error_code gone;
  const auto real = std::filesystem::canonical(file / to, gone), folder = std::filesystem::canonical(file, gone);
  if (!real.empty() && real.parent_path() == folder && std::filesystem::is_regular_file(real, gone)) return 0;
  *static_cast<std::string*>(foreign) = to;
  return -1;
}

}  // namespace

File::File(std::filesystem::path file, Mode mode, hsize_t user_block) : file_(std::move(file)), mode_(mode) {
  // HDF5's own clean-up at exit crashes on a file that could not be closed because the disk is full. It has nothing to
  // do: every identifier here is owned. Only the first call counts, and it must come before any other of HDF5.
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown, not printed
  const auto access = owned(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "");
  // Smaller object headers than the default; readable by every HDF5 since 1.8, and after a crash too.
  check(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18), "");
  links_ = owned(H5Pcreate(H5P_LINK_ACCESS), H5Pclose, "");
  check(H5Pset_elink_cb(links_.id(), stay_in_folder, foreign_.get()), "");
  if (mode == Mode::read) {
    static_cast<void>(InputFile(file_));  // HDF5 would wait for a pipe
    handle_ = owned(H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "");
    return;
  }
  // What a link leads to is not this run's to change.
  if (mode == Mode::create && std::filesystem::is_symlink(file_)) fail_file(file_, "cannot be created", ELOOP);
  if (mode == Mode::memory) check(H5Pset_fapl_core(access.id(), std::size_t{1} << 16, false), "");
  const auto creation = untimed(H5P_FILE_CREATE, "");
  check(H5Pset_userblock(creation.id(), user_block), "");
  // HDF5 takes two files of one name for the same, also in memory.
  static std::atomic<long> made{0};
  const std::string name = file_.string() + (mode == Mode::memory ? " in memory, " + std::to_string(++made) : "");
  handle_ = owned(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose, "");
}

Handle File::untimed(hid_t kind, const std::string& path) const {
  auto properties = owned(H5Pcreate(kind), H5Pclose, path);
  check(H5Pset_obj_track_times(properties.id(), false), path);
  return properties;
}

Handle File::owned(hid_t id, Handle::Close closer, const std::string& path) const {
  if (id < 0) fail(path);
  return {id, closer};
}

void File::check(herr_t status, const std::string& path) const {
  if (status < 0) fail(path);
}

void File::refuse(const std::string& path, const std::string& why) const {
  throw Error(Cause::input_output, Place{file_.string()}, path + ' ' + why + ": it is damaged",
              {"what belongs to a run lies in its own files; do not use this one unless you trust whoever made it"});
}

Handle File::dataset(const std::string& path) const {
  auto dataset = owned(H5Oopen(handle_.id(), path.c_str(), links_.id()), H5Oclose, path);
  if (H5Iget_type(dataset.id()) != H5I_DATASET) refuse(path, "is no dataset");
  const auto made = owned(H5Dget_create_plist(dataset.id()), H5Pclose, path);
  if (H5Pget_layout(made.id()) == H5D_VIRTUAL || H5Pget_external_count(made.id()) > 0)
    refuse(path, "takes its values from other files");
  return dataset;
}

void File::fail(const std::string& path) const {
  if (!foreign_->empty())
    refuse(path, "leads to " + in_quotes(std::exchange(*foreign_, {})) + ", which is no file in the same folder");
  Innermost innermost;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, visit, &innermost);
  const std::string what =
      std::string(path.empty() ? "" : path + " ") + (mode_ == Mode::create ? "cannot be written" : "cannot be read");
  if (innermost.error != 0 && mode_ == Mode::create) fail_file(file_, what, innermost.error);
  if (innermost.error == EAGAIN)  // HDF5's lock
    throw Error(Cause::input_output, Place{file_.string()},
                "is being written by a run: its frames can be read after the run's next checkpoint (every ten minutes "
                "unless output.checkpoint of the scene says otherwise), or at its end");
  if (innermost.error != 0)
    throw Error(Cause::input_output, Place{file_.string()},
                what + ": " + std::generic_category().message(innermost.error));
  throw Error(Cause::input_output, Place{file_.string()},
              what + ": HDF5 says \"" + (innermost.words.empty() ? "unknown error" : innermost.words) + "\"",
              {mode_ == Mode::read ? "the file is damaged: bring it back, or run the scene again" : ""});
}

Handle File::make_group(const std::string& path) {
  const auto creation = untimed(H5P_GROUP_CREATE, path);
  return owned(H5Gcreate2(handle_.id(), path.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Gclose, path);
}

bool File::has(const std::string& path) const {
  // H5Lexists wants every step of the way to exist.
  for (std::size_t at = path.find('/', 1); at != std::string::npos; at = path.find('/', at + 1))
    if (!has(path.substr(0, at))) return false;
  const htri_t found = H5Lexists(handle_.id(), path.c_str(), links_.id());
  if (found < 0 && !foreign_->empty()) fail(path);
  return found > 0;
}

int File::members(const std::string& path) const {
  H5G_info_t info;
  check(H5Gget_info_by_name(handle_.id(), path.c_str(), &info, links_.id()), path);
  return static_cast<int>(info.nlinks);
}

void File::write(const std::string& path, const std::vector<double>& values, const std::string& unit) {
  write(path, {values.size()}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data(), unit);
}

void File::write(const std::string& path, const std::vector<int>& values, const std::string& unit) {
  write(path, {values.size()}, H5T_STD_I32LE, H5T_NATIVE_INT, values.data(), unit);
}

std::vector<std::string> File::names(const std::string& path) const {
  std::vector<std::string> found;
  const auto group = owned(H5Oopen(handle_.id(), path.c_str(), links_.id()), H5Oclose, path);
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  check(H5Literate(group.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &found), path);
  return found;
}

haddr_t File::address(const std::string& path) const {
  H5O_info_t info;
  check(H5Oget_info_by_name(handle_.id(), path.c_str(), &info, links_.id()), path);
  return info.addr;
}

std::size_t File::elements(const std::string& path) const { return elements_of(dataset(path), path); }

std::size_t File::elements_of(const Handle& dataset, const std::string& path) const {
  const auto space = owned(H5Dget_space(dataset.id()), H5Sclose, path);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  if (count < 0) fail(path);
  const auto file = owned(H5Iget_file_id(dataset.id()), H5Fclose, path);  // another one behind a link_to()
  hsize_t bytes = 0;
  check(H5Fget_filesize(file.id(), &bytes), path);
  // A damaged extent must not use up the memory: deflate, at its best, makes one byte of 1032.
  if (static_cast<double>(count) > 1032.0 * static_cast<double>(bytes)) {
    throw Error(Cause::input_output, Place{file_.string()},
                path + " has " + std::to_string(count) + " numbers, more than the file can hold: it is damaged");
  }
  return static_cast<std::size_t>(count);
}

void File::copy_attributes(const File& from, const std::string& path) {
  const auto source = from.owned(H5Oopen(from.handle_.id(), path.c_str(), from.links_.id()), H5Oclose, path);
  const auto target = owned(H5Oopen(handle_.id(), path.c_str(), H5P_DEFAULT), H5Oclose, path);
  const int count = H5Aget_num_attrs(source.id());
  for (int i = 0; i < count; ++i) {
    const auto old = from.owned(
        H5Aopen_by_idx(source.id(), ".", H5_INDEX_NAME, H5_ITER_INC, static_cast<hsize_t>(i), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose, path);
    std::string name(static_cast<std::size_t>(H5Aget_name(old.id(), 0, nullptr)), '\0');
    H5Aget_name(old.id(), name.size() + 1, name.data());
    const auto type = from.owned(H5Aget_type(old.id()), H5Tclose, path);
    const auto space = from.owned(H5Aget_space(old.id()), H5Sclose, path);
    std::vector<char> value(H5Tget_size(type.id()) *
                            static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())));
    from.check(H5Aread(old.id(), type.id(), value.data()), path);
    auto copied =
        owned(H5Acreate2(target.id(), name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, path);
    const herr_t written = H5Awrite(copied.id(), type.id(), value.data());
    H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, value.data());  // texts of variable length
    check(written, path);
    if (!copied.close()) fail(path);
  }
}

void File::link_to(const std::filesystem::path& file, const std::string& path) {
  check(H5Lcreate_external(file.c_str(), path.c_str(), handle_.id(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT), path);
}

void File::link(const std::string& existing, const std::string& path) {
  check(H5Lcreate_hard(handle_.id(), existing.c_str(), handle_.id(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT), path);
}

void File::attribute(const std::string& path, const std::string& name, hid_t stored, hid_t given, hsize_t count,
                     const void* value) {
  const auto space = count == 0 ? owned(H5Screate(H5S_SCALAR), H5Sclose, path)
                                : owned(H5Screate_simple(1, &count, nullptr), H5Sclose, path);
  auto attribute = owned(H5Acreate_by_name(handle_.id(), path.c_str(), name.c_str(), stored, space.id(), H5P_DEFAULT,
                                           H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, path);
  check(H5Awrite(attribute.id(), given, value), path);
  if (!attribute.close()) fail(path);
}

void File::attribute(const std::string& path, const std::string& name, double value) {
  attribute(path, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 0, &value);
}

void File::attribute(const std::string& path, const std::string& name, long value) {
  attribute(path, name, H5T_STD_I64LE, H5T_NATIVE_LONG, 0, &value);
}

void File::attribute(const std::string& path, const std::string& name, const std::vector<double>& value) {
  attribute(path, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, value.size(), value.data());
}

void File::attribute(const std::string& path, const std::string& name, const std::string& value) {
  const auto type = owned(H5Tcopy(H5T_C_S1), H5Tclose, path);
  check(H5Tset_size(type.id(), H5T_VARIABLE), path);  // h5py makes these str and fixed ones bytes
  check(H5Tset_cset(type.id(), H5T_CSET_UTF8), path);
  const char* const text = value.c_str();
  attribute(path, name, type.id(), type.id(), 0, &text);
}

std::vector<double> File::read(const std::string& path) const {
  const auto dataset = this->dataset(path);
  std::vector<double> values(elements_of(dataset, path));
  if (!values.empty())
    check(H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
  return values;
}

void File::read(const std::string& path, hid_t wanted, void* values) const {
  const auto dataset = this->dataset(path);
  check(H5Dread(dataset.id(), wanted, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), path);
}

void File::read(const std::string& path, hid_t wanted, const std::vector<hsize_t>& begin,
                const std::vector<hsize_t>& end, void* values) const {
  const auto dataset = this->dataset(path);
  const auto space = owned(H5Dget_space(dataset.id()), H5Sclose, path);
  std::vector<hsize_t> count;
  for (std::size_t k = 0; k < begin.size(); ++k) count.push_back(end[k] - begin[k]);
  const auto memory = owned(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose, path);
  check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, begin.data(), nullptr, count.data(), nullptr), path);
  check(H5Dread(dataset.id(), wanted, memory.id(), space.id(), H5P_DEFAULT, values), path);
}

H5T_class_t File::kind(const std::string& path) const {
  const auto dataset = this->dataset(path);
  return H5Tget_class(owned(H5Dget_type(dataset.id()), H5Tclose, path).id());
}

std::vector<std::string> File::read_texts(const std::string& path) const {
  const auto dataset = this->dataset(path);
  const std::size_t count = elements_of(dataset, path);
  const auto stored = owned(H5Dget_type(dataset.id()), H5Tclose, path);
  const auto space = owned(H5Dget_space(dataset.id()), H5Sclose, path);
  const auto type = owned(H5Tcopy(H5T_C_S1), H5Tclose, path);
  const bool variable = H5Tis_variable_str(stored.id()) > 0;
  const std::size_t size = variable ? 0 : H5Tget_size(stored.id()) + 1;
  if (size > 1000) refuse(path, "has texts of " + std::to_string(size - 1) + " letters");
  check(H5Tset_cset(type.id(), H5Tget_cset(stored.id())), path);
  check(H5Tset_size(type.id(), variable ? H5T_VARIABLE : size), path);
  std::vector<char*> words(variable ? count : 0);
  std::vector<char> letters(count * size);
  void* const to = variable ? static_cast<void*>(words.data()) : letters.data();
  check(H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, to), path);
  std::vector<std::string> texts;
  texts.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const char* const word = variable ? words[i] : &letters[i * size];
    texts.emplace_back(word != nullptr ? word : "");
  }
  if (variable) H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, words.data());
  return texts;
}

std::vector<std::size_t> File::shape(const std::string& path) const {
  const auto dataset = this->dataset(path);
  const auto space = owned(H5Dget_space(dataset.id()), H5Sclose, path);
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (rank < 0) fail(path);
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  check(H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr), path);
  return {sizes.begin(), sizes.end()};
}

bool File::has_attribute(const std::string& path, const std::string& name) const {
  return H5Aexists_by_name(handle_.id(), path.c_str(), name.c_str(), links_.id()) > 0;
}

double File::read_attribute(const std::string& path, const std::string& name, std::size_t index) const {
  const auto attribute = owned(H5Aopen_by_name(handle_.id(), path.c_str(), name.c_str(), H5P_DEFAULT, links_.id()),
                               H5Aclose, path + "@" + name);
  const auto space = owned(H5Aget_space(attribute.id()), H5Sclose, path);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  if (count <= static_cast<hssize_t>(index)) fail(path + "@" + name);
  std::vector<double> values(static_cast<std::size_t>(count));
  check(H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, values.data()), path + "@" + name);
  return values[index];
}

void File::flush() { check(H5Fflush(handle_.id(), H5F_SCOPE_GLOBAL), ""); }

void File::close() {
  if (!handle_.close()) fail("");
}

}  // namespace rouleau::hdf5
