#include "report/report_fields.hpp"

#include <catch2/catch.hpp>

#include "hdf5/hdf5_file.hpp"
#include "report/report.hpp"
#include "report/report_data.hpp"
#include "unit/run_fixture.hpp"

namespace hdf5 = rouleau::hdf5;
using namespace rouleau::files;
using namespace rouleau::observe;
using namespace rouleau::report;
using namespace rouleau::scene;
using namespace rouleau::test;

namespace {

/// Velocity (u, v) = f(x, y) at the nodes of a lattice, x and y in spacings.
template <class Flow>
std::vector<double> sampled(std::size_t nx, std::size_t ny, Flow flow) {
  std::vector<double> velocity;
  for (std::size_t y = 0; y < ny; ++y)
    for (std::size_t x = 0; x < nx; ++x) {
      const auto [u, v] = flow(double(x) + 0.5, double(y) + 0.5);
      velocity.insert(velocity.end(), {u, v, 0.0});
    }
  return velocity;
}

/// Of velocities that are given whole.
ScalarField vorticity(const std::vector<double>& velocity, std::size_t nx, std::size_t ny,
                      const std::array<double, 2>& spacing, const std::array<bool, 2>& periodic) {
  ScalarField field{nx, ny, {}};
  const auto component = [&](std::size_t k) {
    return [&, k](std::size_t x, std::size_t y) { return velocity[3 * (y * nx + x) + k]; };
  };
  const VelocityGrid grid{nx, ny, spacing, periodic};
  for (std::size_t y = 0; y < ny; ++y)
    for (std::size_t x = 0; x < nx; ++x) field.values.push_back(grid.vorticity(x, y, component(0), component(1)));
  return field;
}

ScalarField block_means(const ScalarField& field, std::size_t most) {
  BlockMeans means(field.nx, field.ny, most);
  for (std::size_t y = 0; y < field.ny; ++y)
    means.add_row([&](std::size_t x) { return field.values[y * field.nx + x]; });
  return means.means();
}

std::vector<unsigned char> decoded(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(letters.find(c));
    count += 6;
    if (count >= 8) bytes.push_back(static_cast<unsigned char>(bits >> (count -= 8) & 255));
  }
  return bytes;
}

}  // namespace

TEST_CASE("the vorticity of shear and of a parabolic channel flow is exact at every node, walls included") {
  constexpr std::size_t nx = 8, ny = 6;
  constexpr double dx = 2e-7, rate = 20;
  const auto shear = vorticity(sampled(nx, ny, [&](double, double y) { return std::pair(rate * y * dx, 0.0); }), nx, ny,
                               {dx, dx}, {true, false});
  for (const double value : shear.values) CHECK(value == Approx(-rate).epsilon(1e-12));

  // Central and one-sided differences of second order differentiate a parabola exactly.
  const auto channel = vorticity(sampled(nx, ny, [&](double, double y) { return std::pair(y * (ny - y), 0.0); }), nx,
                                 ny, {1, 1}, {true, false});
  for (std::size_t y = 0; y < ny; ++y)
    for (std::size_t x = 0; x < nx; ++x)
      CHECK(channel.values[y * nx + x] == Approx(2 * (double(y) + 0.5) - double(ny)).margin(1e-12));
}

TEST_CASE("the vorticity of a region is exact at its edges, too, where the flow does not go on periodically") {
  const auto turning = vorticity(sampled(5, 4, [](double x, double y) { return std::pair(-3 * y, 3 * x + x * x); }), 5,
                                 4, {1, 1}, {false, false});
  for (std::size_t y = 0; y < 4; ++y)
    for (std::size_t x = 0; x < 5; ++x) CHECK(turning.values[y * 5 + x] == Approx(6 + 2 * (double(x) + 0.5)));
}

