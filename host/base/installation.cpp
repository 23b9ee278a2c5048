#include "installation.hpp"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

namespace rouleau {

namespace {

namespace fs = std::filesystem;

/// The program, or the shared library that this code is part of; empty where the system does not say.
fs::path own_file() {
  static const char place = 0;
  Dl_info symbol{};
  link_map* object = nullptr;
  const bool known = ::dladdr1(&place, &symbol, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0;
  // The program's own entry has no name; a static program has no entry.
  const bool library = known && object != nullptr && object->l_name != nullptr && *object->l_name != '\0';
  std::error_code error;
  return fs::canonical(library ? object->l_name : "/proc/self/exe", error);
}

bool ends_with(const fs::path& path, const fs::path& end) {
  const auto length = std::distance(end.begin(), end.end());
  return std::distance(path.begin(), path.end()) > length &&
         std::equal(end.begin(), end.end(), std::prev(path.end(), length));
}

Installation find() {
  const fs::path file = own_file();
  if (file.empty()) return {};
  fs::path folder = file.parent_path();
  // Where programs and the Python module lie in an installation, the module in a build, and everything else.
  constexpr std::array<std::string_view, 4> places{ROULEAU_LIBEXEC_FOLDER "/rouleau", ROULEAU_PYTHON_FOLDER "/rouleau",
                                                   "python/rouleau", ""};
  const fs::path below =
      *std::find_if(places.begin(), places.end(), [&](const fs::path& place) { return ends_with(folder, place); });
  if (below.empty()) folder = folder.parent_path();
  for (const fs::path& part : below)
    if (!part.empty()) folder = folder.parent_path();

  Installation found{folder, folder / ROULEAU_DATA_FOLDER, folder / ROULEAU_LIBEXEC_FOLDER / "rouleau", {}};
  for (const char* name : {ROULEAU_LIBRARY_FOLDER, "lib", "lib64"}) {
    const fs::path libraries = folder / name;
    if (std::find(found.libraries.begin(), found.libraries.end(), libraries) == found.libraries.end())
      found.libraries.push_back(libraries);
  }
  return found;
}

}  // namespace

const Installation& installation() {
  static const Installation found = find();
  return found;
}

}  // namespace rouleau
