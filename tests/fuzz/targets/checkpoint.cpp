// What a checkpoint says, as `rouleau run --resume` reads it: /facts, /state and arrays that are not those of the run,
// under a checksum that is right. (Bytes that were changed later are what the checksum is for: tests/resume.)
#include "run/checkpoint.hpp"
#include "core/solver/solver.hpp"
#include "plan/placed_cells.hpp"

#include "json/parser.hpp"
#include "plan/solver_setup.hpp"
#include "plan_scene.hpp"
#include "run/checkpoint_match.hpp"
#include "scratch_folder.hpp"
using namespace rouleau;
using Json = nlohmann::json;

namespace {

/// A scene with everything that remembers: bonds, a law with a memory, leakage, viscosities, two stages.
struct Run {
  Run()
      : scene(plan::read_scene(ROULEAU_FUZZ_SCENES "/checkpoint.json")),
        plan(plan::make_plan(scene, fuzz::shipped_catalog())) {}
  [[nodiscard]] core::Membranes membranes() const { return plan::make_cells<2>(scene, scene::lattice_spacing(scene)); }

  scene::Scene scene;
  plan::Plan plan;
};

const Run& the_run() {
  static const Run run;
  return run;
}

/// Arrays of the input: {"/path": [numbers]}.
void write_arrays(files::CheckpointWriter& writer, const Json& arrays) {
  for (const auto& [path, values] : arrays.items()) {
    if (!path.starts_with('/') || path.find("//") != std::string::npos || path.ends_with('/')) continue;
    std::vector<double> numbers;
    for (const Json& value : values) numbers.push_back(value.is_number() ? value.get<double>() : 0);
    const auto nx = static_cast<std::size_t>(the_run().scene.domain.nodes[0]), ny = numbers.size() / nx;
    if (path.starts_with("/populations/") && ny * nx == numbers.size()) {
      writer.begin_array(path, ny, nx);
    } else {
      writer.begin_array(path, numbers.size());
    }
    if (!numbers.empty()) writer.append(numbers);
  }
}

void resume(const std::filesystem::path& directory) {
  const Run& run = the_run();
  auto resumption = run::open_checkpoint(directory, run.plan, true);
  core::Membranes membranes = run.membranes();
  run::RunState state{observe::Observer(run.scene, membranes)};
  const core::Box<2> whole = scene::lattice_domain(run.scene).block;
  auto restored = run::restore<2>(std::move(resumption.checkpoint), run.plan, whole, state, membranes);
  core::Solver<double> solver(plan::make_solver_setup(run.plan, state.stage), membranes);
  solver.start(std::move(restored.solver));
  run::Summary summary;
  state.report(summary);
  run::to_json(summary).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

void fuzz_target(std::string_view bytes) {
  static const test::ScratchFolder folder;
  Json input;
  try {
    input = json::parse_json(bytes).root;
  } catch (const json::TextFault&) {
    return;
  }
  if (!input.is_object()) return;
  {
    files::CheckpointWriter writer(folder.path());
    try {
      write_arrays(writer, input.value("arrays", Json::object()));
      writer.facts(input.value("facts", Json()));
      writer.state(input.value("state", Json()));
    } catch (const rouleau::Error&) {
      return;  // HDF5 takes no such path
    }
    writer.finish();
    writer.take_place();
  }
  fuzz::may_refuse([&] { resume(folder.path()); });
}

fuzz::Form fuzz_form() {
  static const Json anything = Json::object();
  return {&anything, {}};
}
