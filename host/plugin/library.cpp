#include "library.hpp"

#include <vector>

#include "base/synonyms.hpp"

// With the standard's file paths Boost.DLL is header-only and needs no other Boost library.
#define BOOST_DLL_USE_STD_FS
#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <sys/mman.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <atomic>
#include <boost/dll/shared_library.hpp>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>
#include <utility>

#include "base/input_file.hpp"
#include "exported_symbols.hpp"

namespace rouleau::plugin {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const Manifest& manifest, const std::string& problem, const Remedy& remedy = {}) {
  throw Error(Cause::plugin_refused, Place{manifest.file.string()},
              "the library " + manifest.library.string() + ' ' + problem, remedy);
}

/// Whole pages, with what lies between a library's variables, where an AddressSanitizer allows no reading.
__attribute__((no_sanitize("address"))) void copy_words(const void* from, void* to, std::size_t bytes) {
  const auto* const source = static_cast<const volatile std::uint64_t*>(from);  // volatile: or it becomes a memcpy
  auto* const copy = static_cast<std::uint64_t*>(to);
  for (std::size_t i = 0; i < bytes / sizeof(std::uint64_t); ++i) copy[i] = source[i];
}

void own(std::uintptr_t begin, std::uintptr_t end, int protection) {
  void* const copy = ::mmap(nullptr, end - begin, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (copy == MAP_FAILED) return;
  auto* const place = reinterpret_cast<void*>(begin);
  copy_words(place, copy, end - begin);
  if (::mprotect(copy, end - begin, protection) != 0 ||
      ::mremap(copy, end - begin, end - begin, MREMAP_MAYMOVE | MREMAP_FIXED, place) == MAP_FAILED)
    ::munmap(copy, end - begin);
}

int own_if_meant(dl_phdr_info* info, std::size_t, void* wanted) {
  if (info->dlpi_addr != static_cast<const link_map*>(wanted)->l_addr) return 0;
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto down = [&](std::uintptr_t address) { return address / page * page; };
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& part = info->dlpi_phdr[i];
    if (part.p_type != PT_LOAD || part.p_memsz == 0 || (part.p_flags & PF_R) == 0) continue;
    const std::uintptr_t begin = info->dlpi_addr + part.p_vaddr;
    const int protection =
        PROT_READ | ((part.p_flags & PF_W) != 0 ? PROT_WRITE : 0) | ((part.p_flags & PF_X) != 0 ? PROT_EXEC : 0);
    own(down(begin), down(begin + part.p_memsz + page - 1), protection);
  }
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& part = info->dlpi_phdr[i];  // what only the loader has written to
    const std::uintptr_t begin = down(info->dlpi_addr + part.p_vaddr);
    const std::uintptr_t end = down(info->dlpi_addr + part.p_vaddr + part.p_memsz);
    if (part.p_type == PT_GNU_RELRO && end > begin) ::mprotect(reinterpret_cast<void*>(begin), end - begin, PROT_READ);
  }
  return 1;
}

/// Puts copies in the places of a loaded library's pages, so that it stays what it is when somebody writes to its file
/// or cuts it short. `handle`: as dlopen gave it. Where the system refuses, pages stay as they are.
void own_pages(void* handle) {
  link_map* map = nullptr;
  if (::dlinfo(handle, RTLD_DI_LINKMAP, &map) == 0 && map != nullptr) dl_iterate_phdr(&own_if_meant, map);
}

/// What the dynamic loader says of a file that is not there.
std::string loader_words(const fs::path& file) {
  dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  const char* words = dlerror();
  return words != nullptr ? words : "";
}

/// The library's file with all links followed, which must lie in the manifest's own folder.
fs::path library_file(const Manifest& manifest) {
  std::error_code error;
  const fs::path folder = fs::canonical(manifest.file.parent_path().empty() ? "." : manifest.file.parent_path(), error);
  if (error) refuse(manifest, "cannot be looked for: " + error.message());
  fs::path library = fs::canonical(manifest.library, error);
  if (error == std::errc::no_such_file_or_directory) {
    refuse(manifest,
           fs::is_symlink(fs::symlink_status(manifest.library))
               ? "is a link to a file that does not exist"
               : "does not exist; it must lie in the folder of its manifest\n  " + loader_words(manifest.library));
  }
  if (error) refuse(manifest, "cannot be opened: " + error.message());
  if (library.parent_path() != folder)
    refuse(manifest, "leads out of the folder of its manifest, to " + library.string());
  if (!fs::is_regular_file(library, error)) refuse(manifest, "is not a regular file");
  return library;
}

