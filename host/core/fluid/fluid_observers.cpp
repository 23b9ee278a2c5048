#include "fluid_observers.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <rouleau/collision.hpp>
#include <rouleau/dispatch.hpp>

#include "core/domain/exact_sum.hpp"
#include "energetics.hpp"
#include "openings/section.hpp"
#include "walls.hpp"

namespace rouleau::core {

namespace {

/// Nodes of one span of a row, and what was found.
template <class T, class Set>
struct MassAndSpeedTask {
  const T* in[Set::velocity_count];
  const T* force[Set::dimension];  // per node, or null
  T body_force[Set::dimension];
  int count;
  double mass[2];  // parts of an exact sum of the densities (ExactSum)
  double speed_square, zero;
};

/// Sum of the densities, largest speed; `zero` becomes NaN with the first value that is not finite.
template <class T, class Set>
struct FindMassAndSpeed {
  using Task = MassAndSpeedTask<T, Set>;
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(Task* task) {
    constexpr int width = register_bytes / sizeof(T);
    const Task t = *task;
    const int whole = t.count / width * width;
    sweep<Pack<T, width>>(t, 0, whole, *task);
    sweep<Pack<T, 1>>(t, whole, t.count, *task);
  }

 private:
  template <class S>
  ROULEAU_ALWAYS_INLINE static void sweep(const Task& t, int begin, int end, Task& result) {
    using Wide = typename Pack<double, S::size>::Vector;
    Wide mass_high{}, mass_low{};
    S fastest = 0, zero = 0;
    for (int x = begin; x < end; x += S::size) {
      Node<Set, S, true, false> node;
      Set::for_each_velocity([&](auto q) { node.f[q] = S::load(t.in[q] + x); });
      for (int k = 0; k < Set::dimension; ++k)
        node.force[k] = t.force[k] != nullptr ? S::load(t.force[k] + x) : S(t.body_force[k]);
      node.compute_moments();
      const S square = node.dot(node.velocity, node.velocity);
      const Wide density = __builtin_convertvector(node.density.vector, Wide);
      const Wide part = ExactSum::high_part(density);
      mass_high += part;
      mass_low += ExactSum::low_part(Wide(density - part));
      fastest = max(fastest, square);
      zero += (square - square) + (node.density - node.density);
    }
    for (int k = 0; k < S::size; ++k) {
      result.mass[0] += mass_high[k];
      result.mass[1] += mass_low[k];
      result.speed_square = std::max(result.speed_square, static_cast<double>(fastest.vector[k]));
      result.zero += static_cast<double>(zero.vector[k]);
    }
  }
};

/// Of the rows that have been added, and of all ranks' rows.
template <class T, class Set>
class MassAndSpeed {
 public:
  void add(const FluidState<T, Set>& state, int i);
  void add_up(const Ranks<Set::dimension>& ranks);
  [[nodiscard]] double mass() const { return sum_.mass.value() + sum_.zero; }
  [[nodiscard]] double speed() const { return std::sqrt(sum_.speed_square) + sum_.zero; }

