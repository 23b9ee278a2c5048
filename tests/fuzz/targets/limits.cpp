// Files of limits: from the text to the values that the parameter would be tried with.
#include "stability/limits_document.hpp"

#include "first_points.hpp"
#include "plan_scene.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  const fuzz::MemoryFile file(bytes);
  fuzz::may_refuse([&] {
    const auto limits = stability::read_limits(file.path());
    for (const double value : {limits.parameter.range.from, limits.parameter.range.to})
      (void)limits.parameter.written(value).dump();
    fuzz::make_first_points(limits.scene, limits.axes);
  });
}

fuzz::Form fuzz_form() { return {&stability::limits_schema(), fuzz::plugin_words()}; }
