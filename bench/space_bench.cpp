#include "space_bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <rouleau/dispatch.hpp>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "core/fluid/fluid.hpp"
#include "core/fluid/periodic.hpp"
#include "measure.hpp"
#include "plugin/catalog.hpp"
#include "plugin/model.hpp"

namespace rouleau::bench {

namespace space {

using core::D3Q19;

constexpr double relaxation_rate = 1.0, magic = 0.1875;

core::CollisionOperator trt() {
  static const plugin::Catalog catalog({ROULEAU_PLUGINS});
  return plugin::make_collision_operator(catalog.find(plugin::ModelKind::collision, "trt", {}), {magic},
                                         plugin::ModelSetting{{1, 1, 1}, relaxation_rate, false, 3});
}

template <class T>
struct RowTask {
  const T* in[19];
  T* out[19];
  T* force[3];
  int count;  // a multiple of the widest register
  T relaxation_rate, magic;
};

/// Two relaxation times, Stokes flow, as somebody would write it who needs nothing else; with a force its velocity is
/// written over it, its halo included.
template <bool forced, class T>
struct Row {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const RowTask<T>* task) {
    using S = Pack<T, register_bytes / sizeof(T)>;
    const RowTask<T> t = *task;
    const T omega = t.relaxation_rate;
    const T omega_odd = 2 * (2 - omega) / (4 * t.magic * omega + (2 - omega));
    const S keep_rest = 1 - omega, keep_even = T(0.5) - T(0.5) * omega, keep_odd = T(0.5) - T(0.5) * omega_odd;
    for (int x = 0; x < t.count; x += S::size) {
      S f[19], j[3], gain[3];
      D3Q19::for_each_velocity([&](auto q) { f[q] = S::load(t.in[q] + x); });
      S density = f[0];
      for (S& component : j) component = S(0);
      D3Q19::for_each_pair([&](auto q) {
        const S sum = f[q] + f[D3Q19::opposite[q]], difference = f[q] - f[D3Q19::opposite[q]];
        density += sum;
        for (int k = 0; k < 3; ++k) {
          if (D3Q19::velocity[q][k] > 0) j[k] += difference;
          if (D3Q19::velocity[q][k] < 0) j[k] -= difference;
        }
      });
      for (int k = 0; k < 3; ++k) {
        gain[k] = omega_odd * j[k];
        if constexpr (forced) {
          // With a linear equilibrium the half force in the velocity and in Guo's factor cancel.
          const S force = S::load(t.force[k] + x);
          gain[k] += force;
          (j[k] + T(0.5) * force).store(t.force[k] + x);
        }
      }
      const S even_axis = omega * T(1.0 / 18) * density, even_diagonal = omega * T(1.0 / 36) * density;
      (keep_rest * f[0] + omega * T(1.0 / 3) * density).store(t.out[0] + x);
      D3Q19::for_each_pair([&](auto q) {
        constexpr auto& c = D3Q19::velocity[q];
        constexpr int back = D3Q19::opposite[q];
        constexpr bool axis = c[0] * c[0] + c[1] * c[1] + c[2] * c[2] == 1;
        S along = S(0);
        bool first = true;
        for (int k = 0; k < 3; ++k) {
          if (c[k] == 0) continue;
          along = first ? (c[k] > 0 ? gain[k] : -gain[k]) : (c[k] > 0 ? along + gain[k] : along - gain[k]);
          first = false;
        }
        const S even = keep_even * (f[q] + f[back]) + (axis ? even_axis : even_diagonal);
        const S odd = keep_odd * (f[q] - f[back]) + T(axis ? 3.0 / 18 : 3.0 / 36) * along;
        (even + odd).store(t.out[q] + x);
        (even - odd).store(t.out[back] + x);
      });
    }
  }
};

/// The same in-place lattice, periodic, with that loop in place of a plugin.
template <class T>
class BareSpace {
 public:
  /// `ahead`: asks for the next row while it computes one, as Fluid does.
  BareSpace(bool forced, int n, bool ahead = true)
      : lattice_({{n, n, n}, {true, true, true}}), fetches_(ahead && lattice_.fetches_ahead()) {
    task_.count = n;
    task_.relaxation_rate = T(relaxation_rate), task_.magic = T(magic);
    row_ =
        forced ? Dispatch<Row<true, T>, const RowTask<T>*>::pick() : Dispatch<Row<false, T>, const RowTask<T>*>::pick();
    for (int k = 0; k < 3 && forced; ++k) force_[k] = core::Field<T, 3>({n, n, n});
  }
  void set(core::Fluid<T, D3Q19>& like) {
    for (int i = 0; i < lattice_.rows(); ++i) {
      const auto row = lattice_.row(i);
      for (int q = 0; q < 19; ++q) {
        for (int x = 0; x < lattice_.size(0); ++x)
          lattice_.slot(q, row)[x] = static_cast<T>(like.population(q, x, row));
      }
      send_row(lattice_, row);
    }
  }
  /// Between an even number of steps.
  [[nodiscard]] double population(int q, int x, const std::array<int, 2>& row) {
    receive_row(lattice_, row);
    return static_cast<double>(lattice_.slot(q, row)[x]);
  }
  [[nodiscard]] core::VectorField<T, 3>& force() { return force_; }
  [[nodiscard]] Range rows() const { return {0, lattice_.rows()}; }
  void step(Range rows) {
    const bool even = parity_ == core::Parity::even;
    typename core::Lattice<T, D3Q19>::Row last{};
    for (int k = 0; k < rows.end - rows.begin; ++k) {
      const auto row = lattice_.row(even ? rows.begin + k : rows.end - 1 - k);
      if (k == 0) {
        lattice_.row_pointers(parity_, row, 0, task_.in, task_.out);
      } else {
        lattice_.next_row_pointers(parity_, last, row, task_.in, task_.out);
      }
      last = row;
      if (even) receive_row(lattice_, row);
      if (fetches_ && k + 1 < rows.end - rows.begin) {
        const auto next = lattice_.row(even ? rows.begin + k + 1 : rows.end - 2 - k);
        lattice_.fetch_row(task_.in, row, next);
        for (int c = 0; c < 3 && force_[0].allocated(); ++c) core::fetch(force_[c].row(next), lattice_.size(0));
      }
      for (int c = 0; c < 3 && force_[0].allocated(); ++c) task_.force[c] = force_[c].row(row);
      row_(&task_);
      if (even) send_row(lattice_, row);
      if (force_[0].allocated()) core::fill_velocity_halo<T, 3>(force_, row, lattice_.domain(), {});
    }
  }
  void end_step() { parity_ = core::next(parity_); }

