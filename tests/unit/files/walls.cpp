// Walls that are no planes, as frames.h5 has them.
#include "files/walls.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/geometry/formulas.hpp"
#include "files/frames.hpp"
#include "scratch_folder.hpp"
#include "unit/run_fixture.hpp"

using namespace rouleau;
using namespace rouleau::files;
using rouleau::observe::wall_border;
using namespace rouleau::test;
using Catch::Contains;

namespace {

constexpr double um = 1e-6, pi = std::numbers::pi;

/// 60 um by 40 um, periodic along x, between walls across y, with a disc of 10 um that is an obstacle.
scene::Scene with_disc(double x, double y, int nodes) {
  scene::Scene scene = small_scene();
  scene.domain.size = {60 * um, 40 * um};
  scene.domain.nodes = {nodes * 3 / 2, nodes};
  scene.domain.periodic = {true, false, true};
  scene.domain.obstacles.push_back({scene::WallShape::Sphere{{x * um, y * um}, 10 * um}});
  core::Domain<2> box;  // the region is in m; so are its periods
  box.size = {60, 40};
  box.periodic = {true, false};
  const core::RegionPointer<2> disc =
      core::magnified<2>(core::repeated<2>(core::ball_region<2>({x - 0.5, y - 0.5}, 10), {x - 0.5, y - 0.5}, box), um,
                         core::Vec<2>::Constant(0.5 * um));
  scene.domain.region_in_plane = core::outside_of<2>(disc);
  return scene;
}

scene::Scene with_tube(int nodes) {
  scene::Scene scene = small_scene();
  scene.domain.size = {10 * um, 40 * um, 40 * um};
  scene.domain.nodes = {nodes / 4, nodes, nodes};
  scene.domain.periodic = {true, false, false};
  scene.domain.tube_radius = 18 * um;
  return scene;
}

/// Positive: counter-clockwise, so that what is inside lies at the left.
double area(const WallBorder& walls, std::size_t polygon) {
  const int first = walls.first[polygon], end = walls.first[polygon + 1];
  double twice = 0;
  for (int i = first; i < end; ++i) {
    const auto &a = walls.corners[std::size_t(i)], &b = walls.corners[std::size_t(i + 1 < end ? i + 1 : first)];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return twice / 2;
}

double area(const WallBorder& walls) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < walls.first.size(); ++i) sum += area(walls, i);
  return sum;
}

}  // namespace

TEST_CASE("polygons around a disc have its area, to second order, wherever it lies on the periodic axis") {
  double before = 0;
  for (const int nodes : {10, 20, 40}) {
    const WallBorder walls = wall_border(with_disc(31.3, 19.1, nodes));
    CHECK(walls.first.size() == 2);
    const double error = std::abs(area(walls) / (pi * 100 * um * um) - 1);
    CHECK(error <
          0.5 * std::pow(10.0 / nodes / 10, 2) + 2e-4);  // chords of 1.4 samples, and what is left out as straight
    if (before > 4e-4) CHECK(error < before / 2.5);
    before = error;
    for (const double x : {0.0, 3.0, 58.7}) {  // cut by the domain's ends
      const WallBorder cut = wall_border(with_disc(x, 19.1, nodes));
      CHECK(cut.first.size() == 3);
      CHECK(area(cut) / (pi * 100 * um * um) == Approx(1).epsilon(0.5 * std::pow(10.0 / nodes / 10, 2) + 2e-4));
      for (const auto& corner : cut.corners) CHECK((corner[0] >= -1e-12 && corner[0] <= 60.000001 * um));
    }
  }
}

TEST_CASE("walls that fill the corners of the domain keep these") {
  scene::Scene scene = with_disc(31.3, 19.1, 40);
  scene.domain.region_in_plane =
      core::box_region<2>(core::Vec<2>(-INFINITY, 9.7 * um), core::Vec<2>(INFINITY, 31.2 * um));
  const WallBorder walls = wall_border(scene);
  REQUIRE(walls.first == std::vector{0, 4, 8});
  CHECK(walls.segments.size() == 2);
  CHECK(area(walls, 0) == Approx(60 * 9.7 * um * um).epsilon(1e-6));
  CHECK(area(walls, 1) == Approx(60 * 8.8 * um * um).epsilon(1e-6));
}

