// What a shared library exports, read from its file before the loader sees it.
#include "plugin/exported_symbols.hpp"
#include "target.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  const fuzz::MemoryFile file(bytes);
  fuzz::may_refuse([&] { fuzz::require_printable(plugin::reason_not_loadable(file.path(), "rouleau_open_v1")); });
}

fuzz::Form fuzz_form() { return {}; }
