// What membranes read and spread beside walls of any shape: exact for shear, adjoint, balanced, the same in all blocks.
#include "core/coupling/wall_reach.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>

#include "core/coupling/coupling.hpp"
#include "core/fluid/periodic.hpp"
#include "core/geometry/formulas.hpp"
#include "core/geometry/region.hpp"
#include "unit/random.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

template <int D>
class HalfSpace final : public Region<D> {
 public:
  HalfSpace(const Vec<D>& on_border, const Vec<D>& inward) : on_border_(on_border), inward_(inward.normalized()) {}
  [[nodiscard]] Distance<D> distance(const Vec<D>& place) const override {
    return {inward_.dot(place - on_border_), inward_};
  }

 private:
  Vec<D> on_border_, inward_;
};

template <int D>
constexpr std::array<int, D> lattice_size() {
  if constexpr (D == 2) return {36, 34};
  if constexpr (D == 3) return {36, 34, 32};
}

/// Between plane walls along y, in three dimensions along z, too; with what closes a region, and one cell of so many
/// nodes.
template <class T, int D>
struct Bench {
  explicit Bench(RegionPointer<D> of_fluid, int nodes = 400)
      : domain(lattice_size<D>(), periodic()), region(std::move(of_fluid)), solid(domain.size, region) {
    for (int k = 0; k < D; ++k) {
      for (auto* numbers : {&cells.position[k], &cells.force[k], &cells.velocity[k]})
        numbers->assign(static_cast<std::size_t>(nodes), 0.0);
    }
    cells.cells.push_back({});
    cells.cells[0].first = 0, cells.cells[0].count = nodes;
  }
  static std::array<bool, D> periodic() {
    std::array<bool, D> along{};
    along[0] = true;
    return along;
  }
  static VectorField<T, D> field(const Domain<D>& of) {
    std::array<int, D> size;
    for (int k = 0; k < D; ++k) size[k] = of.block.size(k);
    VectorField<T, D> values;
    for (auto& component : values) component = Field<T, D>(size);
    return values;
  }
  /// Calls function(node, row, x) for the block's nodes that are not solid.
  template <class Function>
  void for_fluid(const Domain<D>& of, Function function) const {
    for (int i = 0; i < row_count(of.block); ++i) {
      const auto row = row_of(of.block, i);
      for (int x = 0; x < of.block.size(0); ++x) {
        std::array<int, D> node{of.block.begin[0] + x};
        for (int k = 1; k < D; ++k) node[k] = of.block.begin[k] + row[k - 1];
        if (!solid.at(node)) function(node, row, x);
      }
    }
  }
  /// Velocities as the fluid leaves them: 0 in the solid, images beyond the ends.
  template <class Velocity>
  VectorField<T, D> velocity(Velocity at, const WallVelocity& walls = {}) const {
    VectorField<T, D> values = field(domain);
    for_fluid(domain, [&](const std::array<int, D>& node, const auto& row, int x) {
      Vec<D> place;
      for (int k = 0; k < D; ++k) place[k] = node[k];
      const Vec<D> u = at(place);
      for (int k = 0; k < D; ++k) values[k].row(row)[x] = static_cast<T>(u[k]);
    });
    for (int i = 0; i < row_count(domain.block); ++i)
      fill_velocity_halo<T, D>(values, row_of(domain.block, i), domain, walls);
    return values;
  }
  void place(int node, const Vec<D>& at) {
    for (int k = 0; k < D; ++k) cells.position[k][static_cast<std::size_t>(node)] = at[k];
  }
  [[nodiscard]] Vec<D> of(const NodeArrays& arrays, int node) const {
    Vec<D> vector;
    for (int k = 0; k < D; ++k) vector[k] = arrays[k][static_cast<std::size_t>(node)];
    return vector;
  }
  std::unique_ptr<Coupling<T, D>> coupling(KernelKind kernel, const Domain<D>& of) {
    auto made = std::make_unique<Coupling<T, D>>(kernel, of, &solid, region);
    made->reserve(cells);
    made->locate({}, cells, cells.positions());
    return made;
  }

  Domain<D> domain;
  RegionPointer<D> region;
  SolidNodes<D> solid;
  Cells<D> cells;
};

template <int D>
Vec<D> random_vector(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  Vec<D> vector;
  for (int k = 0; k < D; ++k) vector[k] = any(random);
  return vector;
}
template <int D>
Vec<D> middle() {
  Vec<D> place;
  for (int k = 0; k < D; ++k) place[k] = (lattice_size<D>()[k] - 1) / 2.0;
  return place;
}

