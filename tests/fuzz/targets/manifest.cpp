// Manifests of plugins: reading and all checks.
#include "plugin/manifest.hpp"

#include "json/document.hpp"
#include "plugin/manifest_reader.hpp"
#include "plugin/quantities.hpp"
#include "target.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  static const units::Units units;
  fuzz::may_refuse([&] {
    const fuzz::MemoryFile file(bytes);
    const auto document = plugin::read_manifest_document(file.path());
    const auto manifest = plugin::read_manifest(document, file.path(), units);
    for (const auto& parameter : manifest.parameters) {
      if (parameter.choices.empty()) static_cast<void>(units.scale(parameter.unit));
    }
  });
}

fuzz::Form fuzz_form() {
  fuzz::Form form{&plugin::manifest_schema(), {"x-own"}};
  for (const auto kind : {plugin::ModelKind::collision, plugin::ModelKind::membrane, plugin::ModelKind::interaction}) {
    for (const int dimension : {2, 3}) {
      for (const auto& list : {plugin::inputs_of(kind, dimension), plugin::outputs_of(kind, dimension)}) {
        form.words.insert(form.words.end(), list.begin(), list.end());
      }
    }
  }
  return form;
}
