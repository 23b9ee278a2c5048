#include "checkpoint.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "checkpoint_match.hpp"
#include "core/solver/in_order.hpp"
#include "saved_cells.hpp"

namespace rouleau::run {

namespace {

using Json = nlohmann::json;

std::string population_name(int q) { return "/populations/" + std::to_string(q); }
std::string state_name(std::size_t k) { return "/membranes/state/" + std::to_string(k); }

constexpr std::array velocities{"/membranes/velocity_x", "/membranes/velocity_y", "/membranes/velocity_z"};
constexpr std::array indicator_places{"/indicator/x", "/indicator/y", "/indicator/z"};

/// Arrays of the cells that have a value for each node, or for each cell.
template <class Cells>
auto arrays(Cells& m) {
  std::vector all{std::pair{places[0], &m.position[0]}, std::pair{places[1], &m.position[1]},
                  std::pair{velocities[0], &m.velocity[0]}, std::pair{velocities[1], &m.velocity[1]},
                  std::pair{"/membranes/largest_step", &m.largest_step}};
  if (!m.position[2].empty())
    all.insert(all.end(), {std::pair{places[2], &m.position[2]}, std::pair{velocities[2], &m.velocity[2]}});
  return all;
}

constexpr const char *contacts_array = "/membranes/contacts", *wall_contacts_array = "/membranes/wall_contacts",
                     *leakage_array = "/membranes/area_leakage";

Json described(const core::ElementState& s) {
  return {{"cell_type", s.cell_type}, {"law", s.law}, {"model", s.model}, {"name", s.name}, {"unit_si", s.unit}};
}

core::ElementState element_state(const Json& d) {
  return {d.at("cell_type"), d.at("law"), d.at("model"), d.at("name"), d.at("unit_si"), {}};
}

Json described(const core::ContactVariable& v) {
  return {
      {"potential", v.potential}, {"model", v.model}, {"name", v.name}, {"unit_si", v.unit}, {"initial", v.initial}};
}

core::ContactVariable contact_variable(const Json& d) {
  return {d.at("potential"), d.at("model"), d.at("name"), d.at("unit_si"), d.at("initial")};
}

/// Writes what the owners of cells know of them, in the order of the cells: all ranks together, the first one has the
/// file.
template <int D>
class CellArrays {
 public:
  /// `writer`: null on ranks that do not write. `ghosts`: null: this rank has all cells.
  CellArrays(files::CheckpointWriter* writer, const core::CellNodes& cells, const core::GhostCells<D>* ghosts,
             const Kept& kept)
      : writer_(writer), cells_(cells), ghosts_(ghosts), kept_(kept) {}

  /// A number of each node.
  template <class Values>
  void of_nodes(const std::string& path, const Values& values) {
    write(path, kept_.nodes, [&](int c, std::vector<double>& of_cell) {
      const core::CellRange& cell = cells_.cells[c];
      of_cell.insert(of_cell.end(), values.data() + cell.first, values.data() + cell.end());
    });
  }
  /// A number of each cell; or none.
  void of_cells(const std::string& path, const std::vector<double>& values) {
    write(path, std::min(kept_.cells, values.size()), [&](int c, std::vector<double>& of_cell) {
      if (!values.empty()) of_cell.push_back(values[c]);
    });
  }
  /// What interactions remember: which pairs of cells, or of cells and walls, and for each of them the next so many
  /// values of one array.
  Json contacts(const char* path, const core::ContactMemory& memory) {
    struct Pair {
      int cell, variable, other;
      core::ImageShift shift;
      std::size_t values;
    };
    Json variables = Json::array(), pairs = Json::array();
    for (const core::ContactVariable& variable : memory.variables) variables.push_back(described(variable));
    std::size_t count = 0;
    const auto of_cell = [&](int cell) -> std::span<const core::ContactState> {
      return memory.of_cell.empty() ? std::span<const core::ContactState>() : std::span(memory.of_cell[cell]);
    };
    core::give_in_order<Pair>(
        ghosts_, cells_,
        [&](int cell, std::vector<Pair>& its) {
          for (const core::ContactState& s : of_cell(cell))
            its.push_back({cell, static_cast<int>(s.variable), s.other, s.shift, s.value.size()});
        },
        [&](Range, const std::vector<Pair>& some) {
          for (const Pair& pair : some) {
            pairs.push_back({pair.cell, pair.variable, pair.other, pair.shift.x, pair.shift.y, pair.values});
            if (pair.shift.z != 0) pairs.back().push_back(pair.shift.z);
            count += pair.values;
          }
        });
    write(path, count, [&](int cell, std::vector<double>& values) {
      for (const core::ContactState& s : of_cell(cell)) values.insert(values.end(), s.value.begin(), s.value.end());
    });
    return {{"variables", variables}, {"cells", std::min(kept_.cells, memory.of_cell.size())}, {"pairs", pairs}};
  }

