#include "fluid_bench.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "bare_fluid.hpp"
#include "core/fluid/fluid.hpp"
#include "measure.hpp"
#include "plugin/catalog.hpp"
#include "plugin/model.hpp"

namespace rouleau::bench {

namespace {

constexpr double relaxation_rate = 1.0, magic = 0.1875;
constexpr core::WallVelocity walls{-0.01, 0.01};

core::CollisionOperator trt() {
  static const plugin::Catalog catalog({ROULEAU_PLUGINS});
  return plugin::make_collision_operator(catalog.find(plugin::ModelKind::collision, "trt", {}), {magic},
                                         plugin::ModelSetting{{1, 1, 1}, relaxation_rate, false});
}

/// The fluid of the program, with the trt plugin.
template <class T>
std::unique_ptr<core::Fluid<T>> plugin_fluid(int nx, int ny, bool forced, core::WallVelocity wall) {
  core::FluidSetting<2> setting{};
  setting.domain = {{nx, ny}, {true, false}};
  setting.relaxation_rate = relaxation_rate;
  setting.walls = wall;
  setting.membranes = forced;
  auto fluid = std::make_unique<core::Fluid<T>>(setting, trt());
  if (forced) {
    for (int y = 0; y < ny; ++y) fluid->mask().mark(y, 0, nx);
  }
  return fluid;
}

template <class T>
void start_couette(core::Fluid<T>& fluid) {
  const int ny = fluid.setting().domain.size[1];
  const double rate = (walls.upper - walls.lower) / ny;
  fluid.set_profile([=](double y) { return walls.lower + rate * (y + 0.5); }, [=](double) { return rate; });
}

template <class T>
BareFluid<T> bare_fluid(Kernel kernel, core::Fluid<T>& like) {
  const core::FluidSetting<2>& setting = like.setting();
  BareFluid<T> bare(kernel, setting.domain.size[0], setting.domain.size[1], relaxation_rate, magic, setting.walls);
  bare.set([&](int q, int x, int y) { return like.population(q, x, y); });
  return bare;
}

/// Largest difference of x velocity (without force) from the Couette profile, over the wall speed.
template <class Fluid>
double couette_error(Fluid& fluid, int nx, int ny) {
  double worst = 0;
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; x += 7) {
      double u = 0;
      for (int q = 0; q < 9; ++q) u += d2q9::velocity[q][0] * fluid.population(q, x, y);
      const double exact = walls.lower + (walls.upper - walls.lower) * (y + 0.5) / ny;
      worst = std::max(worst, std::abs(u - exact) / walls.upper);
    }
  }
  return worst;
}

void require(bool right, const std::string& what, double found) {
  if (!right)
    throw std::runtime_error("wrong result, so its speed means nothing: " + what + ", found " + std::to_string(found));
}

template <class T>
void clear(core::VectorField<T, 2>& force, rouleau::Worker worker) {
  const rouleau::Range rows = worker.share(force[0].size(1));
  for (int y = rows.begin; y < rows.end; ++y) {
    std::fill_n(force[0].row(y), force[0].size(0), T(0));
    std::fill_n(force[1].row(y), force[1].size(0), T(0));
  }
}

template <class Fluid>
Candidate candidate(const char* name, Fluid& fluid) {
  return {name, [&fluid](rouleau::Worker worker) { fluid.step(worker.share(fluid.rows().end)); },
          [&fluid](rouleau::Worker worker) {
            if (worker.first()) fluid.end_step();
            if (fluid.force()[0].allocated()) clear(fluid.force(), worker);
          }};
}

template <class T>
void fluid_row(int nx, int ny, int threads, bool forced, double seconds) {
  const auto plugin = plugin_fluid<T>(nx, ny, forced, walls);
  start_couette(*plugin);
  BareFluid<T> bare = bare_fluid(forced ? Kernel::forced : Kernel::plain, *plugin);
  BareFluid<T> move = bare_fluid(Kernel::move, *plugin);
  const auto times =
      measure({candidate("plugin", *plugin), candidate("bare", bare), candidate("move", move)}, threads, seconds);
  // Steady flow must still be what it was, up to the rounding of as many steps.
  const double allowed = std::is_same_v<T, double> ? 1e-9 : 2e-2;
  plugin->settle();
  require(couette_error(*plugin, nx, ny) < allowed, "Couette flow through the plugin", couette_error(*plugin, nx, ny));
  const double nodes = static_cast<double>(nx) * ny;
  const auto mlups = [&](const Timing& t) { return nodes / t.best_s / 1e6; };
  char size[32];
  std::snprintf(size, sizeof size, "%dx%d", nx, ny);
  std::printf("  %-10s %-3s %7d  %-7s %10.0f %10.0f %10.0f   %8.3f %8.3f   %9.2f\n", size,
              std::is_same_v<T, double> ? "f64" : "f32", threads, forced ? "force,u" : "plain", mlups(times[0]),
              mlups(times[1]), mlups(times[2]), times[1].best_s / times[0].best_s,
              times[1].median_s / times[0].median_s, static_cast<double>(plugin->bytes()) / nodes);
  std::fflush(stdout);
}

