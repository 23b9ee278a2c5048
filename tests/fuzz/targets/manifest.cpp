// Manifests of plugins: reading and all checks.
#include "plugin/manifest.hpp"

#include "input/document.hpp"
#include "input/schema.hpp"
#include "plugin/quantities.hpp"
#include "target.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  static const host::Units units;
  fuzz::may_refuse([&] {
    const fuzz::MemoryFile file(bytes);
    const auto document = host::read_manifest_document(file.path());
    const auto manifest = host::read_manifest(document, file.path(), units);
    for (const auto& parameter : manifest.parameters) {
      if (parameter.choices.empty()) static_cast<void>(units.scale(parameter.unit));
    }
  });
}

fuzz::Form fuzz_form() {
  fuzz::Form form{&host::manifest_schema(), {"x-own"}};
  for (const auto kind : {host::ModelKind::collision, host::ModelKind::membrane, host::ModelKind::interaction}) {
    for (const auto& list : {host::inputs_of(kind), host::outputs_of(kind)}) {
      form.words.insert(form.words.end(), list.begin(), list.end());
    }
  }
  return form;
}
