// --set POINTER=VALUE, one on each line, on a good scene.
#include "plan_scene.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  std::vector<std::string> overrides;
  while (!bytes.empty()) {
    const auto end = std::min(bytes.find('\n'), bytes.size());
    // The program's arguments end at a NUL.
    overrides.emplace_back(bytes.substr(0, std::min(end, bytes.find('\0'))));
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
  }
  fuzz::plan_scene(ROULEAU_SCENES "/four-cells-shear.json", overrides);
}

fuzz::Form fuzz_form() { return {}; }
