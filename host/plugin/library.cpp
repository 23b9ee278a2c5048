#include "library.hpp"

// With the standard's file paths Boost.DLL is header-only and needs no other Boost library.
#define BOOST_DLL_USE_STD_FS
#include <dlfcn.h>
#include <fcntl.h>
#include <sha2.h>
#include <sys/mman.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <boost/dll/shared_library.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/file_stamp.hpp"
#include "base/input_file.hpp"
#include "base/own_pages.hpp"
#include "base/text.hpp"
#include "exported_symbols.hpp"
#include "lock.hpp"
#include "table_checks.hpp"
#include "watched_call.hpp"

namespace rouleau::plugin {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const Manifest& manifest, const std::string& problem, const Remedy& remedy = {}) {
  throw Error(Cause::plugin_refused, Place{manifest.file.string()},
              "the library " + manifest.library.string() + ' ' + problem, remedy);
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
  if (library.parent_path() != folder) {
    refuse(manifest, "leads out of the folder of its manifest, to " + library.string());
  }
  if (!fs::is_regular_file(library, error)) refuse(manifest, "is not a regular file");
  return library;
}

/// A file as it was when the manifest was read: what is kept of a file is kept of that, for while the process lives
/// somebody may build the library anew.
using Version = std::pair<fs::path, FileStamp>;
Version version_of(const Manifest& manifest, const fs::path& file) { return {file, manifest.library_stamp}; }

/// Throws where another library lies there by now than when the manifest was read.
void require_version(const Manifest& manifest) {
  if (stamp_of(manifest.library) == manifest.library_stamp) return;
  refuse(manifest, "has changed since its manifest was read", {"begin anew, when nobody writes to it any more"});
}

/// What a file holds, kept in memory that nobody can change any more until the process ends. Its name is one that the
/// loader can open.
fs::path sealed(const Manifest& manifest, const fs::path& file, bool own_symbols) {
  require_version(manifest);
  std::ifstream from(file, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(from), {});
  if (own_symbols) (void)own_unique_symbols(bytes);
  const int copy = memfd_create(manifest.library.filename().c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING);
  bool whole = copy >= 0 && from.is_open() && !from.bad();
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
  static auto& copies = *new std::map<Version, fs::path>;
  const Version version = version_of(manifest, file);
  if (const auto known = copies.find(version); known != copies.end()) return known->second;
  return copies.emplace(version, sealed(manifest, file, false)).first->second;
}

/// Whether the loader would give back, whole or in part, what it has of another library: it knows files by name and number, and
/// variables of inline functions and templates (C++) by name alone.
bool takes_after_another(const fs::path& file) {
  static bool unique_before = false;
  std::ifstream from(file, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(from), {});
  const bool unique = own_unique_symbols(bytes), others = unique && std::exchange(unique_before, true);
  void* const former = ::dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NOLOAD);
  if (former != nullptr) ::dlclose(former);
  return former != nullptr || others;
}

/// What to do where the loader does not take a file that is a library.
Remedy remedy_of(const Manifest& manifest, bool copied) {
  struct statvfs disk {};
  if (::statvfs(manifest.library.c_str(), &disk) == 0 && (disk.f_flag & ST_NOEXEC) != 0)
    return {"its disk is mounted without the right to execute (noexec): put the plugin on another one"};
  if (copied) return {"it is loaded as a copy, for this process has loaded another version of it: begin a new one"};
  return {};
}

/// Loads for good: code of a plugin may be anywhere on a stack, and its tables live in it. Each version of a file once,
/// though the models of every stage are made anew.
boost::dll::shared_library& load(const Manifest& manifest, const fs::path& file) {
  static auto& loaded = *new std::map<Version, boost::dll::shared_library>;  // never destroyed
  const Version version = version_of(manifest, file);
  if (const auto known = loaded.find(version); known != loaded.end()) return known->second;
  (void)library_sha256(manifest);
  const bool copied = takes_after_another(file);
  const fs::path from = copied ? sealed(manifest, file, true) : file;
  boost::dll::shared_library library;
  std::error_code error;
  call_watched(manifest, "that runs when it is loaded",
               [&] { library.load(from, boost::dll::load_mode::rtld_now | boost::dll::load_mode::rtld_local, error); });
  if (error) {
    const char* words = dlerror();  // Boost's own error says only "bad file descriptor"
    refuse(manifest, "could not be loaded: " + std::string(words != nullptr ? words : error.message().c_str()),
           remedy_of(manifest, copied));
  }
  own_pages(library.native());
  require_version(manifest);
  return loaded.emplace(version, std::move(library)).first->second;
}

}  // namespace

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
  if (const std::string reason = reason_not_loadable(file, ROULEAU_OPEN_SYMBOL); !reason.empty()) {
    refuse(manifest, reason);
  }
  return file;
}

rouleau_open_function load_library(const Manifest& manifest) {
  return load(manifest, checked_library(manifest)).get<const rouleau_plugin*(std::uint32_t)>(ROULEAU_OPEN_SYMBOL);
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
  static auto& known = *new std::map<Version, std::string>;
  std::string& hash = known[version_of(manifest, manifest.library)];
  if (hash.empty()) {
    const std::string found = sha256(library_file(manifest));
    require_version(manifest);
    hash = found;
  }
  return hash;
}

std::string sha256(const fs::path& file) {
  char digest[SHA256_DIGEST_STRING_LENGTH] = {};
  static_cast<void>(InputFile(file));
  errno = 0;
  if (SHA256File(file.c_str(), digest) == nullptr) {
    throw Error(Cause::input_output, Place{file.string()}, std::string("cannot be read: ") + std::strerror(errno));
  }
  return digest;
}

std::string sha256_of(std::string_view text) {
  char digest[SHA256_DIGEST_STRING_LENGTH] = {};
  return SHA256Data(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), digest);
}

}  // namespace rouleau::plugin