TEST_CASE("a tube is cut by the plane through its axis into two walls, and its surface has its radius") {
  const WallBorder walls = wall_border(with_tube(40));
  REQUIRE(walls.first == std::vector<int>{0, 4, 8});  // two rectangles
  REQUIRE(walls.segments.size() == 2);                // of which fluid meets a side each
  for (const auto& [from, to] : walls.segments) {
    const auto &a = walls.corners[std::size_t(from)], &b = walls.corners[std::size_t(to)];
    CHECK(std::abs(a[1] - 20 * um) == Approx(18 * um));
    CHECK(a[1] == Approx(b[1]));
    CHECK((b[0] - a[0]) * (a[1] - 20 * um) > 0);  // the wall at the left
  }
  CHECK(area(walls) == Approx(2 * 2 * um * 10 * um).epsilon(1e-6));
  REQUIRE(!walls.triangles.empty());
  double surface = 0;
  for (const auto& triangle : walls.triangles) {
    const auto &a = walls.points[std::size_t(triangle[0])], &b = walls.points[std::size_t(triangle[1])],
               &c = walls.points[std::size_t(triangle[2])];
    const double u[] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const double normal[] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    surface += std::hypot(normal[0], normal[1], normal[2]) / 2;
    CHECK(normal[1] * (a[1] - 20 * um) + normal[2] * (a[2] - 20 * um) > 0);  // out of the fluid
  }
  CHECK(surface == Approx(2 * pi * 18 * um * 10 * um).epsilon(0.01));
  for (const auto& point : walls.points)
    CHECK(std::hypot(point[1] - 20 * um, point[2] - 20 * um) == Approx(18 * um).epsilon(1.0 / (8 * 18 * 18) * 2));
}

TEST_CASE("boxes that lie on samples and at the domain's end have four corners, and the area that they have") {
  for (const int nodes : {24, 32, 48, 64}) {
    scene::Scene scene = small_scene();
    scene.domain.size = {160 * um, 40 * um};
    scene.domain.nodes = {4 * nodes, nodes};
    scene.domain.periodic = {true, false, true};
    scene.domain.obstacles.resize(2);
    const auto box = [](double lower, double upper) {
      return core::outside_of<2>(core::box_region<2>({60 * um, lower * um}, {80 * um, upper * um}));
    };
    scene.domain.region_in_plane = core::intersection<2>({box(0, 10), box(30, 40)});
    const WallBorder walls = wall_border(scene);
    REQUIRE(walls.first.size() == 3);
    CHECK(area(walls) == Approx(2 * 20 * 10 * um * um).epsilon(0.01));  // corners are rounded within a sample
    CHECK(walls.segments.size() >= 6);
    for (const std::size_t polygon : {0u, 1u}) CHECK(area(walls, polygon) == Approx(200 * um * um).epsilon(0.01));
  }
}

TEST_CASE("the walls of a large lattice are sampled more coarsely") {
  const WallBorder tube = wall_border(with_tube(400));
  CHECK(tube.triangles.size() > 4000);
  CHECK(tube.triangles.size() <= 40000);
}

TEST_CASE("planes alone are no walls of frames.h5") {
  CHECK(wall_border(small_scene()).empty());
  const ScratchFolder folder;
  {
    hdf5::File file(folder.path() / "frames.h5", hdf5::File::Mode::create);
    write_walls(file, wall_border(small_scene()));
  }
  CHECK(read_walls(hdf5::File(folder.path() / "frames.h5", hdf5::File::Mode::read)).empty());
}

TEST_CASE("walls are the same in a run's frames, in one file, in segments, and while it goes on") {
  const scene::Scene scene = with_disc(3, 19, 40);
  const WallBorder walls = wall_border(scene);
  for (const int segments : {1, 3}) {
    const ScratchFolder folder;
    const auto file = folder.path() / "frames.h5";
    FrameWriter writer(file, scene);
    for (int i = 0; i < 3; ++i) {
      writer.write(small_snapshot(i, false, 32));
      if (segments == 3) writer.seal();
    }
    if (segments == 3) CHECK(FrameReader(file).walls().corners == walls.corners);
    writer.close();
    const WallBorder found = FrameReader(file).walls();
    CHECK(found.corners == walls.corners);
    CHECK(found.first == walls.first);
    CHECK_THAT(writer.xdmf(), Catch::Matchers::Contains(":/walls/corners"));
  }
}

TEST_CASE("walls whose numbers do not fit each other are damage") {
  const ScratchFolder folder;
  WallBorder walls = wall_border(with_tube(20));
  walls.triangles.front()[1] = static_cast<int>(walls.points.size());
  {
    hdf5::File file(folder.path() / "a.h5", hdf5::File::Mode::create);
    write_walls(file, walls);
  }
  CHECK_THROWS_WITH(read_walls(hdf5::File(folder.path() / "a.h5", hdf5::File::Mode::read)),
                    Contains("/walls/triangles does not fit"));
  walls.first.back() = static_cast<int>(walls.corners.size()) + 1;
  {
    hdf5::File file(folder.path() / "b.h5", hdf5::File::Mode::create);
    write_walls(file, walls);
  }
  CHECK_THROWS_WITH(read_walls(hdf5::File(folder.path() / "b.h5", hdf5::File::Mode::read)),
                    Contains("/walls/first does not fit"));
}