/// A file as it was when the manifest was read: what is kept of a file is kept of that, for while the process lives
/// somebody may build the library anew.
using Version = std::pair<fs::path, FileStamp>;
/// By the name in the manifest: what is kept is whole, whatever has become of the file. Locked, it is another's word.
Version version_of(const Manifest& manifest) {
  fs::path name = manifest.library;
  if (manifest.locked) name += ':' + manifest.locked->sha256;
  return {name, manifest.library_stamp};
}

/// What is kept of each version for as long as the process lives, whatever thread asks.
template <class Value>
class Kept {
 public:
  /// Null: nothing yet.
  Value* find(const Version& version) {
    const std::lock_guard lock(mutex_);
    const auto known = values_.find(version);
    return known == values_.end() ? nullptr : &known->second;
  }
  Value& put(const Version& version, Value value) {
    const std::lock_guard lock(mutex_);
    return values_.try_emplace(version, std::move(value)).first->second;
  }

 private:
  std::mutex mutex_;
  std::map<Version, Value> values_;
};

/// Throws where another library lies there by now than when the manifest was read. A lock says more: which one it must
/// be.
void require_version(const Manifest& manifest) {
  if (manifest.locked || stamp_of(manifest.library) == manifest.library_stamp) return;
  refuse(manifest, "has changed since its manifest was read", {"begin anew, when nobody writes to it any more"});
}

