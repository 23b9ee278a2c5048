// Fields in bands: the same values as of the whole lattice at once, from any blocks, over all seams.
#include "observe/fields.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <memory>

#include "core/solver/solver.hpp"
#include "plan/placed_cells.hpp"
#include "plan/solver_setup.hpp"
#include "unit/blocks_fixture.hpp"
#include "unit/run_fixture.hpp"

using namespace rouleau;
using rouleau::core::D2Q9, rouleau::core::D3Q19, rouleau::core::row_count, rouleau::core::row_of;
using namespace rouleau::test;

namespace {

struct Flow {
  std::string what, file;
  std::vector<std::string> overrides;
};

const std::string no_cells = "/cells=[]", none = "/interactions=[]", fields = R"(/output={"fields": {"seconds": "1 s",
  "quantities": ["velocity", "density", "viscosity", "vorticity"]}})";

/// A number of either sign that belongs to a node of the lattice, whatever block it lies in.
double noise(int x, int y, int z, int what) { return 1e-3 * ((x * 73 + y * 191 + z * 59 + what * 37) % 101 - 50) / 50; }

template <class T, class Set>
class Planned {
 public:
  static constexpr int dimension = Set::dimension;
  explicit Planned(const Flow& flow)
      : scene(plan::read_scene(flow.file, flow.overrides)), plan(plan::make_plan(scene, catalog())) {}

  /// The fields of a state that is another in every node, on the first rank; some rows of `bytes` at a time.
  std::map<std::string, std::vector<double>> observe(const core::Domain<dimension>& domain,
                                                     const core::Ranks<dimension>& ranks, std::size_t bytes) const {
    auto setup = plan::make_solver_setup<dimension>(plan, 0);
    setup.domain = domain;
    auto cells = plan::make_cells<dimension>(scene);
    core::Solver<T, Set> solver(std::move(setup), cells, ranks, {});
    core::Fluid<T, Set>& fluid = solver.fluid();
    if constexpr (dimension == 2) {
      fluid.set_state([](int x, int y) { return state(x, y, 0); });
    } else {
      fluid.set_state(state);
    }
    fluid.settle();
    const auto snapshot = observe::observe_fields(fluid, scene, plan.stages.front().units, bytes);
    std::map<std::string, std::vector<double>> values;
    for (const observe::Field& field : snapshot.fields) {
      values[field.name] = whole(field);
      const auto numbers = static_cast<std::size_t>(snapshot.nx) * snapshot.ny * snapshot.nz * field.components;
      CHECK(values[field.name].size() == (ranks.first() ? numbers : 0));
    }
    return values;
  }

  scene::Scene scene;
  plan::Plan plan;

 private:
  static typename core::Fluid<T, Set>::State state(int x, int y, int z) {
    typename core::Fluid<T, Set>::State state{noise(x, y, z, 0), {}, {}};
    for (int k = 0; k < dimension; ++k) state.velocity[k] = noise(x, y, z, 1 + k);
    return state;
  }
};

/// Central differences over two spacings at nodes away from walls, from a velocity that was given whole.
template <int D>
void check_vorticity(const core::Domain<D>& domain, const std::vector<double>& velocity,
                     const std::vector<double>& vorticity, double spacing) {
  const auto place = [&](std::array<int, D> node) {
    std::size_t at = 0;
    for (int k = D - 1; k >= 0; --k)
      at = at * static_cast<std::size_t>(domain.size[k]) + static_cast<std::size_t>(domain.wrapped(k, node[k]));
    return at;
  };
  long wrong = 0, compared = 0;
  for (int i = 0; i < row_count(domain.block); ++i) {
    std::array<int, D> node{};
    bool beside_wall = false;
    for (int k = 1; k < D; ++k) {
      node[k] = row_of(domain.block, i)[k - 1];
      beside_wall = beside_wall || domain.wrapped(k, node[k] - 1) < 0 || domain.wrapped(k, node[k] + 1) < 0;
    }
    if (beside_wall) continue;
    for (node[0] = 0; node[0] < domain.size[0]; ++node[0]) {
      const auto rise = [&](std::size_t component, int axis) {
        auto above = node, below = node;
        ++above[axis], --below[axis];
        return (velocity[3 * place(above) + component] - velocity[3 * place(below) + component]) / (2 * spacing);
      };
      const double expected = rise(1, 0) - rise(0, 1);
      const double found = vorticity[D == 2 ? place(node) : 3 * place(node) + 2];
      wrong += std::abs(found - expected) > 1e-12 / spacing ? 1 : 0;
      ++compared;
    }
  }
  CHECK(wrong == 0);
  CHECK(compared > 0);
}