 private:
  struct Part {
    ExactSum mass;
    double speed_square = 0, zero = 0;
  };
  Part sum_;
};

template <class T, class Set>
void MassAndSpeed<T, Set>::add(const FluidState<T, Set>& state, int i) {
  using Task = MassAndSpeedTask<T, Set>;
  static const auto function = Dispatch<FindMassAndSpeed<T, Set>, Task*>::pick();
  const auto row = state.lattice.row(i);
  state.for_spans(i, [&](const MaskSpan& span, const auto& in) {
    Task task{};
    Set::for_each_velocity([&](auto q) { task.in[q] = in[q] + span.begin; });
    for (int k = 0; k < Set::dimension; ++k) {
      if (state.has_force(span)) task.force[k] = state.force[k].row(row) + span.begin;
      task.body_force[k] = static_cast<T>(state.setting.body_force[k]);
    }
    task.count = span.end - span.begin;
    function(&task);
    sum_.mass.add_parts(task.mass[0], task.mass[1]);
    sum_.speed_square = std::max(sum_.speed_square, task.speed_square);
    sum_.zero += task.zero;
  });
}

template <class T, class Set>
void MassAndSpeed<T, Set>::add_up(const Ranks<Set::dimension>& ranks) {
  Part all;
  for (const std::vector<Part>& part : all_of(ranks, std::vector<Part>{sum_})) {
    all.mass.add(part.front().mass);
    all.speed_square = std::max(all.speed_square, part.front().speed_square);
    all.zero += part.front().zero;
  }
  sum_ = all;
}

/// The number of a row of the block among the lattice's.
template <int D>
std::size_t row_in_lattice(const Domain<D>& domain, const std::array<int, D - 1>& row) {
  std::size_t number = 0;
  for (int k = D - 1; k > 0; --k)
    number = number * static_cast<std::size_t>(domain.size[k]) +
             static_cast<std::size_t>(domain.block.begin[k] + row[k - 1]);
  return number;
}

/// Sums of each row of the lattice.
template <int D>
class RowSums {
 public:
  explicit RowSums(const Domain<D>& domain)
      : domain_(domain), sums_(static_cast<std::size_t>(domain.nodes() / domain.size[0])) {}
  /// Of a row of the block.
  [[nodiscard]] ExactSum& operator[](const std::array<int, D - 1>& row) { return sums_[row_in_lattice(domain_, row)]; }
  /// Of all ranks together: over the nodes of a row.
  [[nodiscard]] std::vector<double> means(const Ranks<D>& ranks) {
    add_up(ranks, sums_);
    std::vector<double> means;
    means.reserve(sums_.size());
    for (const ExactSum& sum : sums_) means.push_back(sum.value() / domain_.size[0]);
    return means;
  }