/// What a library's file holds, kept in memory that nobody can change any more until the process ends. Its name is one
/// that the loader can open.
fs::path sealed(const Manifest& manifest, const std::string& bytes) {
  require_version(manifest);
  const int copy = memfd_create(manifest.library.filename().c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING);
  bool whole = copy >= 0;
  for (std::size_t done = 0; whole && done < bytes.size();) {
    const ssize_t written = ::write(copy, bytes.data() + done, bytes.size() - done);
    whole = written > 0;
    done += whole ? static_cast<std::size_t>(written) : 0;
  }
  if (!whole || fcntl(copy, F_ADD_SEALS, F_SEAL_WRITE | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) {
    const std::string words = std::strerror(errno);
    if (copy >= 0) ::close(copy);
    refuse(manifest, "could not be copied to memory, where nobody can change it: " + words);
  }
  return "/proc/self/fd/" + std::to_string(copy);
}

/// Of a library that is locked: what is hashed is what is loaded, whatever happens to the file.
fs::path sealed_copy(const Manifest& manifest, const fs::path& file) {
  static auto& copies = *new Kept<fs::path>;
  const Version version = version_of(manifest);
  if (const fs::path* known = copies.find(version)) return *known;
  return copies.put(version, sealed(manifest, read_input(file, any_size)));
}

/// Whether the loader would give back, whole or in part, what this has loaded before: it knows files by name and
/// number, and variables of inline functions and templates (C++) by name alone. `bytes`: what the file holds; these
/// variables become its own.
bool takes_after_another(const fs::path& file, std::string& bytes) {
  static std::atomic<bool> unique_before = false;
  static auto& loaded = *new Kept<bool>;
  bool another = own_unique_symbols(bytes) && unique_before.exchange(true);
  const FileStamp stamp = stamp_of(file);
  for (const Version& name : {Version{file, {}}, Version{{}, {stamp[0], stamp[1]}}}) {  // device and number
    another = another || loaded.find(name) != nullptr;
    loaded.put(name, true);
  }
  return another;
}

/// What to do where the loader does not take a file that is a library.
Remedy remedy_of(const Manifest& manifest, bool copied) {
  struct statvfs disk {};
  if (::statvfs(manifest.library.c_str(), &disk) == 0 && (disk.f_flag & ST_NOEXEC) != 0)
    return {"its disk is mounted without the right to execute (noexec): put the plugin on another one"};
  if (copied) return {"it is loaded as a copy, because another version of it is there already: begin a new process"};
  return {};
}

std::atomic<bool> kept_apart = false;

boost::dll::shared_library load(const Manifest& manifest, const fs::path& file) {
  (void)library_sha256(manifest);
  std::string bytes = read_input(file, any_size);
  const bool copied = takes_after_another(file, bytes);
  const fs::path from = copied ? sealed(manifest, bytes) : file;
  boost::dll::shared_library library;
  std::error_code error;
  call_watched(manifest, "that runs when it is loaded",
               [&] { library.load(from, boost::dll::load_mode::rtld_now | boost::dll::load_mode::rtld_local, error); });
  if (error) {
    const char* words = dlerror();  // Boost's own error says only "bad file descriptor"
    refuse(manifest, "could not be loaded: " + std::string(words != nullptr ? words : error.message().c_str()),
           remedy_of(manifest, copied));
  }
  if (kept_apart) own_pages(library.native());
  require_version(manifest);
  return library;
}

// Sizes of the structs in interface 1.0: what every plugin must have, however many fields are appended later.
constexpr std::size_t smallest_plugin = offsetof(rouleau_plugin, models) + sizeof(rouleau_plugin::models);
constexpr std::size_t smallest_model = offsetof(rouleau_model, interaction) + sizeof(rouleau_model::interaction);
constexpr std::size_t smallest_named_model = offsetof(rouleau_model, id) + sizeof(rouleau_model::id);
constexpr std::size_t smallest_collision =
    offsetof(rouleau_collision, collide_f32) + sizeof(rouleau_collision::collide_f32);
constexpr std::size_t smallest_membrane = offsetof(rouleau_membrane, compute) + sizeof(rouleau_membrane::compute);
constexpr std::size_t smallest_interaction =
    offsetof(rouleau_interaction, compute) + sizeof(rouleau_interaction::compute);

std::string size_fault(const char* name, std::size_t found, std::size_t wanted) {
  return std::string("has a ") + name + " with struct_size " + std::to_string(found) + "; it must be at least " +
         std::to_string(wanted);
}

std::string kind_name(std::uint32_t kind) {
  if (kind < ROULEAU_COLLISION_KIND || kind > ROULEAU_INTERACTION_KIND) return std::to_string(kind);
  return to_string(static_cast<ModelKind>(kind));
}

/// Fault of the function table that the model's kind asks for; empty: none.
std::string table_fault(const rouleau_model& model) {
  const int tables = (model.collision != nullptr) + (model.membrane != nullptr) + (model.interaction != nullptr);
  const std::string which = "model " + in_quotes(model.id);
  const auto fault = [&](const auto* table, const char* name, std::size_t smallest, auto complete) -> std::string {
    if (table == nullptr) return "has no " + std::string(name) + " in its " + which;
    if (tables > 1) return "has more than one function table in its " + which;
    if (table->struct_size < smallest) return size_fault(name, table->struct_size, smallest);
    if (!complete(*table)) return "has a " + std::string(name) + " without all of its functions in its " + which;
    return {};
  };
  switch (static_cast<ModelKind>(model.kind)) {
    case ModelKind::collision:
      return fault(model.collision, "rouleau_collision", smallest_collision,
                   [](const auto& t) { return t.collide_f64 != nullptr && t.collide_f32 != nullptr; });
    case ModelKind::membrane:
      return fault(model.membrane, "rouleau_membrane", smallest_membrane,
                   [](const auto& t) { return t.compute != nullptr; });
    case ModelKind::interaction:
      return fault(model.interaction, "rouleau_interaction", smallest_interaction,
                   [](const auto& t) { return t.cutoff != nullptr && t.compute != nullptr; });
  }
  return {};
}

std::string model_fault(const rouleau_model& model, const Manifest& manifest) {
  if (model.struct_size < smallest_model) return size_fault("rouleau_model", model.struct_size, smallest_model);
  if (model.kind != static_cast<std::uint32_t>(manifest.kind)) {
    return "has a model " + in_quotes(manifest.id) + " of the kind " + kind_name(model.kind) +
           ", its manifest is for the kind " + to_string(manifest.kind);
  }
  if (model.version == nullptr || model.version != manifest.version) {
    return "has version " + (model.version == nullptr ? "(none)" : std::string(model.version)) + " of " +
           in_quotes(manifest.id) + ", its manifest is for version " + manifest.version;
  }
  if (model.create == nullptr || model.destroy == nullptr)
    return "has no create or no destroy function in its model " + in_quotes(manifest.id);
  return table_fault(model);
}

}  // namespace