template <class T, class Set>
void check(const Flow& flow) {
  constexpr int D = Set::dimension;
  Planned<T, Set> planned(flow);
  const core::Domain<D> domain = scene::lattice_domain<D>(planned.scene);
  for (const bool part : {false, true}) {
    CAPTURE(flow.what, part);
    scene::FieldStorage& storage = planned.scene.output.field_storage;
    storage = {};
    if (part) {
      storage.first = {2, 1, 0};
      storage.last = std::array{domain.size[0] - 1, domain.size[1] - 1, D == 3 ? domain.size[D - 1] - 1 : 0};
      storage.stride = 2;
    }
    const auto expected = planned.observe(domain, {}, std::size_t{1} << 30);
    REQUIRE(expected.size() == 4);
    if (!part && !planned.scene.domain.tube_radius)
      check_vorticity<D>(domain, expected.at("velocity"), expected.at("vorticity"),
                         planned.plan.stages.front().units.length);
    for (const std::size_t bytes : {std::size_t{1}, std::size_t{3000}, std::size_t{40000}}) {
      CAPTURE(bytes);
      CHECK((planned.observe(domain, {}, bytes) == expected));
      for (const Cut<D>& cut : some_cuts_of(domain, 0)) {
        if (cut.blocks.ranks() == 1) continue;
        CAPTURE(cut.what);
        std::map<std::string, std::vector<double>> found;
        on_all_ranks(cut.blocks, [&](const core::Ranks<D>& ranks) {
          const auto given = planned.observe(cut.blocks.domain(ranks.transport->rank()), ranks, bytes);
          if (ranks.first()) found = given;
        });
        CHECK((found == expected));
      }
    }
  }
}

}  // namespace

TEST_CASE("fields in bands are those of the whole lattice, in two dimensions") {
  const std::string layers = R"(/fluid/layers=[{"from": "3 um", "to": "12.3 um", "viscosity": "2 cP"}])",
                    nodes = "/domain/nodes=[64, 32]";
  check<double, D2Q9>({"walls that move", four_cells, {shear, no_cells, none, nodes, layers, fields}});
  check<float, D2Q9>({"periodic", four_cells, {driven, no_cells, none, nodes, "/domain/y=\"periodic\"", fields}});
}

TEST_CASE("fields in bands are those of the whole lattice, in three dimensions and around solid nodes") {
  const std::string capsule = ROULEAU_SCENES "/../tests/physics/scenes/plain-capsule-3d.json";
  const auto of = [&](const std::string& walls) {
    return std::vector<std::string>{
        "/cells=[]", R"(/stages=[{"name": "driven", "pressure_gradient": "1e5 Pa/m", "duration": "1 s"}])", fields,
        R"(/domain={"size": ["12 um", "9 um", "7.5 um"], "nodes": [16, 12, 10])" + walls + "}"};
  };
  check<double, D3Q19>({"walls", capsule, of(R"(, "y": {"lower": {"wall": {}}, "upper": {"wall": {}}})")});
  check<float, D3Q19>({"periodic", capsule, of(R"(, "y": "periodic", "z": "periodic")")});
  check<double, D3Q19>(
      {"tube",
       capsule,
       {"/cells=[]", R"(/stages=[{"name": "driven", "pressure_gradient": "1e5 Pa/m", "duration": "1 s"}])", fields,
        R"(/domain={"size": ["12 um", "12 um", "12 um"], "nodes": [16, 16, 16],
                    "walls": {"tube": {"radius": "6 um"}}})"}});
}

TEST_CASE("between openings the vorticity of a velocity that grows along x is the same up to the ends") {
  scene::Scene scene = plan::read_scene(four_cells, {driven, no_cells, none, "/domain/nodes=[64, 32]", fields});
  const plan::Plan plan = plan::make_plan(scene, catalog());
  auto setup = plan::make_solver_setup<2>(plan, 0);
  setup.domain = core::Domain<2>({64, 32}, {false, false});
  setup.openings.emplace();
  setup.follow_cells = false;
  auto cells = plan::make_cells<2>(scene);
  core::Solver<double> solver(std::move(setup), cells);
  constexpr double slope = 1e-4;
  solver.fluid().set_state([](int x, int) { return core::Fluid<double>::State{0, {0, slope * x}, {}}; });
  solver.fluid().settle();
  scene.domain.periodic[0] = false;
  const units::LatticeUnits& units = plan.stages.front().units;
  const auto snapshot = observe::observe_fields(solver.fluid(), scene, units, 1 << 20);
  for (const observe::Field& field : snapshot.fields) {
    if (field.name != "vorticity") continue;
    const std::vector<double> values = whole(field);
    for (const std::size_t y : {std::size_t{1}, std::size_t{16}, std::size_t{30}}) {
      for (std::size_t x = 0; x < 64; ++x)
        CHECK(values[64 * y + x] == Approx(units.to_si(slope, units::dimension::rate)).epsilon(1e-9));
    }
  }
}