TEST_CASE("the flow of a region of the domain lies where the region does") {
  const ScratchFolder folder;
  const auto path = folder.path() / "frames.h5";
  {
    hdf5::File file(path, hdf5::File::Mode::create);
    file.attribute("/", "size_m", std::vector<double>{20e-6, 10e-6});
    file.attribute("/", "periodic_y", 0L);
    file.attribute("/", "fields_first_m", std::vector<double>{5e-6, 3e-6});
    file.attribute("/", "fields_spacing_m", std::vector<double>{2e-6, 1e-6});
    for (const char* group : {"/frames", "/frames/000000", "/frames/000000/fields"}) file.make_group(group);
    const std::vector<double> velocity(3 * 3 * 4, 1e-4);
    file.write("/frames/000000/fields/velocity", {4, 3, 3}, H5T_IEEE_F32LE, H5T_NATIVE_DOUBLE, velocity.data(), "m/s");
  }
  const auto box = field_data(path, {0})["box_um"];
  const std::array<double, 4> wanted{4, 2.5, 6, 4};
  for (std::size_t i = 0; i < 4; ++i) CHECK(box[i].get<double>() == Approx(wanted[i]));
}

TEST_CASE("the flow of a file that is read some rows at a time is that of all its nodes") {
  // 20 MB of velocities, which are read in three parts; thinned to blocks of some two by two nodes.
  constexpr std::size_t nx = 900, ny = 1001;
  const bool periodic = GENERATE(true, false);
  const ScratchFolder folder;
  const auto path = folder.path() / "frames.h5";
  const auto velocity = sampled(nx, ny, [](double x, double y) {
    return std::pair(1e-4 * std::sin(0.02 * x + 0.03 * y), 1e-4 * std::cos(0.05 * x) * std::sin(0.01 * y));
  });
  {
    hdf5::File file(path, hdf5::File::Mode::create);
    file.attribute("/", "size_m", std::vector<double>{nx * 1e-6, ny * 1e-6});
    file.attribute("/", "periodic_y", periodic ? 1L : 0L);
    for (const char* group : {"/frames", "/frames/000000", "/frames/000000/fields"}) file.make_group(group);
    file.write("/frames/000000/fields/velocity", {ny, nx, 3}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, velocity.data(), "m/s",
               1);
  }
  const auto quantities = field_data(path, {0})["quantities"];
  const auto curl = vorticity(velocity, nx, ny, {1e-6, 1e-6}, {true, periodic});
  ScalarField speed{nx, ny, {}};
  for (std::size_t i = 0; i < nx * ny; ++i) speed.values.push_back(std::hypot(velocity[3 * i], velocity[3 * i + 1]));
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    CAPTURE(k, periodic);
    const auto expected = block_means(k == 0 ? speed : curl, 32768);
    CHECK(expected.ny > 100);
    const auto found = decoded(quantities[k]["values"][0]);
    CHECK(found == quantised(expected.values, quantities[k]["scale"].get<double>(), k == 1));
  }
}

TEST_CASE("fields of other nodes than the first one's are refused") {
  const ScratchFolder folder;
  const auto path = folder.path() / "frames.h5";
  {
    hdf5::File file(path, hdf5::File::Mode::create);
    file.attribute("/", "size_m", std::vector<double>{20e-6, 10e-6});
    file.attribute("/", "periodic_y", 0L);
    file.make_group("/frames");
    for (const std::string frame : {"/frames/000000", "/frames/000001"}) {
      for (const char* group : {"", "/fields"}) file.make_group(frame + group);
      const std::vector<double> velocity(3 * 8 * 4, 1e-4);
      file.write(frame + "/fields/velocity", {frame == "/frames/000000" ? hsize_t{4} : hsize_t{3}, 8, 3},
                 H5T_IEEE_F32LE, H5T_NATIVE_DOUBLE, velocity.data(), "m/s");
    }
  }
  CHECK_THROWS_WITH(field_data(path, {0, 1}), Catch::Contains("does not fit the nodes of other fields"));
}

TEST_CASE("the vorticity of a periodic wave converges with the square of the spacing") {
  const auto error = [](std::size_t n) {
    const double k = 2 * std::numbers::pi / double(n);
    const auto field =
        vorticity(sampled(n, n, [&](double x, double y) { return std::pair(std::sin(k * y), std::cos(k * x)); }), n, n,
                  {1 / double(n), 1 / double(n)}, {true, true});
    double worst = 0;
    for (std::size_t y = 0; y < n; ++y)
      for (std::size_t x = 0; x < n; ++x) {
        const double exact =
            -2 * std::numbers::pi * (std::sin(k * (double(x) + 0.5)) + std::cos(k * (double(y) + 0.5)));
        worst = std::max(worst, std::abs(field.values[y * n + x] - exact));
      }
    return worst;
  };
  // sin(h)/h - 1 = -h^2/6 + h^4/120: four times less for twice the nodes but for h^2/20 = 5e-4, and as much again
  // because the nodes lie beside the wave's crest.
  CHECK(error(64) / error(128) == Approx(4).epsilon(0.003));
}