 private:
  /// So many values, of which add(cell, values) appends those of a cell.
  template <class Add>
  void write(const std::string& path, std::size_t count, Add add) {
    if (writer_ != nullptr) writer_->begin_array(path, count);
    const auto add_kept = [&](int c, std::vector<double>& of_cell) {
      if (static_cast<std::size_t>(c) < kept_.cells) add(c, of_cell);
    };
    core::give_in_order<double>(ghosts_, cells_, add_kept, [&](Range, const std::vector<double>& values) {
      if (writer_ != nullptr && !values.empty()) writer_->append(values);
    });
  }

  files::CheckpointWriter* writer_;
  const core::CellNodes& cells_;
  const core::GhostCells<D>* ghosts_;
  Kept kept_;
};

/// A checkpoint that is whole and yet not what this program writes.
void require(bool fits, const files::CheckpointReader& reader, const char* what) {
  if (!fits) reader.refuse(what);
}

/// `others`: how many there are that a cell may be in contact with.
void restore_contacts(const files::CheckpointReader& reader, const Json& saved, const char* array, std::size_t others,
                      const core::CellNodes& nodes, const Kept& kept, core::ContactMemory& memory) {
  memory.variables.clear();
  for (const Json& variable : saved.at("variables")) memory.variables.push_back(contact_variable(variable));
  const Json& cells = saved.at("cells");
  require(cells == 0 || cells == kept.cells, reader, "contacts of another number of cells");
  memory.of_cell.assign(cells == 0 ? 0 : nodes.cells.size(), {});
  std::vector<double> values = reader.array(array);
  auto next = values.begin();
  for (const Json& pair : saved.at("pairs")) {
    const std::size_t cell = pair.at(0), variable = pair.at(1);
    const int other = pair.at(2);
    const std::ptrdiff_t count = pair.at(5);
    require(cell < memory.of_cell.size() && variable < memory.variables.size() && other >= 0 &&
                other < static_cast<int>(others),
            reader, "a contact of a cell or of a variable that is not there");
    require(count == nodes.cells[cell].count && count <= values.end() - next, reader, "a contact without values");
    const int z = pair.size() > 6 ? pair.at(6).get<int>() : 0;
    memory.of_cell[cell].push_back({variable, other, {pair.at(3), pair.at(4), z}, {next, next + count}});
    next += count;
  }
}

/// Writes the arrays, and returns what belongs into the file's /state.
template <int D, class Cells>
Json save(CellArrays<D> to, const Cells& m) {
  for (const auto& [path, values] : arrays(m))
    if (values == &m.largest_step)
      to.of_cells(path, *values);
    else
      to.of_nodes(path, *values);
  to.of_cells(leakage_array, m.area_leakage);
  Json states = Json::array();
  for (std::size_t k = 0; k < m.state.size(); ++k) {
    states.push_back(described(m.state[k]));
    to.of_nodes(state_name(k), m.state[k].value);
  }
  Json saved{{"leakage", m.area_leakage.size()}, {"state", states}};
  if (std::is_same_v<Cells, core::Membranes> || !m.contacts.variables.empty())
    saved["contacts"] = to.contacts(contacts_array, m.contacts);
  if (!m.wall_contacts.variables.empty()) saved["wall_contacts"] = to.contacts(wall_contacts_array, m.wall_contacts);
  return saved;
}

/// `writer`: null on ranks that do not write.
template <int D>
Json save(files::CheckpointWriter* writer, core::AnySolver<D>& solver, const Kept& kept) {
  core::AnyFluid<D>& fluid = solver.fluid();
  fluid.settle();
  const core::Domain<D>& domain = fluid.setting().domain;
  const auto nx = static_cast<std::size_t>(domain.size[0]), rows = static_cast<std::size_t>(domain.nodes()) / nx;
  const auto bands = core::bands_of_all<D>(domain.size, sizeof(double));
  for (int q = 0; q < fluid.populations(); ++q) {
    if (writer != nullptr) writer->begin_array(population_name(q), rows, nx, fluid.single_precision());
    fluid.gather_populations(q, bands, [&](int, const std::vector<double>& values) { writer->append(values); });
  }
  const std::size_t links = save_links(writer, fluid.link_memory());
  if (auto* const tasks = solver.cell_tasks()) {
    const core::DisplacementWatch::Memory& memory = tasks->viscosity_memory();
    CellArrays<D> to(writer, solver.cells(), tasks->ghosts(), kept);
    for (int k = 0; k < D; ++k) to.of_nodes(indicator_places[k], memory.position[k]);
    to.of_cells("/indicator/limit", memory.limit);
    to.of_cells("/indicator/bound", memory.bound);
  }
  Json saved{{"walls_have_acted", fluid.walls_have_acted()}, {"links", links}};
  if (const auto& control = solver.flow_control()) {
    const core::FlowControl::State& state = control->state();
    saved["flow_control"] = {{"force", state.force}};
    if (state.last) saved["flow_control"]["last"] = *state.last;
  }
  return saved;
}

void restore_leakage(const files::CheckpointReader& reader, const Json& saved, const Kept& kept,
                     core::CellNodes& cells) {
  const bool any = saved.at("leakage") != 0;
  cells.area_leakage.resize(any ? cells.cells.size() : 0);
  read_of_cells(reader, leakage_array, kept, cells.area_leakage);
}

template <class Cells>
void restore_cells(const files::CheckpointReader& reader, const Json& saved, const Kept& kept, Cells& m) {
  const std::vector<Range> known = m.known_nodes();
  m.largest_step.resize(m.cells.size());
  for (const auto& [path, values] : arrays(m)) {
    if (values == &m.largest_step) {
      read_of_cells(reader, path, kept, *values);
      for (const double step : *values) m.largest_step_of_others = std::max(m.largest_step_of_others, step);
    } else {
      read(reader, path, kept.nodes, known, *values);
    }
  }
  restore_leakage(reader, saved, kept, m);
  m.state.clear();
  for (const Json& description : saved.at("state")) {
    m.state.push_back(element_state(description));
    m.state.back().value.resize(m.position[0].size());
    read(reader, state_name(m.state.size() - 1), kept.nodes, known, m.state.back().value);
  }
  if (std::is_same_v<Cells, core::Membranes> || saved.contains("contacts"))
    restore_contacts(reader, saved.at("contacts"), contacts_array, m.cells.size(), m, kept, m.contacts);
  if (saved.contains("wall_contacts"))
    restore_contacts(reader, saved["wall_contacts"], wall_contacts_array, 4, m, kept, m.wall_contacts);
}

/// What a block has of an array with a row for each of the lattice's rows.
template <int D>
std::vector<double> read_block(const files::CheckpointReader& reader, const std::string& name,
                               const core::Box<D>& block, const scene::Domain& domain) {
  const int width = block.size(0), height = block.size(1), of_lattice = domain.nodes[1];
  const int layers = static_cast<int>(domain.node_count() / domain.nodes[0] / of_lattice);
  const int first = D > 2 ? block.begin[D - 1] : 0, end = first + static_cast<int>(core::row_count(block)) / height;
  std::vector<double> values(static_cast<std::size_t>(width) * core::row_count(block));
  double* to = values.data();
  for (int layer = first; layer < end; ++layer) {
    reader.block(name, {domain.nodes[0], of_lattice * layers}, {block.begin[0], of_lattice * layer + block.begin[1]},
                 {block.end[0], of_lattice * layer + block.end[1]}, to);
    to += static_cast<std::ptrdiff_t>(width) * height;
  }
  return values;
}

}  // namespace

template <int D>
void Checkpoints::write(const plan::Plan& plan, int threads, const RunState& state, core::AnySolver<D>& solver) {
  pending_ = true;
  step_ = state.steps;
  if (to_ != nullptr) writer_ = std::make_unique<files::CheckpointWriter>(to_->path());
  const Kept kept(plan, state, solver.cells());
  const CellArrays<D> of_cells(writer_.get(), solver.cells(), solver.ghosts(), kept);
  Json saved_membranes = save(of_cells, solver.cells()), saved_solver = save(writer_.get(), solver, kept);
  if (to_ == nullptr) return;
  writer_->facts(checkpoint_facts(plan, state, threads));
  Json saved{{"run", state},
             {"membranes", std::move(saved_membranes)},
             {"solver", std::move(saved_solver)},
             {"directory", to_->mark()}};
  if (plan.scene->domain.openings) saved["traffic"] = state.traffic;
  if (plan.scene->output.profiles) saved["profiles"] = state.profiles;
  writer_->state(saved);
  writer_->finish();
}

void Checkpoints::settle(bool sound) {
  if (sound && writer_) {
    writer_->take_place();
    kept_ = step_;
    to_->log("checkpoint", {{"step", step_}, {"bytes", writer_->bytes()}});
  }
  writer_.reset();
  pending_ = false;
  last_ = Clock::now();
}

template <int D>
Restored restore(const std::shared_ptr<const files::CheckpointReader>& reader, const plan::Plan& plan,
                 const core::Box<D>& block, RunState& state, typename core::AnySolver<D>::Cells& cells,
                 const TakePart<D>& take_part) {
  try {
    Json saved = reader->state();
    Json& run = saved.at("run");
    complete_former_state<D>(run, plan);
    if (plan.scene->domain.openings) complete_former_traffic(run, saved.at("traffic"));
    run.get_to(state);
    if (plan.scene->domain.openings) saved.at("traffic").get_to(state.traffic);
    if (plan.scene->output.profiles) saved.at("profiles").get_to(state.profiles);
    const Kept kept(plan, state, cells);
    require(kept.cells <= cells.cells.size() && state.traffic.fits(kept.cells), *reader,
            "more cells that have come in than the stages of this scene leave room for");
    if (take_part) take_part([&] { return read_boxes<D>(*reader, cells, kept); });
    require(state.fits(plan, cells), *reader, "counts of another scene");
    restore_cells(*reader, saved.at("membranes"), kept, cells);
    cells.forget(cells.unknown_nodes());
    core::SolverState solver{
        .populations = [reader, block, domain = plan.scene->domain](
                           int q) { return read_block(*reader, population_name(q), block, domain); },
        .walls_have_acted = saved.at("solver").at("walls_have_acted"),
        .links = read_links(*reader, saved.at("solver")),
        .steps = state.stage_step};
    if (const Json& of_solver = saved.at("solver"); of_solver.contains("flow_control")) {
      const Json& control = of_solver.at("flow_control");
      solver.flow_control = core::FlowControl::State{.force = control.at("force"), .last = {}};
      if (control.contains("last")) solver.flow_control->last = control.at("last").get<double>();
    }
    if (!cells.cells.empty()) {
      core::DisplacementWatch::Memory& memory = solver.viscosity = core::DisplacementWatch::Memory(cells);
      const std::vector<Range> known = cells.known_nodes();
      for (int k = D - 1; k >= 0; --k) read(*reader, indicator_places[k], kept.nodes, known, memory.position[k]);
      read_of_cells(*reader, "/indicator/limit", kept, memory.limit);
      read_of_cells(*reader, "/indicator/bound", kept, memory.bound);
    }
    return {std::move(solver), saved.at("directory").get<files::DirectoryMark>()};
  } catch (const Json::exception& error) {
    reader->refuse(error.what());
  }
}

template void Checkpoints::write(const plan::Plan&, int, const RunState&, core::AnySolver<2>&);
template Restored restore<2>(const std::shared_ptr<const files::CheckpointReader>&, const plan::Plan&,
                             const core::Box<2>&, RunState&, core::Membranes&, const TakePart<2>&);
template void Checkpoints::write(const plan::Plan&, int, const RunState&, core::AnySolver<3>&);
template Restored restore<3>(const std::shared_ptr<const files::CheckpointReader>&, const plan::Plan&,
                             const core::Box<3>&, RunState&, core::Surfaces&, const TakePart<3>&);

}  // namespace rouleau::run