template <int D>
void check_shear() {
  auto random = generator(401);
  for (int wall = 0; wall < 6; ++wall) {
    const Vec<D> inward = random_vector<D>(random).normalized();
    Bench<double, D> bench(std::make_shared<HalfSpace<D>>(middle<D>() - 0.3 * inward, inward));
    const Vec<D> along = random_vector<D>(random).normalized();
    const auto shear = [&](const Vec<D>& place) -> Vec<D> { return 0.1 * bench.region->distance(place).value * along; };
    const VectorField<double, D> u = bench.velocity(shear);
    for (int i = 0; i < bench.cells.node_count(); ++i) {
      Vec<D> at = middle<D>() + random_vector<D>(random);
      at += (std::abs(random_vector<D>(random)[0]) * 2 - bench.region->distance(at).value) * inward;
      bench.place(i, at);
    }
    for (const KernelKind kernel : {KernelKind::peskin4, KernelKind::roma3, KernelKind::linear2, KernelKind::sharp6}) {
      const auto coupling = bench.coupling(kernel, bench.domain);
      coupling->interpolate({}, bench.cells, u);
      double worst = 0, largest = 0;
      for (int i = 0; i < bench.cells.node_count(); ++i) {
        const Vec<D> exact = shear(bench.of(bench.cells.position, i));
        worst = std::max(worst, (bench.of(bench.cells.velocity, i) - exact).norm());
        largest = std::max(largest, exact.norm());
      }
      CHECK(worst < 1e-13);
      CHECK(largest > 0.05);
    }
  }
}

/// Largest error of what is read of a parabolic flow in a disc or a ball, of all nodes with solid ones in reach, over
/// the largest velocity.
template <int D>
double error_of_parabola(double radius, KernelKind kernel) {
  auto random = generator(406);
  std::uniform_real_distribution<double> depth(0, 2);
  const Vec<D> center = middle<D>() + Vec<D>::Constant(0.21);
  Bench<double, D> bench(ball_region<D>(center, radius), 2000);
  const auto flow = [&](const Vec<D>& place) -> Vec<D> {
    return (1 - (place - center).squaredNorm() / (radius * radius)) * Vec<D>::Unit(0);
  };
  for (int i = 0; i < bench.cells.node_count(); ++i)
    bench.place(i, center + (radius - depth(random)) * random_vector<D>(random).normalized());
  const auto coupling = bench.coupling(kernel, bench.domain);
  coupling->interpolate({}, bench.cells, bench.velocity(flow));
  double worst = 0;
  for (int i = 0; i < bench.cells.node_count(); ++i) {
    const Vec<D> exact = flow(bench.of(bench.cells.position, i));
    worst = std::max(worst, (bench.of(bench.cells.velocity, i) - exact).norm());
  }
  return worst;
}

/// A corner of a tilted box, in reach of the plane walls, so that everything meets.
template <int D>
RegionPointer<D> some_corner(std::mt19937& random) {
  const Vec<D> tip = middle<D>() + 4 * random_vector<D>(random);
  std::vector<RegionPointer<D>> sides;
  for (int k = 0; k < D; ++k) sides.push_back(std::make_shared<HalfSpace<D>>(tip, random_vector<D>(random)));
  return intersection<D>(sides);
}

template <class T, int D>
void check_balances(const RegionPointer<D>& region, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  const WallVelocity walls{0.3, -0.7};
  Bench<T, D> bench(region);
  for (int i = 0; i < bench.cells.node_count(); ++i) {
    Vec<D> at;
    do {
      for (int k = 0; k < D; ++k) at[k] = middle<D>()[k] + any(random) * (bench.domain.size[k] / 2.0 - 0.1);
    } while (!(bench.region->distance(at).value > 0));
    bench.place(i, at);
    for (int k = 0; k < D; ++k) bench.cells.force[k][static_cast<std::size_t>(i)] = any(random);
  }
  for (const KernelKind kernel :
       {KernelKind::peskin4, KernelKind::roma3, KernelKind::linear2, KernelKind::cosine4, KernelKind::sharp6}) {
    const auto coupling = bench.coupling(kernel, bench.domain);
    const auto force = [&] {
      VectorField<T, D> spread = Bench<T, D>::field(bench.domain);
      coupling->spread({0, row_count(bench.domain.block)}, bench.cells, bench.cells.forces(), spread);
      return spread;
    }();
    const VectorField<T, D> u =
        bench.velocity([&](const Vec<D>&) -> Vec<D> { return random_vector<D>(random); }, walls);
    coupling->interpolate({}, bench.cells, u);
    const WallForces<D> share = coupling->wall_share(bench.cells, bench.cells.forces(), {});
    double power = share.lower[0] * walls.lower + share.upper[0] * walls.upper;
    Vec<D> lost;
    for (int k = 0; k < D; ++k) lost[k] = -share.all(k);
    for (int i = 0; i < bench.cells.node_count(); ++i) {
      power -= bench.of(bench.cells.force, i).dot(bench.of(bench.cells.velocity, i));
      lost += bench.of(bench.cells.force, i);
    }
    bench.for_fluid(bench.domain, [&](const auto&, const auto& row, int x) {
      for (int k = 0; k < D; ++k) {
        const auto here = static_cast<double>(force[k].row(row)[x]);
        power += here * static_cast<double>(u[k].row(row)[x]);
        lost[k] -= here;
      }
    });
    const double rounding = sizeof(T) == 4 ? 2e-4 : 1e-12;
    CHECK(std::abs(power) < rounding);
    CHECK(lost.norm() < rounding);
    CHECK(std::abs(share.other[0]) > 0.001);
  }
}