/// Decay of a shear wave between walls at rest: u = sin(2 pi (y + 1/2)/ny) exp(- nu (2 pi/ny)^2 t), exactly no slip.
template <class T>
void check_precision(const char* name) {
  const int nx = 64, ny = 32;
  const long steps = 60;
  const double wave = 2 * std::numbers::pi / ny, viscosity = (1 / relaxation_rate - 0.5) / 3;
  const auto plugin = plugin_fluid<T>(nx, ny, false, {});
  plugin->set_profile([=](double y) { return 1e-3 * std::sin(wave * (y + 0.5)); },
                      [=](double y) { return 1e-3 * wave * std::cos(wave * (y + 0.5)); });
  BareFluid<T> bare = bare_fluid(Kernel::plain, *plugin);
  for (long i = 0; i < steps; ++i) {
    plugin->step(plugin->rows());
    plugin->end_step();
    bare.step(bare.rows());
    bare.end_step();
  }
  plugin->settle();
  const double exact = std::exp(-viscosity * wave * wave * steps);
  const auto amplitude = [&](const auto& fluid) {
    double sum = 0;
    for (int y = 0; y < ny; ++y) {
      for (int q = 0; q < 9; ++q) {
        sum += 2.0 / ny * std::sin(wave * (y + 0.5)) * d2q9::velocity[q][0] * fluid.population(q, 5, y);
      }
    }
    return sum / 1e-3;
  };
  for (const double found : {amplitude(*plugin), amplitude(bare)}) {
    require(std::abs(found / exact - 1) < 5e-3, std::string("decay of a shear wave, ") + name, found / exact);
  }
  std::printf("  %s: decay of a shear wave over that of Navier-Stokes: plugin %.5f, compiled in %.5f\n", name,
              amplitude(*plugin) / exact, amplitude(bare) / exact);

  // The forced kernels against each other, and the momentum that a force gives: F for every node and step.
  const auto forced = plugin_fluid<T>(nx, ny, true, {});
  BareFluid<T> bare_forced = bare_fluid(Kernel::forced, *forced);
  double worst = 0;
  for (long i = 0; i < steps; ++i) {
    for (core::VectorField<T, 2>* field : {&forced->force(), &bare_forced.force()}) {
      for (int y = 0; y < ny; ++y) {
        for (int x = 0; x < nx; ++x) {
          (*field)[0].row(y)[x] = static_cast<T>(1e-6 * std::sin(0.3 * x + 0.2 * y));
          (*field)[1].row(y)[x] = static_cast<T>(1e-6 * std::cos(0.1 * x - 0.4 * y));
        }
      }
    }
    forced->step(forced->rows());
    forced->end_step();
    bare_forced.step(bare_forced.rows());
    bare_forced.end_step();
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        worst = std::max(worst, std::abs(static_cast<double>(forced->force()[0].row(y)[x]) -
                                         static_cast<double>(bare_forced.force()[0].row(y)[x])));
      }
    }
  }
  const double rounding = 1e-5 * std::numeric_limits<T>::epsilon() * 100;
  require(worst < rounding, std::string("velocity with a force, plugin against compiled in, ") + name, worst);
  std::printf("  %s: velocity with a force, plugin against compiled in: largest difference %.1e\n", name, worst);
}

template <class T>
void run_one(const std::string& kernel, bool force, int nx, int ny, long steps) {
  const auto plugin = plugin_fluid<T>(nx, ny, force, walls);
  start_couette(*plugin);
  const auto advance = [&](auto& fluid) {
    const Candidate all = candidate(kernel.c_str(), fluid);
    for (long i = 0; i < steps; ++i) {
      all.step({});
      all.between({});
    }
  };
  if (kernel == "plugin") return advance(*plugin);
  BareFluid<T> bare = bare_fluid(kernel == "move" ? Kernel::move : force ? Kernel::forced : Kernel::plain, *plugin);
  advance(bare);
}

}  // namespace

void check_fluid() {
  check_precision<double>("f64");
  check_precision<float>("f32");
}

void fluid_table(double seconds) {
  std::printf(
      "\nFluid alone, two-relaxation-time collision, million node updates a second (best of 9 rounds that alternate)\n"
      "  move: the same populations travel without a collision, which is what memory allows; ratio: bare over plugin "
      "time\n"
      "  %-10s %-3s %7s  %-7s %10s %10s %10s   %8s %8s   %9s\n",
      "nodes", "", "threads", "", "plugin", "compiled", "move", "ratio", "(median)", "bytes/node");
  for (const auto& [nx, ny] : {std::pair{256, 128}, std::pair{1024, 1024}, std::pair{4096, 4096}}) {
    for (const int threads : {1, 2}) {
      fluid_row<double>(nx, ny, threads, false, seconds);
      fluid_row<float>(nx, ny, threads, false, seconds);
      if (nx > 1024) continue;
      fluid_row<double>(nx, ny, threads, true, seconds);
      fluid_row<float>(nx, ny, threads, true, seconds);
    }
  }
}

void run_kernel(const char* kernel, bool f32, bool force, int nx, int ny, long steps) {
  if (f32) {
    run_one<float>(kernel, force, nx, ny, steps);
  } else {
    run_one<double>(kernel, force, nx, ny, steps);
  }
}

}  // namespace rouleau::bench
