// Reads from a shared library's file what it exports, without loading it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rouleau::plugin {

/// Why the loader could not use a file as a library with this exported symbol: "is not an ELF file", "is made for
/// another machine", "is cut short", "does not export ..."; empty when nothing speaks against it.
///
/// This stands where boost::dll::library_info would. That class (Boost 1.74) looks at the debugging symbols, which a
/// stripped library does not have, and reads past its buffer when the file is damaged. Loading a file that is cut short
/// ends the program with SIGBUS, so its length is checked here, too.
std::string reason_not_loadable(const std::filesystem::path& file, const std::string& symbol);

/// Names of all symbols that other modules can see. Throws std::runtime_error for a file that is no library or damaged.
std::vector<std::string> exported_symbols(const std::filesystem::path& file);

/// Makes the library's own what the loader would take from any library that has the same (STB_GNU_UNIQUE: variables of
/// inline functions and of templates in C++). False where there is no such symbol.
bool own_unique_symbols(std::string& library);

}  // namespace rouleau::plugin