 private:
  const Domain<D>& domain_;
  std::vector<ExactSum> sums_;
};

/// Calls function(x, moments) for the fluid nodes of a row from `begin` to `end`.
template <class T, class Set, class Function>
void for_moments(const FluidState<T, Set>& state, int i, int begin, int end, Function function) {
  const auto row = state.lattice.row(i);
  state.for_spans(i, [&](const MaskSpan& span, const auto& in) {
    for (int x = std::max(begin, span.begin); x < std::min(end, span.end); ++x) {
      Moments<Set::dimension> m{};
      Set::for_each_velocity([&](auto q) {
        const double f = static_cast<double>(in[q][x]);
        m.density += f;
        for (int k = 0; k < Set::dimension; ++k)
          if (Set::velocity[q][k] != 0) m.velocity[k] += Set::velocity[q][k] * f;
      });
      const bool own_force = state.has_force(span);
      for (int k = 0; k < Set::dimension; ++k)
        m.velocity[k] +=
            0.5 * (own_force ? static_cast<double>(state.force[k].row(row)[x]) : state.setting.body_force[k]);
      function(x, m);
    }
  });
}

}  // namespace

template <class T, class Set>
void copy_moments(const FluidState<T, Set>& state, int i, Moments<Set::dimension>* to) {
  std::fill_n(to, state.nx(), Moments<Set::dimension>{});
  for_moments(state, i, 0, state.nx(), [&](int x, const Moments<Set::dimension>& m) { to[x] = m; });
}

template <class T, class Set>
void copy_relaxation_rates(const FluidState<T, Set>& state, int i, double* to) {
  const auto row = state.lattice.row(i);
  std::fill_n(to, state.nx(), state.rate_of_row(row));
  state.mask.for_spans(i, [&](const MaskSpan& span) {
    if (!span.active || !state.setting.viscosity_contrast) return;
    const T* const rates = state.relaxation_rate.row(row);
    std::copy(rates + span.begin, rates + span.end, to + span.begin);
  });
}

// What populations hold of the flux of momentum beyond their equilibrium is all viscous: -(1 - rate/2) of it is the
// stress, whatever operator relaxes it at that rate.
template <class T, class Set>
void copy_stresses(const FluidState<T, Set>& state, int i, Stress<Set::dimension>* to) {
  constexpr int dimension = Set::dimension;
  const auto nx = static_cast<std::size_t>(state.nx());
  std::vector<Moments<dimension>> moments(nx);
  std::vector<double> rates(nx);
  copy_moments(state, i, moments.data());
  copy_relaxation_rates(state, i, rates.data());
  std::fill_n(to, nx, Stress<dimension>{});
  state.for_fluid(i, [&](int begin, int end, const auto& in) {
    for (int x = begin; x < end; ++x) {
      const Moments<dimension>& node = moments[static_cast<std::size_t>(x)];
      const auto& u = node.velocity;
      auto stress = to[x].begin();
      for (int k = 0; k < dimension; ++k) {
        for (int l = k; l < dimension; ++l) {
          double flux = k == l ? -node.density / 3 : 0;
          Set::for_each_velocity(
              [&](auto q) { flux += Set::velocity[q][k] * Set::velocity[q][l] * static_cast<double>(in[q][x]); });
          flux -= u[k] * u[l];
          if (!state.setting.inertia) flux += (u[k] - state.frame[k]) * (u[l] - state.frame[l]);
          *stress++ = -(1 - rates[static_cast<std::size_t>(x)] / 2) * flux;
        }
      }
    }
  });
}

template <class T, class Set>
void copy_population(const FluidState<T, Set>& state, int q, int i, double* to) {
  state.for_fluid(i, [&](int begin, int end, const auto& in) { std::copy(in[q] + begin, in[q] + end, to + begin); });
  state.mask.for_solid(i, [&](int begin, int end) { std::fill(to + begin, to + end, 0.0); });
}

template <class T, class Set>
FluidMeasures<Set::dimension> measure(const FluidState<T, Set>& state, const Ranks<Set::dimension>& ranks,
                                      const FluidHalo<T, Set>* halo, const WallVelocity& walls, WantedMeasures wanted) {
  MassAndSpeed<T, Set> fluid;
  std::optional<EnergySum<T, Set>> energy;  // which finds velocities
  if (wanted.energetics || wanted.row_velocities) energy.emplace(state, halo, walls);
  std::optional<RowSums<Set::dimension>> rows;
  if (wanted.row_velocities) rows.emplace(state.setting.domain);
  for (int i = 0; i < state.lattice.rows(); ++i) {
    fluid.add(state, i);
    if (energy) energy->add(i);
    if (rows) (*rows)[state.lattice.row(i)].add(energy->velocity_along_flow(), static_cast<std::size_t>(state.nx()));
  }
  fluid.add_up(ranks);
  FluidMeasures<Set::dimension> found{
      .mass = fluid.mass(), .speed = fluid.speed(), .energetics = {}, .row_velocities = {}};
  if (energy) found.energetics = energy->total(ranks);
  if (rows) found.row_velocities = rows->means(ranks);
  return found;
}

template <class T, class Set>
std::vector<double> row_velocities_without_membranes(const FluidState<T, Set>& state,
                                                     const Ranks<Set::dimension>& ranks) {
  const double of_force = state.setting.body_force[0] / 2;
  std::vector<double> momentum(static_cast<std::size_t>(state.nx()));
  RowSums<Set::dimension> sums(state.setting.domain);
  for (int i = 0; i < state.lattice.rows(); ++i) {
    std::fill(momentum.begin(), momentum.end(), 0.0);
    ExactSum& sum = sums[state.lattice.row(i)];
    state.for_fluid(i, [&](int begin, int end, const auto& in) {
      Set::for_each_velocity([&](auto q) {
        constexpr int along = Set::velocity[q][0];
        if constexpr (along != 0)
          for (int x = begin; x < end; ++x) momentum[x] += along * static_cast<double>(in[q][x]);
      });
      for (int x = begin; x < end; ++x) sum.add(momentum[x] + (state.links ? of_force : 0));
    });
  }
  std::vector<double> means = sums.means(ranks);
  for (double& mean : means) mean += state.links ? 0 : of_force;
  return means;
}

template <class T, class Set>
std::array<EndFlow, 2> end_flows(const FluidState<T, Set>& state, const Ranks<Set::dimension>& ranks) {
  const Domain<Set::dimension>& domain = state.setting.domain;
  const SectionNodes<Set::dimension> nodes(domain);
  const int axis = nodes.axis();
  std::array<EndFlow, 2> flows;
  for (const int end : {0, 1}) {
    const std::vector<int>& parts = state.parts_of_ends[end];
    const auto count = static_cast<std::size_t>(1 + *std::max_element(parts.begin(), parts.end()));
    std::vector<ExactSum> sums(3 + count);  // velocities, densities, nodes; velocities in each part
    const int place = end == 0 ? 0 : domain.block.size(axis) - 1;
    const bool mine = end == 0 ? domain.wall_below(axis) : domain.wall_above(axis);
    for (int i = 0; mine && i < state.lattice.rows(); ++i) {
      const auto row = state.lattice.row(i);
      if (axis > 0 && row[std::max(axis - 1, 0)] != place) continue;
      std::array<int, Set::dimension> at = domain.block.begin;
      for (int k = 1; k < Set::dimension; ++k) at[k] += row[k - 1];
      const int first = axis == 0 ? place : 0, last = axis == 0 ? place + 1 : state.nx();
      for_moments(state, i, first, last, [&](int x, const Moments<Set::dimension>& node) {
        const double values[] = {node.velocity[axis], node.density, 1};
        for (std::size_t k = 0; k < std::size(values); ++k) sums[k].add(values[k]);
        at[0] = domain.block.begin[0] + x;
        sums[3 + static_cast<std::size_t>(parts[nodes.number(at)])].add(node.velocity[axis]);
      });
    }
    add_up(ranks, sums);
    flows[end] = {.flow = sums[0].value(), .pressure = sums[1].value() / sums[2].value() / 3};
    for (std::size_t k = 3; k < sums.size(); ++k) flows[end].of_parts.push_back(sums[k].value());
  }
  return flows;
}

template <class T, class Set>
std::array<std::vector<double>, 2> passed(const FluidState<T, Set>& state, const Ranks<Set::dimension>& ranks) {
  constexpr int dimension = Set::dimension;
  const SectionNodes<dimension> nodes(state.setting.domain);
  std::array<std::vector<double>, 2> all;
  for (const int end : {0, 1}) {
    const std::vector<int>& parts = state.parts_of_ends[end];
    std::vector<ExactSum> sums(static_cast<std::size_t>(1 + *std::max_element(parts.begin(), parts.end())));
    for (int i = 0; i < state.lattice.rows(); ++i) {
      for (const auto& link : state.openings->of_row(i)) {
        if ((Set::velocity[link.q][nodes.axis()] > 0) != (end == 0)) continue;
        std::array<int, dimension> at = state.setting.domain.block.begin;
        at[0] += link.x;
        for (int k = 1; k < dimension; ++k) at[k] += state.lattice.row(i)[k - 1];
        sums[static_cast<std::size_t>(parts[nodes.number(at)])].add(link.passed);
      }
    }
    add_up(ranks, sums);
    for (const ExactSum& sum : sums) all[end].push_back(sum.value());
  }
  return all;
}

template <class T, class Set>
WallForces<Set::dimension> wall_forces(const FluidState<T, Set>& state, const Ranks<Set::dimension>& ranks,
                                       const WallVelocity& walls) {
  using Sums = WallForceSums<Set::dimension>;
  Sums sums;
  const Domain<Set::dimension>& domain = state.setting.domain;
  const int open = domain.flow_axis();
  // A population that leaves towards the wall and returns gives the wall c_q f_q - c_-q f_-q = c_q (f_q + f_-q); the
  // one that left is the one that came back plus the wall's own momentum: f_q = f_-q + 6 w_q c_q . u_wall.
  for (int i = 0; i < state.lattice.rows(); ++i) {
    const auto row = state.lattice.row(i);
    const auto beyond = [&](int axis, int c) {
      const int place = row[axis - 1] + c;
      return domain.walled(axis) &&
             ((place < 0 && domain.wall_below(axis)) || (place >= state.lattice.size(axis) && domain.wall_above(axis)));
    };
    const auto wall_of = [&](const auto& c) {
      return !beyond(1, c[1]) ? Sums::other : c[1] < 0 ? Sums::lower : Sums::upper;
    };
    // Along the open axis, what pressure gives to a wall by a link in direction q that crosses an opening, too: that is
    // the opening's. Elsewhere such links come in pairs, and their pressures cancel.
    const auto of_opening = [&](const auto& in, int q, int x) {
      const int place = (open == 0 ? x : row[std::max(open - 1, 0)]) + Set::velocity[q][open];
      if (!(place < 0 && domain.wall_below(open)) && !(place >= state.lattice.size(open) && domain.wall_above(open)))
        return 0.0;
      double density = 0;
      for (const T* const population : in) density += static_cast<double>(population[x]);
      return 2 * Set::weight[q] * density;
    };
    // What a plane in direction q gets, times `sign`.
    const auto add_plane = [&](const auto& in, int q, int x, double sign) {
      const auto& c = Set::velocity[q];
      const typename Sums::Wall wall = wall_of(c);
      const double speed = wall == Sums::other ? 0 : wall == Sums::lower ? walls.lower : walls.upper;
      const double force = 2 * static_cast<double>(in[Set::opposite[q]][x]) + 6 * Set::weight[q] * c[0] * speed;
      for (int k = 0; k < Set::dimension; ++k)
        if (c[k] != 0) sums.add(wall, k, sign * c[k] * (k == open ? force - of_opening(in, q, x) : force));
    };
    for (int q = 1; q < Set::velocity_count; ++q) {
      const auto& c = Set::velocity[q];
      if (!beyond(1, c[1]) && !(Set::dimension == 3 && beyond(Set::dimension - 1, c[Set::dimension - 1]))) continue;
      state.for_fluid(i, [&](int begin, int end, const auto& in) {
        for (int x = begin; x < end; ++x) add_plane(in, q, x, 1);
      });
    }
    state.for_links(i, [&](std::size_t piece, const auto& at) {
      for (const auto& link : state.links->of_piece(piece)) {
        const auto q = link.q;
        const int x = link.x;
        if (link.plane) add_plane(at.in, link.w, x, -1);  // a wall before it takes all
        const double both = static_cast<double>(link.left) + static_cast<double>(at.in[q][x]);
        for (int k = 0; k < Set::dimension; ++k)
          if (Set::velocity[q][k] != 0)
            sums.add(Sums::other, k, -Set::velocity[q][k] * (both - (k == open ? of_opening(at.in, link.w, x) : 0)));
      }
    });
  }
  return sums.total(ranks);
}

#define ROULEAU_INSTANTIATE(T, Set, D)                                                                       \
  template void copy_moments(const FluidState<T, Set>&, int, Moments<D>*);                                   \
  template void copy_relaxation_rates(const FluidState<T, Set>&, int, double*);                              \
  template void copy_stresses(const FluidState<T, Set>&, int, Stress<D>*);                                   \
  template void copy_population(const FluidState<T, Set>&, int, int, double*);                               \
  template FluidMeasures<D> measure(const FluidState<T, Set>&, const Ranks<D>&, const FluidHalo<T, Set>*,    \
                                    const WallVelocity&, WantedMeasures);                                    \
  template std::vector<double> row_velocities_without_membranes(const FluidState<T, Set>&, const Ranks<D>&); \
  template std::array<EndFlow, 2> end_flows(const FluidState<T, Set>&, const Ranks<D>&);                     \
  template std::array<std::vector<double>, 2> passed(const FluidState<T, Set>&, const Ranks<D>&);            \
  template WallForces<D> wall_forces(const FluidState<T, Set>&, const Ranks<D>&, const WallVelocity&);
ROULEAU_INSTANTIATE(float, D2Q9, 2)
ROULEAU_INSTANTIATE(double, D2Q9, 2)
ROULEAU_INSTANTIATE(float, D3Q19, 3)
ROULEAU_INSTANTIATE(double, D3Q19, 3)
#undef ROULEAU_INSTANTIATE

}  // namespace rouleau::core
