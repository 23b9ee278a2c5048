// Spreading and interpolation: moments of the kernel, adjointness, independence of the workers, escaped nodes.
#include "core/coupling/coupling.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "core/fluid/periodic.hpp"
#include "unit/cell_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

template <class T>
VectorField<T, 2> field(int nx, int ny) {
  return {Field<T, 2>({nx, ny}), Field<T, 2>({nx, ny})};
}

template <class T, class Visit>
void for_all(const Field<T, 2>& f, Visit visit) {
  for (int y = -2; y < f.size(1) + 2; ++y) {
    for (int x = -2; x < f.size(0) + 2; ++x) visit(x, y, f.row(y)[x]);
  }
}

const core::Domain<2> channel({80, 64}, {true, false});

Membranes cells_with_forces(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Membranes m = biconcave_cells({{30, 20, 0.3}, {33, 40, 1.2}});
  deform(m, random, 2, 0.3);
  for (std::size_t i = 0; i < m.position[0].size(); ++i)
    m.force[0][i] = uniform(random), m.force[1][i] = uniform(random);
  return m;
}

}  // namespace

TEST_CASE("force and torque on the lattice are those of the nodes") {
  auto random = generator(72);
  const Membranes m = cells_with_forces(random);
  const KernelKind kernel = GENERATE(KernelKind::peskin4, KernelKind::roma3, KernelKind::linear2, KernelKind::sharp6);
  Coupling<double, 2> coupling(kernel, channel);
  coupling.reserve(m);
  coupling.locate({}, m, m.positions());
  CHECK(coupling.escaped(m) == -1);
  auto force = field<double>(80, 64);
  coupling.spread({0, force[0].size(1)}, m, m.forces(), force);
  double fx = 0, fy = 0, torque = 0;
  for_all(force[0], [&](int, int y, double f) { fx += f, torque -= y * f; });
  for_all(force[1], [&](int x, int, double f) { fy += f, torque += x * f; });
  const ForceSums sums = force_sums(m);
  CHECK(std::abs(fx - sums.x) < 1e-14 * sums.size);
  CHECK(std::abs(fy - sums.y) < 1e-14 * sums.size);
  CHECK(std::abs(torque - sums.torque) < 1e-14 * sums.lever);
}

namespace {

/// Sum of force times velocity over the lattice and the walls, less that over the nodes, for a random velocity and
/// walls that move. What nodes give lattice and walls get.
template <class T>
double adjointness_error(const Coupling<T, 2>& coupling, Membranes& m, const core::Domain<2>& domain,
                         std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int nx = domain.size[0], ny = domain.size[1];
  auto force = field<T>(nx, ny), velocity = field<T>(nx, ny);
  coupling.spread({0, ny}, m, m.forces(), force);
  double error = 0;
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) {
      velocity[0].row(y)[x] = static_cast<T>(uniform(random));
      velocity[1].row(y)[x] = static_cast<T>(uniform(random));
      error += static_cast<double>(force[0].row(y)[x]) * static_cast<double>(velocity[0].row(y)[x]) +
               static_cast<double>(force[1].row(y)[x]) * static_cast<double>(velocity[1].row(y)[x]);
    }
  }
  const WallVelocity walls{0.3, -0.7};
  for (int y = 0; y < ny; ++y) fill_velocity_halo<T, 2>(velocity, {y}, domain, walls);
  coupling.interpolate({}, m, velocity);
  const WallForces<2> share = coupling.wall_share(m, m.forces(), {});
  error += share.lower[0] * walls.lower + share.upper[0] * walls.upper;
  double lost[2] = {-share.all(0), -share.all(1)};
  for (std::size_t i = 0; i < m.position[0].size(); ++i) lost[0] += m.force[0][i], lost[1] += m.force[1][i];
  for (int k = 0; k < 2; ++k) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) lost[k] -= static_cast<double>(force[k].row(y)[x]);
    }
    CHECK(std::abs(lost[k]) < 2 * std::numeric_limits<T>::epsilon() * force_sums(m).size);
  }
  for (std::size_t i = 0; i < m.position[0].size(); ++i)
    error -= m.force[0][i] * m.velocity[0][i] + m.force[1][i] * m.velocity[1][i];
  return error;
}

}  // namespace