TEST_CASE("means over blocks keep the mean of a field and hold no more values than asked") {
  ScalarField field{12, 8, {}};
  for (int i = 0; i < 96; ++i) field.values.push_back(i % 12);
  const auto same = block_means(field, 96);
  CHECK(same.values == field.values);
  const auto means = block_means(field, 24);
  CHECK(means.nx == 6);
  CHECK(means.ny == 4);
  for (std::size_t i = 0; i < means.values.size(); ++i) CHECK(means.values[i] == 2.0 * double(i % 6) + 0.5);
  const auto uneven = block_means(field, 25);  // 12 nodes in 6 blocks, 8 in 4
  CHECK(uneven.values.size() <= 25);
  CHECK(block_means({5, 1, {1, 2, 3, 4, 5}}, 1).values == std::vector<double>{3});
}

TEST_CASE("quantised values are within half a level of the truth, and what is undefined is told apart") {
  const double scale = 3e-4;
  const std::vector<double> values{0, 1e-6, 1.234e-4, 3e-4, -3e-4, -7.7e-5, std::nan(""), 5e-4};
  const auto plain = quantised(values, scale, false), with_sign = quantised(values, scale, true);
  for (const std::size_t i : {0, 1, 2, 3})
    CHECK(std::abs(scale * plain[i] / 254 - values[i]) <= 0.5 * scale / 254 * (1 + 1e-9));
  for (const std::size_t i : {0, 1, 2, 3, 4, 5})
    CHECK(std::abs(scale * (with_sign[i] - 127) / 127 - values[i]) <= 0.5 * scale / 127 * (1 + 1e-9));
  CHECK(plain[6] == 255);
  CHECK(with_sign[6] == 255);
  CHECK(plain[7] == 254);  // beyond the scale
  CHECK(quantised({0, 0}, 0, true) == std::vector<unsigned char>{127, 127});
}

TEST_CASE("a report carries the flow of the outputs that have one") {
  const ScratchFolder folder;
  const Scene scene = small_scene();
  {
    RunDirectory run(folder.path(), scene);
    for (long step = 0; step < 6; ++step) {
      Snapshot snapshot = small_snapshot(step, step % 2 == 1);
      if (step % 2 == 1) {
        std::vector<double> velocity;
        for (int i = 0; i < 32; ++i)
          velocity.insert(velocity.end(), {3e-4f * static_cast<float>(step), 4e-4f * static_cast<float>(step), 0});
        snapshot.fields.fields.front() = given_field("velocity", "m/s", 3, velocity);
      }
      run.write(snapshot);
    }
    run.finish(to_json(small_summary()));
  }
  CHECK(field_outputs(folder.path() / "frames.h5", 10) == std::vector<std::size_t>{1, 3, 5});
  CHECK(field_outputs(folder.path() / "frames.h5", 2) == std::vector<std::size_t>{1, 5});
  const auto fields = report_data(folder.path())["fields"];
  CHECK(fields["outputs"] == nlohmann::json::array({1, 3, 5}));
  CHECK(fields["derived"] == true);
  REQUIRE(fields["quantities"].size() == 2);
  const auto& speed = fields["quantities"][0];
  CHECK(speed["name"] == "speed");
  CHECK(speed["unit"] == "m/s");
  CHECK(speed["scale"].get<double>() == Approx(5 * 5e-4));
  const auto bytes = decoded(speed["values"][0]);
  REQUIRE(bytes.size() == fields["nx"].get<std::size_t>() * fields["ny"].get<std::size_t>());
  for (const unsigned char byte : bytes) CHECK(int(byte) == 51);  // a fifth of the largest: 254/5 = 50.8
  const auto& vorticities = fields["quantities"][1];
  for (const unsigned char byte : decoded(vorticities["values"][2]))
    CHECK(int(byte) == 127);  // a uniform flow has none
}