template <class T, int D>
void check_blocks() {
  auto random = generator(403);
  std::uniform_real_distribution<double> any(-1, 1);
  Bench<T, D> bench(some_corner<D>(random));
  for (int i = 0; i < bench.cells.node_count(); ++i) {
    for (int k = 0; k < D; ++k) {
      bench.cells.position[k][static_cast<std::size_t>(i)] =
          middle<D>()[k] + any(random) * (bench.domain.size[k] / 2.0 - 0.1) + (k == 0 ? 3 * bench.domain.size[0] : 0);
      bench.cells.force[k][static_cast<std::size_t>(i)] = any(random);
    }
  }
  const KernelKind kernel = GENERATE(KernelKind::peskin4, KernelKind::sharp6);
  VectorField<T, D> whole = Bench<T, D>::field(bench.domain);
  const auto of_whole = bench.coupling(kernel, bench.domain);
  of_whole->spread({0, row_count(bench.domain.block)}, bench.cells, bench.cells.forces(), whole);
  for (int axis = 0; axis < D; ++axis) {
    for (const auto& borders : {std::vector{0, 9, bench.domain.size[axis]}, {0, 2, 5, bench.domain.size[axis]}}) {
      for (std::size_t b = 1; b < borders.size(); ++b) {
        Domain<D> part = bench.domain;
        part.block.begin[axis] = borders[b - 1], part.block.end[axis] = borders[b];
        VectorField<T, D> force = Bench<T, D>::field(part);
        const auto coupling = bench.coupling(kernel, part);
        coupling->spread({0, row_count(part.block)}, bench.cells, bench.cells.forces(), force);
        bench.for_fluid(part, [&](const std::array<int, D>& node, const auto& row, int x) {
          std::array<int, D - 1> of_lattice;
          std::copy(node.begin() + 1, node.end(), of_lattice.begin());
          for (int k = 0; k < D; ++k) REQUIRE(force[k].row(row)[x] == whole[k].row(of_lattice)[node[0]]);
        });
      }
    }
  }
}

}  // namespace

TEST_CASE("shear along a plane wall at any angle is read exactly") {
  check_shear<2>();
  check_shear<3>();
}

TEST_CASE("flow along a curved wall is read to second order") {
  for (const KernelKind kernel : {KernelKind::peskin4, KernelKind::sharp6}) {
    for (const double radius : {5.0, 7.0, 10.0, 14.0}) {
      // Of which a kernel with the second moment 0.52 along each axis is off by 1.57 anywhere.
      const double bound = 1.8 / (radius * radius);
      CAPTURE(radius);
      CHECK(error_of_parabola<2>(radius, kernel) < bound);
      CHECK(error_of_parabola<3>(radius, kernel) < bound);
    }
  }
}

TEMPLATE_TEST_CASE(
    "in corners of walls of any shape and of plane walls that move, lattice and walls get the force and the power of "
    "the nodes",
    "", float, double) {
  auto random = generator(402);
  for (int corner = 0; corner < 4; ++corner) {
    check_balances<TestType, 2>(some_corner<2>(random), random);
    check_balances<TestType, 3>(some_corner<3>(random), random);
    check_balances<TestType, 3>(outside_of<3>(some_corner<3>(random)), random);
  }
}

TEST_CASE("beside walls and in their corners a membrane node is never faster than the fluid, nor its force larger") {
  auto random = generator(404);
  for (int corner = 0; corner < 10; ++corner) {
    Bench<double, 2> bench(some_corner<2>(random), 2000);
    const auto& tip = middle<2>();
    for (int i = 0; i < bench.cells.node_count(); ++i) bench.place(i, tip + 6 * random_vector<2>(random));
    const auto coupling = bench.coupling(KernelKind::peskin4, bench.domain);
    coupling->interpolate({}, bench.cells, bench.velocity([](const Vec<2>&) { return Vec<2>(1, 0); }));
    for (int i = 0; i < bench.cells.node_count(); ++i) {
      const double distance = bench.region->distance(bench.of(bench.cells.position, i)).value;
      const double read = bench.of(bench.cells.velocity, i)[0];
      CAPTURE(distance, read);
      CHECK(read >= 0);
      CHECK(read < 1 + 1e-12);
      if (distance > 3) CHECK(read == Approx(1).epsilon(1e-12));
    }
  }
}

TEMPLATE_TEST_CASE("beside walls of any shape spread forces are the same bits wherever blocks meet", "", float,
                   double) {
  check_blocks<TestType, 2>();
  check_blocks<TestType, 3>();
}