TEMPLATE_TEST_CASE("spreading and interpolation are adjoint, over periodic borders and beside walls too", "", float,
                   double) {
  auto random = generator(73);
  Membranes m = cells_with_forces(random);
  for (double& x : m.position[0]) x -= 300;  // far outside the periodic box, and across its border
  const core::Domain<2> domain({70, 64}, {true, GENERATE(false, true)});
  std::uniform_real_distribution<double> anywhere(-1, 63.4);
  for (std::size_t i = 0; i < m.position[1].size(); i += 3) m.position[1][i] = anywhere(random);
  const KernelKind kernel =
      GENERATE(KernelKind::peskin4, KernelKind::cosine4, KernelKind::roma3, KernelKind::linear2, KernelKind::sharp6);
  Coupling<TestType, 2> coupling(kernel, domain);
  coupling.reserve(m);
  coupling.locate({}, m, m.positions());
  REQUIRE(coupling.escaped(m) == -1);
  CHECK(std::abs(adjointness_error(coupling, m, domain, random)) < 100 * std::numeric_limits<TestType>::epsilon());
}

TEST_CASE("linear velocity is interpolated exactly by every kernel without a first moment") {
  auto random = generator(74);
  Membranes m = cells_with_forces(random);
  const KernelKind kernel = GENERATE(KernelKind::peskin4, KernelKind::roma3, KernelKind::linear2, KernelKind::sharp6);
  Coupling<double, 2> coupling(kernel, channel);
  coupling.reserve(m);
  coupling.locate({}, m, m.positions());
  auto velocity = field<double>(80, 64);
  for (int y = -2; y < 66; ++y) {
    for (int x = -2; x < 82; ++x) velocity[0].row(y)[x] = 0.1 + 0.02 * y - 0.01 * x, velocity[1].row(y)[x] = 0.03 * x;
  }
  coupling.interpolate({}, m, velocity);
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    REQUIRE(m.velocity[0][i] == Approx(0.1 + 0.02 * m.position[1][i] - 0.01 * m.position[0][i]).margin(1e-13));
    REQUIRE(m.velocity[1][i] == Approx(0.03 * m.position[0][i]).margin(1e-13));
  }
}

TEMPLATE_TEST_CASE("spread forces are the same to the last bit for any number of workers", "", float, double) {
  auto random = generator(75);
  Membranes m = cells_with_forces(random);
  std::vector<VectorField<TestType, 2>> results;
  for (const int workers : {1, 2, 3, 7}) {
    Coupling<TestType, 2> coupling(KernelKind::peskin4, channel);
    coupling.reserve(m);
    run_pass(workers, [&](Worker worker) { coupling.locate(worker, m, m.positions()); });
    results.push_back(field<TestType>(80, 64));
    run_pass(workers, [&](Worker worker) { coupling.spread(worker.share(64), m, m.forces(), results.back()); });
    run_pass(workers, [&](Worker worker) { coupling.interpolate(worker, m, results.back()); });
    for_all(results.back()[0], [&](int x, int y, TestType f) { REQUIRE(f == results.front()[0].row(y)[x]); });
    for_all(results.back()[1], [&](int x, int y, TestType f) { REQUIRE(f == results.front()[1].row(y)[x]); });
  }
}

TEST_CASE("a node beyond a wall, or nowhere, is reported and touches nothing") {
  auto random = generator(76);
  Membranes m = cells_with_forces(random);
  const double bad = GENERATE(-1.01, 64.0, 1e30, -1e300, std::numeric_limits<double>::infinity(), std::nan(""));
  m.position[1][77] = bad;
  Coupling<double, 2> coupling(KernelKind::peskin4, channel);
  coupling.reserve(m);
  coupling.locate({}, m, m.positions());
  CHECK(coupling.escaped(m) == 77);
  auto force = field<double>(80, 64);
  coupling.spread({0, force[0].size(1)}, m, m.forces(), force);
  double sum = 0, expected = 0;
  for_all(force[0], [&](int, int, double f) { sum += f; });
  for (std::size_t i = 0; i < m.position[0].size(); ++i) expected += i == 77 ? 0 : m.force[0][i];
  CHECK(sum == Approx(expected).margin(1e-12));
  coupling.interpolate({}, m, force);
  CHECK(m.velocity[1][77] == 0);
}

TEST_CASE("nodes may lie on the outermost rows, half a spacing beyond the walls, and wherever rounding wraps them") {
  Membranes m = biconcave_cells({{30, 30, 0}}, 8);
  Coupling<double, 2> coupling(KernelKind::peskin4, channel);
  coupling.reserve(m);
  m.position[1][0] = -1.0;
  m.position[1][1] = 63.999999;
  m.position[0][2] = -1e-17;  // the fraction rounds to 1: the column wraps to the last
  m.position[0][3] = 80 - 1e-14;
  coupling.locate({}, m, m.positions());
  CHECK(coupling.escaped(m) == -1);
  std::fill(m.force[0].begin(), m.force[0].end(), 1.0);
  auto random = generator(78);
  CHECK(std::abs(adjointness_error(coupling, m, channel, random)) < 1e-14);
}
