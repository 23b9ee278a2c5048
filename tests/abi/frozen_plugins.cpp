// The plugins of the first release in the host of today: they load, are told what they were told then, and what they
// compute means what it meant. The same again with libraries of a release to come, whose structs are larger.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <vector>

#include "plugin/catalog.hpp"
#include "plugin/model.hpp"

using namespace rouleau::plugin;

namespace {

constexpr double round_off = 1e-14;  // some fifty operations of one unit in the last place each

/// 0.1 um, 1 us and 1e-15 kg; kT and chains per um2 are then far from 1, so that a forgotten conversion shows.
ModelSetting setting(bool inertia = false) { return {{1e-7, 1e-6, 1e-15}, 1.25, inertia}; }

const Catalog& catalog(const std::string& folder) {
  static const Catalog first({FROZEN_PLUGINS}), later({LATER_PLUGINS});
  return folder == "first" ? first : later;
}

ModelInstance make(const std::string& folder, ModelKind kind, const std::string& id, const std::vector<double>& values,
                   const ModelSetting& with = setting()) {
  return {catalog(folder).find(kind, id, {}), values, with};
}

template <class Block>
Block block_of(std::uint32_t count) {
  Block block{};
  block.struct_size = sizeof block;
  block.count = count;
  return block;
}

/// D2Q9 in the order of the first release: authors of operators rely on it.
constexpr int velocity[9][2] = {{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
constexpr double weight[9] = {4. / 9, 1. / 9, 1. / 9, 1. / 9, 1. / 9, 1. / 36, 1. / 36, 1. / 36, 1. / 36};

struct Moments {
  double density = 0, momentum[2] = {}, stress[3] = {};
};
Moments moments(const double (&f)[9]) {
  Moments m;
  for (int q = 0; q < 9; ++q) {
    const double cx = velocity[q][0], cy = velocity[q][1];
    m.density += f[q];
    m.momentum[0] += cx * f[q];
    m.momentum[1] += cy * f[q];
    m.stress[0] += cx * cx * f[q];
    m.stress[1] += cx * cy * f[q];
    m.stress[2] += cy * cy * f[q];
  }
  return m;
}

/// One node through the frozen operator; `rate` 0: that of the setup.
void collide(const ModelInstance& model, double (&f)[9], const double (&force)[2], double rate, double (&u)[2]) {
  const double *in[9], *forces[2];
  double *out[9], *velocities[2];
  for (int q = 0; q < 9; ++q) in[q] = out[q] = &f[q];
  for (int k = 0; k < 2; ++k) {
    forces[k] = &force[k];
    velocities[k] = &u[k];
  }
  auto block = block_of<rouleau_collision_block_f64>(1);
  block.in = in;
  block.out = out;
  block.force = forces;
  block.velocity = velocities;
  block.relaxation_rate = rate == 0 ? nullptr : &rate;
  model.collision().collide_f64(model.self(), &block);
}

}  // namespace

TEST_CASE("the frozen plugins are found and none is refused") {
  const std::string release = GENERATE("first", "later");
  CHECK(catalog(release).refused().empty());
  CHECK(catalog(release).manifests().size() == 6);
}

TEST_CASE("the frozen collision operator conserves, relaxes the shear stress by 1 - 1/tau and takes the force") {
  const std::string release = GENERATE("first", "later");
  const bool inertia = GENERATE(false, true);
  const ModelInstance model = make(release, ModelKind::collision, "frozen.bgk", {}, setting(inertia));
  const double force[2] = {3e-4, -2e-4};
  for (const double rate : {0.0, 0.7}) {
    double f[9] = {1e-3, 4e-3, -2e-3, 5e-4, 3e-3, -1e-3, 2e-3, 7e-4, -6e-4}, u[2];
    const Moments before = moments(f);
    collide(model, f, force, rate, u);
    const Moments after = moments(f);
    CHECK(after.density == Approx(before.density).epsilon(round_off));
    for (int k = 0; k < 2; ++k) {
      CHECK(after.momentum[k] == Approx(before.momentum[k] + force[k]).epsilon(round_off));
      CHECK(u[k] == Approx(before.momentum[k] + force[k] / 2).epsilon(round_off));
    }
    // Second moments of equilibrium and source: rho/3 + u u (He and Luo) and u F + F u (Guo), with inertia only.
    const double omega = rate == 0 ? 1.25 : rate, quadratic = inertia ? 1 : 0;
    const double equilibrium = quadratic * u[0] * u[1], source = quadratic * (u[0] * force[1] + u[1] * force[0]);
    CHECK(after.stress[1] ==
          Approx((1 - omega) * before.stress[1] + omega * equilibrium + (1 - omega / 2) * source).epsilon(round_off));
  }
}

TEST_CASE("the frozen collision operator leaves equilibrium as it is, in both precisions and without a force") {
  const std::string release = GENERATE("first", "later");
  const ModelInstance model = make(release, ModelKind::collision, "frozen.bgk", {}, setting());
  float values[9];
  const float* in[9];
  float* out[9];
  for (int q = 0; q < 9; ++q) {
    values[q] = static_cast<float>(weight[q] * (1e-2 + 3 * (velocity[q][0] * 2e-3 - velocity[q][1] * 1e-3)));
    in[q] = out[q] = &values[q];
  }
  float before[9];
  std::copy(values, values + 9, before);
  auto block = block_of<rouleau_collision_block_f32>(1);
  block.in = in;
  block.out = out;
  model.collision().collide_f32(model.self(), &block);
  for (int q = 0; q < 9; ++q) CHECK(values[q] == Approx(before[q]).epsilon(1e-5));  // single precision
}

TEST_CASE("the frozen law of segments has spring, Maxwell branch with state, and viscosity") {
  const std::string release = GENERATE("first", "later");
  const double modulus = 6e-6, branch = 2e-6, time = 5e-6, viscosity = 4e-9;
  const ModelInstance model = make(release, ModelKind::membrane, "frozen.solid", {modulus, branch, time, viscosity});
  CHECK(model.initial_state() == std::vector<double>{1});
  const double surface = 1e-15 / 1e-12;  // kg/s2 = N/m
  double stretch = 1.2, rate = 0, tension, energy, by_stretch, by_rate, dashpot = model.initial_state()[0];
  auto block = block_of<rouleau_membrane_block>(1);
  double* state[1] = {&dashpot};
  block.stretch = &stretch;
  block.stretch_rate = &rate;
  block.tension = &tension;
  block.energy = &energy;
  block.tension_by_stretch = &by_stretch;
  block.tension_by_rate = &by_rate;
  block.state = state;
  block.new_state = state;
  block.time_step = 1;
  // Held at a stretch, the branch's strain decays as exp(-t/tau); a step is 1 us.
  for (int step = 1; step <= 10; ++step) {
    model.membrane().compute(model.self(), &block);
    const double strain = 0.2 * std::exp(-step * 1e-6 / time);
    CHECK(tension * surface == Approx(modulus * 0.2 + branch * strain).epsilon(round_off));
    CHECK(energy * surface == Approx(0.5 * modulus * 0.04 + 0.5 * branch * strain * strain).epsilon(round_off));
    CHECK(dashpot == Approx(1.2 - strain).epsilon(round_off));
  }
  // A look without a step changes nothing; a rate of stretch adds viscosity times rate.
  const double kept = dashpot, still = tension;
  block.time_step = 0;
  rate = 0.01;
  model.membrane().compute(model.self(), &block);
  CHECK(dashpot == kept);
  CHECK((tension - still) * surface == Approx(viscosity * 0.01 / 1e-6).epsilon(1e-12));  // a difference of two numbers
  CHECK(by_rate * surface * 1e-6 == Approx(viscosity).epsilon(round_off));
  CHECK(by_stretch * surface == Approx(modulus + branch).epsilon(round_off));
}

TEST_CASE("the frozen laws of nodes and of whole cells are derivatives of their energies, with the signs of 1.0") {
  const std::string release = GENERATE("first", "later");
  const ModelInstance bending = make(release, ModelKind::membrane, "frozen.bending", {2e-19});
  double curvature = 0.3, rest_curvature = 0.1, moment, energy, by_curvature;
  auto node = block_of<rouleau_membrane_block>(1);
  node.curvature = &curvature;
  node.rest_curvature = &rest_curvature;
  node.moment = &moment;
  node.energy = &energy;
  node.moment_by_curvature = &by_curvature;
  bending.membrane().compute(bending.self(), &node);
  const double joule = 1e-15 * 1e-14 / 1e-12;
  CHECK(moment * joule == Approx(2e-19 * 0.2).epsilon(round_off));
  CHECK(energy * joule == Approx(0.5 * 2e-19 * 0.04).epsilon(round_off));
  CHECK(by_curvature * joule == Approx(2e-19).epsilon(round_off));

  const ModelInstance whole = make(release, ModelKind::membrane, "frozen.cell", {100, 1e-6});
  double area = 110, rest_area = 100, perimeter = 38, rest_perimeter = 40, pressure, tension;
  auto cell = block_of<rouleau_membrane_block>(1);
  cell.area = &area;
  cell.rest_area = &rest_area;
  cell.perimeter = &perimeter;
  cell.rest_perimeter = &rest_perimeter;
  cell.pressure = &pressure;
  cell.perimeter_tension = &tension;
  cell.energy = &energy;
  whole.membrane().compute(whole.self(), &cell);
  // Swollen by a tenth: pressure draws inward. Too short by a twentieth: the tension pushes the nodes apart.
  CHECK(pressure * (1e-15 / (1e-7 * 1e-12)) == Approx(-100 * 0.1).epsilon(round_off));
  CHECK(tension * (1e-15 / 1e-12) == Approx(-1e-6 * 0.05).epsilon(round_off));
  CHECK(energy * (1e-15 * 1e-7 / 1e-12) ==
        Approx(0.5 * 100 * 0.1 * 10e-14 / 1e-7 * 1e-7 + 0.5 * 1e-6 * 0.05 * 2e-7).epsilon(round_off));
}

TEST_CASE("the frozen interaction gets SI for a temperature and an index for a choice, and its state is kept") {
  const std::string release = GENERATE("first", "later");
  const int form = GENERATE(0, 1);
  const double chains = 3e15, temperature = 310, thickness = 4e-8;
  const ModelInstance model = make(release, ModelKind::interaction, "frozen.brush",
                                   {chains, temperature, thickness, static_cast<double>(form)});
  CHECK(model.interaction().cutoff(model.self()) * 1e-7 == Approx(form == 0 ? thickness : 20 * thickness));
  CHECK(model.initial_state() == std::vector<double>{0});
  const double r = 1.5e-8;
  double distance = r / 1e-7, energy, force, slope, age = 0;
  double* state[1] = {&age};
  auto block = block_of<rouleau_interaction_block>(1);
  block.time_step = 1;
  block.distance = &distance;
  block.energy = &energy;
  block.force = &force;
  block.force_by_distance = &slope;
  block.state = state;
  block.new_state = state;
  for (int step = 0; step < 3; ++step) model.interaction().compute(model.self(), &block);
  CHECK(age * 1e-6 == Approx(3e-6).epsilon(round_off));
  const double nkt = chains * 1.380649e-23 * temperature, x = r / thickness;
  const double phi = form == 0 ? (1 - x) * (1 - x) : std::exp(-x);
  const double first = form == 0 ? 2 * (1 - x) : std::exp(-x), second = form == 0 ? -2 : -std::exp(-x);
  const double surface = 1e-15 / 1e-12, pressure = surface / 1e-7;
  CHECK(energy * surface == Approx(nkt * phi).epsilon(round_off));
  CHECK(force * pressure == Approx(nkt / thickness * first).epsilon(round_off));
  CHECK(slope * pressure / 1e-7 == Approx(nkt / (thickness * thickness) * second).epsilon(round_off));
}

TEST_CASE("the frozen damper gets the velocity at which the distance grows and resists it") {
  const std::string release = GENERATE("first", "later");
  const ModelInstance model = make(release, ModelKind::interaction, "frozen.damper", {50, 4e-8});
  const double distance[2] = {0.1, 0.6}, speed[2] = {-2e-4 / 0.1, 1};  // 0.1 m/s is one spacing per step
  double force[2];
  auto block = block_of<rouleau_interaction_block>(2);
  block.distance = distance;
  block.normal_velocity = speed;
  block.force = force;
  model.interaction().compute(model.self(), &block);
  CHECK(force[0] * (1e-15 / (1e-7 * 1e-12)) == Approx(50 * 2e-4).epsilon(round_off));  // approach is pushed back
  CHECK(force[1] == 0);
}

TEST_CASE("a plugin of the first release that misses a parameter says so in the caller's buffer") {
  const Manifest& manifest = catalog("first").find(ModelKind::interaction, "frozen.brush", {});
  Manifest other = manifest;
  other.parameters[0].name = "chains_of_another_name";
  try {
    const ModelInstance model(other, {3e15, 310, 4e-8, 0}, setting());
    FAIL("it was made");
  } catch (const ModelRefused& refused) {
    CHECK(refused.reason() == "a parameter is missing");
  }
}
