// What a checkpoint says, as `rouleau run --resume` reads it: /facts, /state and arrays that are not those of the run,
// under a checksum that is right. (Bytes that were changed later are what the checksum is for: tests/resume.)
#include "run/checkpoint.hpp"

#include "input/parser.hpp"
#include "plan_scene.hpp"
#include "run/checkpoint_match.hpp"
#include "scratch_folder.hpp"

using namespace rouleau;
using nlohmann::json;

namespace {

/// A scene with everything that remembers: bonds, a law with a memory, leakage, viscosities, two stages.
struct Run {
  Run()
      : scene(host::read_scene(ROULEAU_FUZZ_SCENES "/checkpoint.json")),
        plan(host::make_plan(scene, fuzz::shipped_catalog())) {}
  [[nodiscard]] host::Membranes membranes() const { return host::make_membranes(scene, host::lattice_spacing(scene)); }

  host::Scene scene;
  host::Plan plan;
};

const Run& the_run() {
  static const Run run;
  return run;
}

/// Arrays of the input: {"/path": [numbers]}.
void write_arrays(host::CheckpointWriter& writer, const json& arrays) {
  for (const auto& [path, values] : arrays.items()) {
    if (!path.starts_with('/') || path.find("//") != std::string::npos || path.ends_with('/')) continue;
    std::vector<double> numbers;
    for (const json& value : values) numbers.push_back(value.is_number() ? value.get<double>() : 0);
    writer.array(path, numbers);
  }
}

void resume(const std::filesystem::path& directory) {
  const Run& run = the_run();
  const auto resumption = host::open_checkpoint(directory, run.plan, true);
  const json saved = resumption.checkpoint->state();
  host::Membranes membranes = run.membranes();
  host::RunState state{host::Observer(run.scene, membranes)};
  host::restore(*resumption.checkpoint, saved, run.plan, state, membranes);
  host::Solver<double> solver(run.plan, state.stage, membranes);
  host::restore(*resumption.checkpoint, saved, solver);
  host::Summary summary;
  state.report(summary);
  host::to_json(summary).dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

void fuzz_target(std::string_view bytes) {
  static const test::ScratchFolder folder;
  json input;
  try {
    input = host::parse_json(bytes).root;
  } catch (const host::TextFault&) {
    return;
  }
  if (!input.is_object()) return;
  {
    host::CheckpointWriter writer(folder.path());
    try {
      write_arrays(writer, input.value("arrays", json::object()));
      writer.facts(input.value("facts", json()));
      writer.state(input.value("state", json()));
    } catch (const host::Error&) {
      return;  // HDF5 takes no such path
    }
    writer.finish();
    writer.take_place();
  }
  fuzz::may_refuse([&] { resume(folder.path()); });
}

fuzz::Form fuzz_form() {
  static const json anything = json::object();
  return {&anything, {}};
}