void keep_libraries_apart() { kept_apart = true; }

fs::path checked_library(const Manifest& manifest) {
  fs::path file = library_file(manifest);
  if (manifest.locked) {
    file = sealed_copy(manifest, file);
    const std::string found = sha256(file);
    if (found != manifest.locked->sha256) {
      refuse(manifest,
             "is not the one that is locked\n  expected SHA-256 " + manifest.locked->sha256 + ", by the lock " +
                 manifest.locked->lock + "\n  found SHA-256 " + found,
             {manifest.locked->renewal});
    }
  }
  if (const std::string reason = reason_not_loadable(file, ROULEAU_OPEN_SYMBOL); !reason.empty())
    refuse(manifest, reason);
  return file;
}

rouleau_open_function load_library(const Manifest& manifest) {
  // For good: code of a plugin may be anywhere on a stack, and its tables live in it. Each version of a file once,
  // though the models of every stage are made anew.
  static auto& loaded = *new Kept<boost::dll::shared_library>;  // never destroyed
  const Version version = version_of(manifest);
  boost::dll::shared_library* library = loaded.find(version);
  if (library == nullptr) library = &loaded.put(version, load(manifest, checked_library(manifest)));
  return library->get<const rouleau_plugin*(std::uint32_t)>(ROULEAU_OPEN_SYMBOL);
}

const rouleau_model& model_of(rouleau_open_function open, const Manifest& manifest) {
  const auto* plugin = call_watched(manifest, ROULEAU_OPEN_SYMBOL, [&] { return open(ROULEAU_ABI_MINOR); });
  if (plugin == nullptr) {
    refuse(manifest, "says that it cannot work with this host (interface " + std::to_string(ROULEAU_ABI_MAJOR) + '.' +
                         std::to_string(ROULEAU_ABI_MINOR) + ')');
  }
  const auto [model, fault] = find_model(*plugin, manifest);
  if (model == nullptr) refuse(manifest, fault);
  return *model;
}

const rouleau_model& open_model(const Manifest& manifest) { return model_of(load_library(manifest), manifest); }

std::string library_sha256(const Manifest& manifest) {
  static auto& hashes = *new Kept<std::string>;
  const Version version = version_of(manifest);
  if (const std::string* known = hashes.find(version)) return *known;
  const fs::path file = library_file(manifest);
  const std::string found = sha256(manifest.locked ? sealed_copy(manifest, file) : file);
  require_version(manifest);
  return hashes.put(version, found);
}

void require_unchanged(const ProcessState& before, const Manifest& manifest, const std::string& function) {
  const std::vector<std::string> changed = before.restore();
  if (changed.empty()) return;
  throw Error(Cause::plugin_refused, Place{manifest.file.string()},
              "the plugin " + in_quotes(manifest.id) + " changes, in its function " + function + ", " +
                  listed(changed) + "\n  of the whole program; a plugin may only compute",
              {"report it to the plugin's author"});
}

FoundModel find_model(const rouleau_plugin& plugin, const Manifest& manifest) {
  if (plugin.struct_size < smallest_plugin)
    return {nullptr, size_fault("rouleau_plugin", plugin.struct_size, smallest_plugin)};
  if (plugin.models == nullptr) return {nullptr, "holds no list of models"};
  std::vector<std::string> ids;
  for (const rouleau_model* const* entry = plugin.models; *entry != nullptr; ++entry) {
    const rouleau_model& model = **entry;
    // A broken model beside the wanted one is no reason to refuse that, as long as its name can be read.
    if (model.struct_size < smallest_named_model)
      return {nullptr, size_fault("rouleau_model", model.struct_size, smallest_model)};
    if (model.id == nullptr) return {nullptr, "holds a model without an id"};
    if (model.id == manifest.id) {
      std::string fault = model_fault(model, manifest);
      if (!fault.empty()) return {nullptr, std::move(fault)};
      return {&model, {}};
    }
    ids.emplace_back(model.id);
  }
  return {nullptr, "holds no model with the manifest's id " + in_quotes(manifest.id) + did_you_mean(manifest.id, ids) +
                       "\n  its models: " + listed(ids)};
}

}  // namespace rouleau::plugin
