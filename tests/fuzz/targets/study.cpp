// Studies: from the text to the scenes of the first points.
#include "study/study_document.hpp"

#include "first_points.hpp"
#include "plan_scene.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  const fuzz::MemoryFile file(bytes);
  fuzz::may_refuse([&] {
    const auto study = study::read_study(file.path());
    fuzz::make_first_points(study.scene, study.axes);
  });
}

fuzz::Form fuzz_form() { return {&study::study_schema(), fuzz::plugin_words()}; }