 private:
  core::Lattice<T, D3Q19> lattice_;
  bool fetches_;
  core::VectorField<T, 3> force_;
  core::Parity parity_ = core::Parity::even;
  RowTask<T> task_{};
  void (*row_)(const RowTask<T>*) = nullptr;
};

/// The fluid of the program, with the trt plugin.
template <class T>
std::unique_ptr<core::Fluid<T, D3Q19>> plugin_space(bool forced, int n) {
  core::FluidSetting<3> setting{.domain = {{n, n, n}, {true, true, true}}, .relaxation_rate = relaxation_rate};
  setting.membranes = forced;
  auto fluid = std::make_unique<core::Fluid<T, D3Q19>>(setting, trt());
  for (int i = 0; i < fluid->rows().end && forced; ++i) fluid->mask().mark(i, 0, n);
  const double k = 2 * 3.14159265358979 / n;
  fluid->set_state([&](int x, int y, int z) {
    return typename core::Fluid<T, D3Q19>::State{
        0, {1e-3 * std::sin(k * y), 1e-3 * std::sin(k * z), 1e-3 * std::sin(k * x)}, {}};
  });
  return fluid;
}

template <class Fluid>
void push(Fluid& fluid, Worker worker) {
  if (!fluid.force()[0].allocated()) return;
  const int n = fluid.force()[0].size(1);
  const Range rows = worker.share(n * n);
  for (int i = rows.begin; i < rows.end; ++i) {
    for (auto& component : fluid.force()) std::fill_n(component.row(i % n, i / n), n, 0);
  }
}

template <class Fluid>
Candidate candidate(const char* name, Fluid& fluid) {
  return {name, [&fluid](Worker worker) { fluid.step(worker.share(fluid.rows().end)); },
          [&fluid](Worker worker) {
            if (worker.first()) fluid.end_step();
            push(fluid, worker);
          }};
}

template <class T>
void table_row(int n, bool forced, double seconds) {
  const auto plugin = plugin_space<T>(forced, n);
  BareSpace<T> bare(forced, n), no_fetch(forced, n, false);
  bare.set(*plugin), no_fetch.set(*plugin);
  const auto times =
      measure({candidate("plugin", *plugin), candidate("bare", bare), candidate("no fetch", no_fetch)}, 1, seconds);
  const double nodes = static_cast<double>(n) * n * n;
  const auto mlups = [&](const Timing& t) { return nodes / t.best_s / 1e6; };
  std::printf("  %3d^3       %-3s  %-7s %10.0f %10.0f %10.0f   %8.3f %8.3f %8.3f   %9.2f\n", n,
              std::is_same_v<T, double> ? "f64" : "f32", forced ? "force,u" : "plain", mlups(times[0]), mlups(times[1]),
              mlups(times[2]), times[1].best_s / times[0].best_s, times[1].median_s / times[0].median_s,
              times[2].best_s / times[0].best_s, static_cast<double>(plugin->bytes()) / nodes);
  std::fflush(stdout);
}

template <class T>
void run_one(const std::string& kernel, bool force, int n, long steps) {
  const auto advance = [&](auto& fluid) {
    const Candidate all = candidate(kernel.c_str(), fluid);
    for (long i = 0; i < steps; ++i) {
      all.step({});
      all.between({});
    }
  };
  const auto plugin = plugin_space<T>(force, n);
  if (kernel == "plugin") return advance(*plugin);
  BareSpace<T> bare(force, n);
  bare.set(*plugin);
  advance(bare);
}

/// The populations of both after some steps, an even number, and with a force the velocities.
template <class T>
void check_kernels(const char* name) {
  constexpr int n = 16, steps = 22;
  double worst = 0;
  for (const bool forced : {false, true}) {
    const auto plugin = plugin_space<T>(forced, n);
    BareSpace<T> bare(forced, n);
    bare.set(*plugin);
    const auto step = [&](auto& fluid, int number) {
      for (int i = 0; i < n * n && forced; ++i) {
        for (int k = 0; k < 3; ++k) {
          for (int x = 0; x < n; ++x)
            fluid.force()[k].row(i % n, i / n)[x] = static_cast<T>(1e-6 * std::sin(0.3 * x + 0.2 * i + k + number));
        }
      }
      fluid.step(fluid.rows());
      fluid.end_step();
    };
    for (int number = 0; number < steps; ++number) {
      step(*plugin, number);
      step(bare, number);
    }
    plugin->settle();
    for (int i = 0; i < n * n; ++i) {
      for (int x = 0; x < n; ++x) {
        for (int q = 0; q < 19; ++q)
          worst = std::max(worst,
                           std::abs(plugin->population(q, x, {i % n, i / n}) - bare.population(q, x, {i % n, i / n})));
        for (int k = 0; k < 3 && forced; ++k)
          worst = std::max(worst, std::abs(static_cast<double>(plugin->force()[k].row(i % n, i / n)[x]) -
                                           static_cast<double>(bare.force()[k].row(i % n, i / n)[x])));
      }
    }
  }
  if (!(worst < 1e-3 * std::numeric_limits<T>::epsilon() * steps))
    throw std::runtime_error(std::string("wrong result in three dimensions, ") + name + ": " + std::to_string(worst));
  std::printf("  %s, three dimensions: plugin against compiled in: largest difference %.1e\n", name, worst);
}

}  // namespace space

