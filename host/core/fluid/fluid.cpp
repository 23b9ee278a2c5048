#include "fluid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <rouleau/dispatch.hpp>
#include <type_traits>

#include "core/domain/exact_sum.hpp"
#include "layers.hpp"
#include "max_speed.hpp"
#include "moving_frame.hpp"

namespace rouleau::core {

namespace d2q9 = rouleau::d2q9;

template <class T>
Fluid<T>::Fluid(const FluidSetting& setting, CollisionOperator collision, const Ranks<2>& ranks)
    : setting_(setting),
      ranks_(ranks),
      collision_(std::move(collision)),
      lattice_(setting.domain),
      last_walls_(setting.walls),
      mask_(setting.domain) {
  if constexpr (std::is_same_v<T, double>) {
    collide_ = collision_.table->collide_f64;
  } else {
    collide_ = collision_.table->collide_f32;
  }
  if (setting.membranes) force_ = {Field<T, 2>({nx(), ny()}), Field<T, 2>({nx(), ny()})};
  const bool layered = !setting.viscosity_of_rows.empty();
  if (setting.viscosity_contrast || layered) {
    relaxation_rate_ = Field<T, 2>({nx(), ny()});
    relaxation_rate_.fill(static_cast<T>(setting.relaxation_rate));
  }
  for (int y = 0; layered && y < ny(); ++y) {
    const double ratio = setting.viscosity_of_rows.at(setting.domain.block.begin[1] + y);
    rate_of_row_.push_back(rate_of_layer(setting.relaxation_rate, ratio));
    std::fill_n(relaxation_rate_.row(y), nx(), static_cast<T>(rate_of_row_.back()));
  }
  if (setting.body_force_x != 0 || setting.body_force_y != 0) {
    body_force_row_[0].assign(static_cast<std::size_t>(nx()), static_cast<T>(setting.body_force_x));
    body_force_row_[1].assign(static_cast<std::size_t>(nx()), static_cast<T>(setting.body_force_y));
  }
  if (ranks.several()) make_halos();
}

namespace {

/// Populations of halo nodes that cross the border of a block: of a node outside, those whose velocity points out of the
/// block wherever the node lies outside, and whose origin the block holds. An even step sends them out, and what an odd
/// step has put there goes home.
std::vector<HaloCopy<2>> population_copies(const Domain<2>& domain) {
  std::vector<HaloCopy<2>> copies;
  for_halo_nodes(domain, 1, 1, [&](const std::array<int, 2>& node, const std::array<int, 2>& out) {
    for (int q = 1; q < 9; ++q) {
      const int cx = d2q9::velocity[q][0], cy = d2q9::velocity[q][1];
      const bool leaves = (out[0] == 0 || cx == out[0]) && (out[1] == 0 || cy == out[1]);
      if (leaves && domain.block.contains({node[0] - cx, node[1] - cy})) copies.push_back({node, q});
    }
  });
  return copies;
}

/// Both components of the velocity, one node deep on the lower sides.
std::vector<HaloCopy<2>> velocity_copies(const Domain<2>& domain, int above) {
  std::vector<HaloCopy<2>> copies;
  for_halo_nodes(domain, 1, above, [&](const std::array<int, 2>& node, const std::array<int, 2>&) {
    for (int component = 0; component < 2; ++component) copies.push_back({node, component});
  });
  return copies;
}

}  // namespace

template <class T>
void Fluid<T>::make_halos() {
  const std::array<int, 2> begin = setting_.domain.block.begin;
  population_halo_ =
      std::make_unique<Halo<T, 2>>(ranks_, population_copies, [this, begin](const std::array<int, 2>& node) {
        return lattice_.offset(node[0] - begin[0], {node[1] - begin[1]});
      });
  energetics_halo_ = std::make_unique<Halo<double, 2>>(
      ranks_, [](const Domain<2>& domain) { return velocity_copies(domain, 1); },
      [this, begin](const std::array<int, 2>& node) -> std::ptrdiff_t {
        return static_cast<std::ptrdiff_t>(nx() + 2) * (node[1] - begin[1]) + node[0] - begin[0];
      });
  if (!setting_.membranes) return;
  // What the stencils of nodes above the block's own reach.
  velocity_halo_ = std::make_unique<Halo<T, 2>>(
      ranks_, [](const Domain<2>& domain) { return velocity_copies(domain, 2); },
      [this, begin](const std::array<int, 2>& node) {
        return force_[0].row(node[1] - begin[1]) + (node[0] - begin[0]) - force_[0].row(0);
      });
}

/// Calls function(halo, way, arrays) for what goes across the border after a step.
template <class T>
template <class Function>
void Fluid<T>::with_arrays(Function function) {
  if (!population_halo_) return;
  T* slots[9];
  for (int q = 0; q < 9; ++q) slots[q] = lattice_.slot(q, {0});
  function(*population_halo_, parity_ == Parity::odd ? Way::out : Way::home, slots);
  T* velocity[2] = {force_[0].row(0), force_[1].row(0)};
  if (velocity_halo_) function(*velocity_halo_, Way::out, velocity);
}

template <class T>
void Fluid<T>::begin_halo() {
  with_arrays([](Halo<T, 2>& halo, Way way, auto& arrays) { halo.begin(way, arrays); });
}

template <class T>
void Fluid<T>::end_halo() {
  with_arrays([](Halo<T, 2>& halo, Way way, auto& arrays) { halo.end(way, arrays); });
  if (velocity_halo_) mirror_velocity(force_, setting_.domain, setting_.walls);
}

template <class T>
std::size_t Fluid<T>::bytes() const {
  return lattice_.bytes() + force_[0].bytes() + force_[1].bytes() + relaxation_rate_.bytes();
}

template <class T>
inline bool Fluid<T>::reaches_border(int y) const {
  constexpr int width = Field<T, 2>::halo;
  return mask_.at_side(y) || ((y < width || y >= ny() - width) && mask_.any(y));
}

template <class T>
void Fluid<T>::set_drive(const WallVelocity& walls, double body_force_x) {
  setting_.walls = walls;
  if (body_force_x == setting_.body_force_x) return;
  setting_.body_force_x = body_force_x;
  body_force_row_[0].assign(static_cast<std::size_t>(nx()), static_cast<T>(body_force_x));
  body_force_row_[1].assign(static_cast<std::size_t>(nx()), static_cast<T>(setting_.body_force_y));
}

template <class T>
void Fluid<T>::clear_force(Range rows) {
  const auto set = [](T* row, const MaskSpan& span, T value) {
    if (value == T(0)) {
      std::memset(row + span.begin, 0, sizeof(T) * static_cast<std::size_t>(span.end - span.begin));
    } else {
      std::fill(row + span.begin, row + span.end, value);
    }
  };
  const T body_force_x = static_cast<T>(setting_.body_force_x), body_force_y = static_cast<T>(setting_.body_force_y);
  for (int y = rows.begin; y < rows.end; ++y) {
    mask_.for_spans(y, [&](const MaskSpan& span) {
      if (!span.active) return;
      set(force_[0].row(y), span, body_force_x);
      set(force_[1].row(y), span, body_force_y);
    });
  }
}

template <class T>
void Fluid<T>::collide_row(int y, const T* (&in)[9], T* (&out)[9]) {
  const void* const self = collision_.self.get();
  const T* body_force[2] = {body_force_row_[0].data(), body_force_row_[1].data()};
  const T* const* const background = body_force_row_[0].empty() ? nullptr : body_force;
  const T* force[2];
  T* velocity[2];
  Block block{};
  block.struct_size = sizeof(Block);
  block.in = in;
  block.out = out;
  const bool layer = in_layer(y);
  int at = 0;  // where the pointers stand
  const auto move_to = [&](int x) {
    if (x == at) return;
    d2q9::for_each_velocity([&](auto q) { in[q] += x - at, out[q] += x - at; });
    at = x;
  };
  mask_.for_spans(y, [&](const MaskSpan& span) {
    move_to(span.begin);
    block.count = static_cast<std::uint32_t>(span.end - span.begin);
    if (span.active && setting_.membranes) {
      force[0] = velocity[0] = force_[0].row(y) + span.begin;
      force[1] = velocity[1] = force_[1].row(y) + span.begin;
      block.force = force;
      block.velocity = velocity;
      block.relaxation_rate = setting_.viscosity_contrast || layer ? relaxation_rate_.row(y) + span.begin : nullptr;
    } else {
      block.force = background;
      block.velocity = nullptr;
      block.relaxation_rate = layer ? relaxation_rate_.row(y) + span.begin : nullptr;
    }
    call_foreign(collision_.id, "collide", [&] { collide_(self, &block); });
  });
  move_to(0);
}

template <class T>
void Fluid<T>::add_moving_frame(int y, T* (&out)[9]) {
  static const auto function = Dispatch<AddMovingFrame, const MovingFrameTask<T>*>::pick();
  const auto of = [](const double(&values)[2], T(&to)[2]) {
    for (int k = 0; k < 2; ++k) to[k] = static_cast<T>(values[k]);
  };
  MovingFrameTask<T> task{};
  task.rate = static_cast<T>(rate_of_row(y));
  of({setting_.body_force_x, setting_.body_force_y}, task.body_force);
  of(frame_, task.frame);
  mask_.for_spans(y, [&](const MaskSpan& span) {
    const bool active = span.active && setting_.membranes;
    d2q9::for_each_velocity([&](auto q) { task.out[q] = out[q] + span.begin; });
    for (int k = 0; k < 2; ++k) task.velocity[k] = active ? force_[k].row(y) + span.begin : nullptr;
    task.relaxation_rate = active && setting_.viscosity_contrast ? relaxation_rate_.row(y) + span.begin : nullptr;
    task.count = span.end - span.begin;
    function(&task);
  });
}

template <class T>
void Fluid<T>::step(Range rows) {
  const bool even = parity_ == Parity::even;
  const T* in[9];
  T* out[9];
  const int first = even ? rows.begin : rows.end - 1, way = even ? 1 : -1;
  for (int i = 0; i < rows.end - rows.begin; ++i) {
    const int y = first + way * i;
    if (i == 0) {
      lattice_.row_pointers(parity_, {y}, in, out);
    } else {
      lattice_.next_row_pointers(parity_, {y - way}, {y}, in, out);
    }
    if (even) receive_row(lattice_, y);
    collide_row(y, in, out);
    if (frame_[0] != 0 || frame_[1] != 0) add_moving_frame(y, out);
    add_wall_momentum(lattice_, y, setting_.walls);
    if (even) send_row(lattice_, y);
    if (setting_.membranes && reaches_border(y)) {
      fill_velocity_halo(force_, y, setting_.domain, setting_.walls);
    }
  }
}

template <class T>
void Fluid<T>::settle() {
  if (parity_ != Parity::even) return;
  for (int y = 0; y < ny(); ++y) receive_row(lattice_, y);
}

template <class T>
double Fluid<T>::population(int q, int x, int y) const {
  const T* in[9];
  lattice_.row_pointers(parity_, {y}, in);
  return static_cast<double>(in[q][x]);
}

template <class T>
void Fluid<T>::moments(int y, std::vector<Moments>& row) const {
  const T* in[9];
  lattice_.row_pointers(parity_, {y}, in);
  row.assign(static_cast<std::size_t>(nx()), Moments{});
  mask_.for_spans(y, [&](const MaskSpan& span) {
    for (int x = span.begin; x < span.end; ++x) {
      Moments& m = row[x];
      for (int q = 0; q < 9; ++q) {
        const double f = static_cast<double>(in[q][x]);
        m.density += f;
        m.ux += d2q9::velocity[q][0] * f;
        m.uy += d2q9::velocity[q][1] * f;
      }
      const bool own_force = span.active && setting_.membranes;
      m.ux += 0.5 * (own_force ? static_cast<double>(force_[0].row(y)[x]) : setting_.body_force_x);
      m.uy += 0.5 * (own_force ? static_cast<double>(force_[1].row(y)[x]) : setting_.body_force_y);
    }
  });
}

template <class T>
std::vector<Moments> Fluid<T>::all_moments() const {
  std::vector<Moments> block, row;
  block.reserve(static_cast<std::size_t>(nx()) * ny());
  for (int y = 0; y < ny(); ++y) {
    moments(y, row);
    block.insert(block.end(), row.begin(), row.end());
  }
  return gather(ranks_, std::move(block));
}

template <class T>
std::vector<double> Fluid<T>::all_relaxation_rates() {
  std::vector<double> block;
  for (int y = 0; y < ny(); ++y) {
    mask_.for_spans(y, [&](const MaskSpan& span) {
      if (span.active && setting_.viscosity_contrast) {
        block.insert(block.end(), relaxation_rate_.row(y) + span.begin, relaxation_rate_.row(y) + span.end);
      } else {
        block.insert(block.end(), static_cast<std::size_t>(span.end - span.begin), rate_of_row(y));
      }
    });
  }
  return gather(ranks_, std::move(block));
}

template <class T>
std::vector<double> Fluid<T>::row_velocities() const {
  std::vector<ExactSum> sums(static_cast<std::size_t>(setting_.domain.size[1]));
  std::vector<Moments> row;
  for (int y = 0; y < ny(); ++y) {
    moments(y, row);
    for (const Moments& m : row) sums[setting_.domain.block.begin[1] + y].add(m.ux);
  }
  add_up(ranks_, sums);
  std::vector<double> means(sums.size());
  for (std::size_t y = 0; y < means.size(); ++y) means[y] = sums[y].value() / setting_.domain.size[0];
  return means;
}

template <class T>
std::vector<double> Fluid<T>::row_velocities_without_membranes() const {
  std::vector<ExactSum> sums(static_cast<std::size_t>(setting_.domain.size[1]));
  std::vector<double> momentum(static_cast<std::size_t>(nx()));
  for (int y = 0; y < ny(); ++y) {
    const T* in[9];
    lattice_.row_pointers(parity_, {y}, in);
    std::fill(momentum.begin(), momentum.end(), 0.0);
    d2q9::for_each_velocity([&](auto q) {
      constexpr int along = d2q9::velocity[q][0];
      if constexpr (along != 0) {
        for (int x = 0; x < nx(); ++x) momentum[x] += along * static_cast<double>(in[q][x]);
      }
    });
    ExactSum& sum = sums[setting_.domain.block.begin[1] + y];
    for (const double j : momentum) sum.add(j);
  }
  add_up(ranks_, sums);
  std::vector<double> means(sums.size());
  for (std::size_t y = 0; y < means.size(); ++y)
    means[y] = sums[y].value() / setting_.domain.size[0] + setting_.body_force_x / 2;
  return means;
}

template <class T>
double Fluid<T>::mass() const {
  return mass_and_speed().mass;
}

template <class T>
typename Fluid<T>::MassAndSpeed Fluid<T>::mass_and_speed() const {
  static const auto function = Dispatch<FindMassAndSpeed, MassAndSpeedTask<T>*>::pick();
  struct Part {
    ExactSum mass;
    double speed_square = 0, zero = 0;
  };
  Part own, all;
  for (int y = 0; y < ny(); ++y) {
    const T* in[9];
    lattice_.row_pointers(parity_, {y}, in);
    mask_.for_spans(y, [&](const MaskSpan& span) {
      MassAndSpeedTask<T> task{};
      d2q9::for_each_velocity([&](auto q) { task.in[q] = in[q] + span.begin; });
      if (span.active && setting_.membranes) {
        task.force[0] = force_[0].row(y) + span.begin;
        task.force[1] = force_[1].row(y) + span.begin;
      }
      task.body_force[0] = static_cast<T>(setting_.body_force_x);
      task.body_force[1] = static_cast<T>(setting_.body_force_y);
      task.count = span.end - span.begin;
      function(&task);
      own.mass.add_parts(task.mass[0], task.mass[1]);
      own.speed_square = std::max(own.speed_square, task.speed_square);
      own.zero += task.zero;
    });
  }
  for (const std::vector<Part>& part : all_of(ranks_, std::vector<Part>{own})) {
    all.mass.add(part.front().mass);
    all.speed_square = std::max(all.speed_square, part.front().speed_square);
    all.zero += part.front().zero;
  }
  return {all.mass.value() + all.zero, std::sqrt(all.speed_square) + all.zero};
}

template <class T>
typename Fluid<T>::WallStress Fluid<T>::wall_stress() const {
  if (!walls_have_acted_) return {std::nan(""), std::nan("")};
  // A population that leaves towards the wall and returns gives the wall c_q f_q - c_-q f_-q = c_q (f_q + f_-q); the
  // one that left is the one that came back plus the wall's own momentum: f_q = f_-q + 6 w_q c_q . u_wall.
  std::vector<ExactSum> sums(2);
  const auto add = [&](ExactSum& sum, int y, int outward, double speed) {
    const T* in[9];
    lattice_.row_pointers(parity_, {y}, in);
    for (int q = 1; q < 9; ++q) {
      const int cx = d2q9::velocity[q][0];
      if (d2q9::velocity[q][1] != outward || cx == 0) continue;
      const T* returned = in[d2q9::opposite[q]];
      const double moved = 6 * d2q9::weight[q] * cx * speed;
      for (int x = 0; x < nx(); ++x) sum.add(cx * (2 * static_cast<double>(returned[x]) + moved));
    }
  };
  if (setting_.domain.wall_below(1)) add(sums[0], 0, -1, last_walls_.lower);
  if (setting_.domain.wall_above(1)) add(sums[1], ny() - 1, +1, last_walls_.upper);
  add_up(ranks_, sums);
  return {sums[0].value() / setting_.domain.size[0], sums[1].value() / setting_.domain.size[0]};
}

template <class T>
double Fluid<T>::equilibrium(int q, double density, double ux, double uy) const {
  const auto along = [q](double x, double y) { return d2q9::velocity[q][0] * x + d2q9::velocity[q][1] * y; };
  const auto quadratic = [&](double x, double y) { return 4.5 * along(x, y) * along(x, y) - 1.5 * (x * x + y * y); };
  double terms = 0;
  if (setting_.inertia) {
    terms = quadratic(ux, uy);
  } else if (frame_[0] != 0 || frame_[1] != 0) {
    terms = quadratic(ux, uy) - quadratic(ux - frame_[0], uy - frame_[1]);
  }
  return d2q9::weight[q] * (density + 3 * along(ux, uy) + terms);
}

template <class T>
void Fluid<T>::set_state(const std::function<State(int, int)>& state) {
  parity_ = Parity::even;
  walls_have_acted_ = true;  // a state that is given is one that goes with these walls
  for (int y = 0; y < ny(); ++y) {
    const double tau = 1 / rate_of_row(y);
    for (int x = 0; x < nx(); ++x) {
      const State s = state(setting_.domain.block.begin[0] + x, setting_.domain.block.begin[1] + y);
      // Populations hold the momentum without the half force that the velocity includes.
      const double jx = s.ux - 0.5 * setting_.body_force_x, jy = s.uy - 0.5 * setting_.body_force_y;
      for (int q = 0; q < 9; ++q) {
        const double cx = d2q9::velocity[q][0], cy = d2q9::velocity[q][1];
        const double strain = cx * cx * s.gradient[0] + cx * cy * (s.gradient[1] + s.gradient[2]) +
                              cy * cy * s.gradient[3] - (s.gradient[0] + s.gradient[3]) / 3;
        lattice_.slot(q, {y})[x] =
            static_cast<T>(equilibrium(q, s.density, jx, jy) - 3 * tau * d2q9::weight[q] * strain);
      }
    }
  }
  fill_population_halo(lattice_);
}

template <class T>
void Fluid<T>::set_profile(const std::function<double(double)>& velocity,
                           const std::function<double(double)>& shear_rate) {
  set_state([&](int, int y) { return State{0, velocity(y), 0, {0, shear_rate(y), 0, 0}}; });
}

template <class T>
void Fluid<T>::take_over(Fluid& other, double factor) {
  other.settle();
  parity_ = Parity::even;
  for (int y = 0; y < ny(); ++y) {
    const T* in[9];
    other.lattice_.row_pointers(other.parity_, {y}, in);
    for (int x = 0; x < nx(); ++x) {
      double density = 0, jx = 0, jy = 0;
      for (int q = 0; q < 9; ++q) {
        const double f = static_cast<double>(in[q][x]);
        density += f;
        jx += d2q9::velocity[q][0] * f;
        jy += d2q9::velocity[q][1] * f;
      }
      for (int q = 0; q < 9; ++q) {
        const double rest = static_cast<double>(in[q][x]) - other.equilibrium(q, density, jx, jy);
        lattice_.slot(q, {y})[x] =
            static_cast<T>(equilibrium(q, factor * density, factor * jx, factor * jy) + factor * rest);
      }
    }
  }
  fill_population_halo(lattice_);
}

template <class T>
void Fluid<T>::copy_populations(int q, std::vector<T>& values) const {
  values.clear();
  for (int y = 0; y < ny(); ++y) {
    const T* in[9];
    lattice_.row_pointers(parity_, {y}, in);
    values.insert(values.end(), in[q], in[q] + nx());
  }
}

template <class T>
void Fluid<T>::restore(const std::function<std::vector<T>(int)>& populations, bool walls_have_acted) {
  parity_ = Parity::even;
  walls_have_acted_ = walls_have_acted;
  last_walls_ = setting_.walls;
  for (int q = 0; q < 9; ++q) {
    const std::vector<T> values = populations(q);
    const T* from = values.data();
    for (int y = 0; y < ny(); ++y, from += nx()) std::copy_n(from, nx(), lattice_.slot(q, {y}));
  }
  fill_population_halo(lattice_);
}

template class Fluid<float>;
template class Fluid<double>;

}  // namespace rouleau::core
