// Studies: from the text to the scenes of the first points.
#include "study/study_document.hpp"

#include "plan_scene.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  const fuzz::MemoryFile file(bytes);
  fuzz::may_refuse([&] {
    const auto study = host::read_study(file.path());
    int looked_at = 0;
    for (const auto& point : host::cross(study.axes)) {
      if (++looked_at > 20) break;
      fuzz::require_printable(host::name_of(study.axes, point));
      host::labels_of(study.axes, point).dump();
      host::scene_of(study.scene, study.axes, point).dump();
    }
  });
}

fuzz::Form fuzz_form() { return {&host::study_schema(), fuzz::plugin_words()}; }
