// Scenes: from the text to the printed plan.
#include "plan_scene.hpp"
#include "scene/read_scene.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  const fuzz::MemoryFile file(bytes);
  fuzz::plan_scene(file.path());
}

fuzz::Form fuzz_form() { return {&scene::scene_schema(), fuzz::plugin_words()}; }