void check_space() {
  space::check_kernels<double>("f64");
  space::check_kernels<float>("f32");
}

void run_space_kernel(const std::string& kernel, bool f32, bool force, int n, long steps) {
  if (kernel != "plugin" && kernel != "plain") throw std::invalid_argument("in a cube there are plugin and plain");
  if (f32) {
    space::run_one<float>(kernel, force, n, steps);
  } else {
    space::run_one<double>(kernel, force, n, steps);
  }
}

double space_speed(double seconds) {
  constexpr int n = 64;
  const auto like = space::plugin_space<float>(false, n);
  space::BareSpace<float> bare(false, n);
  bare.set(*like);
  return n * n * n / measure({space::candidate("bare", bare)}, 1, seconds)[0].median_s / 1e6;
}

void space_table(double seconds) {
  std::printf(
      "\nFluid alone in three dimensions (D3Q19), periodic, one thread, million node updates a second (best of 9 "
      "rounds that alternate).\nCompiled in: with the next row asked for, as the program does, and without (no fetch)\n"
      "  %-10s %-4s %-7s %10s %10s %10s   %8s %8s %8s   %9s\n",
      "nodes", "", "", "plugin", "compiled", "no fetch", "ratio", "(median)", "to that", "bytes/node");
  for (const int n : {32, 64, 128}) {
    for (const bool forced : {false, true}) {
      space::table_row<double>(n, forced, seconds);
      space::table_row<float>(n, forced, seconds);
    }
  }
}

}  // namespace rouleau::bench
