#include "library.hpp"

// With the standard's file paths Boost.DLL is header-only and needs no other Boost library.
#define BOOST_DLL_USE_STD_FS
#include <dlfcn.h>
#include <fcntl.h>
#include <sha2.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <boost/dll/shared_library.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/input_file.hpp"
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

/// A copy of a file that nobody can change any more, kept until the process ends: what is hashed is what is loaded,
/// whatever happens to the file. Its name is one that the loader can open.
fs::path sealed_copy(const Manifest& manifest, const fs::path& file) {
  static auto& copies = *new std::map<fs::path, fs::path>;
  if (const auto known = copies.find(file); known != copies.end()) return known->second;
  const int copy = memfd_create(file.filename().c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING);
  std::ifstream from(file, std::ios::binary);
  std::array<char, 1 << 16> part{};
  bool whole = copy >= 0 && from.is_open();
  while (whole && (from.read(part.data(), part.size()), from.gcount() > 0)) {
    for (std::streamsize done = 0; whole && done < from.gcount();) {
      const ssize_t written = ::write(copy, part.data() + done, static_cast<std::size_t>(from.gcount() - done));
      whole = written > 0;
      done += written;
    }
  }
  if (!whole || from.bad() || fcntl(copy, F_ADD_SEALS, F_SEAL_WRITE | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) {
    const std::string words = std::strerror(errno);
    if (copy >= 0) ::close(copy);
    refuse(manifest, "could not be copied to memory, where nobody can change it: " + words);
  }
  return copies.emplace(file, "/proc/self/fd/" + std::to_string(copy)).first->second;
}

/// Loads for good: code of a plugin may be anywhere on a stack, and its tables live in it. Each file once, though the
/// models of every stage are made anew.
boost::dll::shared_library& load(const Manifest& manifest, const fs::path& file) {
  static auto& loaded = *new std::map<fs::path, boost::dll::shared_library>;  // never destroyed
  if (const auto known = loaded.find(file); known != loaded.end()) return known->second;
  boost::dll::shared_library library;
  std::error_code error;
  call_watched(manifest, "that runs when it is loaded",
               [&] { library.load(file, boost::dll::load_mode::rtld_now | boost::dll::load_mode::rtld_local, error); });
  if (error) {
    const char* words = dlerror();  // Boost's own error says only "bad file descriptor"
    refuse(manifest, "could not be loaded: " + std::string(words != nullptr ? words : error.message().c_str()));
  }
  return loaded.emplace(file, std::move(library)).first->second;
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
  struct Hashed {
    fs::file_time_type written;
    std::uintmax_t bytes;
    std::string sha256;
  };
  static auto& known = *new std::map<fs::path, Hashed>;
  const fs::path file = library_file(manifest);
  std::error_code gone;
  const auto written = fs::last_write_time(file, gone);
  const std::uintmax_t bytes = fs::file_size(file, gone);
  Hashed& hashed = known[file];
  if (gone || hashed.sha256.empty() || hashed.written != written || hashed.bytes != bytes)
    hashed = {written, bytes, sha256(file)};
  return hashed.sha256;
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
