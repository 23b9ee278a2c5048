// Files of limits: from the text to the values that the parameter would be tried with.
#include "limits/limits_document.hpp"

#include "plan_scene.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  const fuzz::MemoryFile file(bytes);
  fuzz::may_refuse([&] {
    const auto limits = host::read_limits(file.path());
    if (limits.parameter) {
      for (const double value : {limits.parameter->range.from, limits.parameter->range.to}) {
        limits.parameter->written(value).dump();
      }
    }
    int looked_at = 0;
    for (const auto& point : host::cross(limits.axes)) {
      if (++looked_at > 20) break;
      fuzz::require_printable(host::name_of(limits.axes, point));
      host::scene_of(limits.scene, limits.axes, point).dump();
    }
  });
}

fuzz::Form fuzz_form() { return {&host::limits_schema(), fuzz::plugin_words()}; }
