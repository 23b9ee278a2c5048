#include "fluid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <rouleau/dispatch.hpp>
#include <stdexcept>
#include <type_traits>

#include "core/domain/exact_sum.hpp"
#include "layers.hpp"
#include "max_speed.hpp"
#include "moving_frame.hpp"

namespace rouleau::core {

template <class T, class Set>
Fluid<T, Set>::Fluid(const FluidSetting<dimension>& setting, CollisionOperator collision, const Ranks<dimension>& ranks)
    : Any(setting, ranks),
      collision_(std::move(collision)),
      lattice_(setting.domain),
      mask_(setting.domain, setting.solid.get()) {
  if constexpr (std::is_same_v<T, double>) {
    collide_ = collision_.table->collide_f64;
  } else {
    collide_ = collision_.table->collide_f32;
  }
  std::array<int, dimension> size{};
  for (int k = 0; k < dimension; ++k) size[k] = setting.domain.block.size(k);
  if (setting.membranes) {
    for (auto& component : force_) component = Field<T, dimension>(size);
  }
  const bool layered = !setting.viscosity_of_rows.empty();
  if (setting.viscosity_contrast || layered) {
    relaxation_rate_ = Field<T, dimension>(size);
    relaxation_rate_.fill(static_cast<T>(setting.relaxation_rate));
  }
  for (int y = 0; layered && y < size[1]; ++y) {
    const double ratio = setting.viscosity_of_rows.at(setting.domain.block.begin[1] + y);
    rate_of_row_.push_back(rate_of_layer(setting.relaxation_rate, ratio));
  }
  for (int i = 0; layered && i < lattice_.rows(); ++i) {
    const Row row = lattice_.row(i);
    std::fill_n(relaxation_rate_.row(row), nx(), static_cast<T>(rate_of_row(row)));
  }
  if (driven()) fill_body_force_rows();
  if (setting.solid) links_ = std::make_unique<SolidLinks<T, Set>>(lattice_, *setting.solid);
  if (ranks.several()) make_halos();
}

namespace {

/// Populations of halo nodes that cross the border of a block: of a node outside, those whose velocity points out of the
/// block wherever the node lies outside, and whose origin the block holds. An even step sends them out, and what an odd
/// step has put there goes home. Nothing crosses between solid nodes and others.
template <class Set>
std::vector<HaloCopy<Set::dimension>> population_copies(const Domain<Set::dimension>& domain,
                                                        const SolidNodes<Set::dimension>* solid) {
  using Node = std::array<int, Set::dimension>;
  std::vector<HaloCopy<Set::dimension>> copies;
  for_halo_nodes(domain, 1, 1, [&](const Node& node, const Node& out) {
    for (int q = 1; q < Set::velocity_count; ++q) {
      bool leaves = true;
      Node origin = node;
      for (int k = 0; k < Set::dimension; ++k) {
        const int c = Set::velocity[q][k];
        leaves = leaves && (out[k] == 0 || c == out[k]);
        origin[k] -= c;
      }
      if (solid != nullptr && (solid->at(domain, node) || solid->at(domain, origin))) continue;
      if (leaves && domain.block.contains(origin)) copies.push_back({node, q});
    }
  });
  return copies;
}

/// All components of the velocity, so many nodes deep.
template <int D>
std::vector<HaloCopy<D>> velocity_copies(const Domain<D>& domain, int below, int above) {
  std::vector<HaloCopy<D>> copies;
  for_halo_nodes(domain, below, above, [&](const std::array<int, D>& node, const std::array<int, D>&) {
    for (int component = 0; component < D; ++component) copies.push_back({node, component});
  });
  return copies;
}

}  // namespace

template <class T, class Set>
void Fluid<T, Set>::make_halos() {
  using Node = std::array<int, dimension>;
  const Box<dimension> block = setting_.domain.block;
  const auto row_of_node = [block](const Node& node) {
    Row row;
    for (int k = 1; k < dimension; ++k) row[k - 1] = node[k] - block.begin[k];
    return row;
  };
  const auto early = [this](const Node& node) { return in_end_rows(node[dimension - 1]); };
  population_halo_ = std::make_unique<Halo<T, dimension>>(
      ranks_, [this](const Domain<dimension>& domain) { return population_copies<Set>(domain, setting_.solid.get()); },
      [this, block, row_of_node](const Node& node) {
        return lattice_.offset(node[0] - block.begin[0], row_of_node(node));
      },
      early);
  edge_nodes_ = std::make_unique<const EdgeNodes<dimension>>(block);
  energetics_halo_ = std::make_unique<Halo<double, dimension>>(
      ranks_, [](const Domain<dimension>& domain) { return velocity_copies(domain, 1, 1); },
      [this, block, row_of_node](const Node& node) {
        return edge_nodes_->place(node[0] - block.begin[0], row_of_node(node));
      });
  if (!setting_.membranes) return;
  // What the stencils of nodes above the block's own reach.
  velocity_halo_ = std::make_unique<Halo<T, dimension>>(
      ranks_,
      [above = setting_.stencil_above](const Domain<dimension>& domain) {
        return velocity_copies(domain, above - 1, above);
      },
      [this, block, row_of_node](const Node& node) {
        return force_[0].row(row_of_node(node)) + (node[0] - block.begin[0]) - force_[0].row(Row{});
      },
      early);
}

template <class T, class Set>
EndRows Fluid<T, Set>::end_rows() const {
  if (!ranks_.several()) return {};
  const Domain<dimension>& domain = setting_.domain;
  constexpr int axis = dimension - 1;
  const int layers = domain.block.size(axis), rows = lattice_.rows() / layers;  // of a layer
  const bool others = !domain.wraps(axis);
  // Others keep what they read of the layers of a block: its lowest two and its highest.
  const int below = others && !domain.wall_below(axis) ? std::min(2, layers) : 0;
  const int above = others && !domain.wall_above(axis) ? std::min(1, layers - below) : 0;
  return {below * rows, above * rows};
}

/// Whether the rows of a layer of nodes, in or around the block, are taken first.
template <class T, class Set>
bool Fluid<T, Set>::in_end_rows(int layer) const {
  constexpr int axis = dimension - 1;
  const Box<dimension>& block = setting_.domain.block;
  const EndRows ends = end_rows();
  const int rows = lattice_.rows() / block.size(axis), above = block.end[axis] - ends.above / rows;
  return layer < block.begin[axis] + ends.below / rows || layer >= above;
}

/// Calls function(halo, way, arrays) for what goes across the border after a step of this parity.
template <class T, class Set>
template <class Function>
void Fluid<T, Set>::with_arrays(Parity parity, Function function) {
  if (!population_halo_) return;
  T* slots[velocity_count];
  for (int q = 0; q < velocity_count; ++q) slots[q] = lattice_.slot(q, Row{});
  function(*population_halo_, parity == Parity::even ? Way::out : Way::home, slots);
  if (!velocity_halo_) return;
  T* velocity[dimension];
  for (int k = 0; k < dimension; ++k) velocity[k] = force_[k].row(Row{});
  function(*velocity_halo_, Way::out, velocity);
}

template <class T, class Set>
void Fluid<T, Set>::send_halo(Parity parity, bool early) {
  with_arrays(parity, [this, early](Halo<T, dimension>& halo, Way way, auto& arrays) {
    halo.begin(way, arrays, [this, early](std::size_t rank) {
      return early == (ends_sent_ && population_halo_->early(rank) && (!velocity_halo_ || velocity_halo_->early(rank)));
    });
  });
}

template <class T, class Set>
void Fluid<T, Set>::begin_halo_of_ends() {
  ends_sent_ = true;
  send_halo(parity_, true);
}

template <class T, class Set>
void Fluid<T, Set>::begin_halo() {
  send_halo(next(parity_), false);
  ends_sent_ = false;
}

template <class T, class Set>
void Fluid<T, Set>::end_halo() {
  with_arrays(next(parity_), [](Halo<T, dimension>& halo, Way way, auto& arrays) { halo.end(way, arrays); });
  if (velocity_halo_) mirror_velocity<T, dimension>(force_, setting_.domain, setting_.walls);
}

template <class T, class Set>
std::size_t Fluid<T, Set>::bytes() const {
  std::size_t sum = lattice_.bytes() + relaxation_rate_.bytes();
  for (const auto& component : force_) sum += component.bytes();
  return sum;
}

template <class T, class Set>
inline bool Fluid<T, Set>::reaches_border(int i, const Row& row) const {
  constexpr int width = Field<T, dimension>::halo;
  if (links_) return mask_.marked(i);  // spans do not tell of solid nodes
  bool near = false;
  for (int k = 1; k < dimension; ++k) near = near || row[k - 1] < width || row[k - 1] >= lattice_.size(k) - width;
  return mask_.at_side(i) || (near && mask_.any(i));
}

template <class T, class Set>
void Fluid<T, Set>::fill_body_force_rows() {
  for (int k = 0; k < dimension; ++k)
    body_force_row_[k].assign(static_cast<std::size_t>(nx()), static_cast<T>(setting_.body_force[k]));
}

template <class T, class Set>
void Fluid<T, Set>::set_drive(const WallVelocity& walls, double body_force_x) {
  setting_.walls = walls;
  if (body_force_x == setting_.body_force[0]) return;
  setting_.body_force[0] = body_force_x;
  fill_body_force_rows();
}

template <class T, class Set>
void Fluid<T, Set>::clear_force(Range rows) {
  const auto set = [](T* row, const MaskSpan& span, T value) {
    if (value == T(0)) {
      std::memset(row + span.begin, 0, sizeof(T) * static_cast<std::size_t>(span.end - span.begin));
    } else {
      std::fill(row + span.begin, row + span.end, value);
    }
  };
  for (int i = rows.begin; i < rows.end; ++i) {
    const Row row = lattice_.row(i);
    mask_.for_spans(i, [&](const MaskSpan& span) {
      if (!span.active) return;
      for (int k = 0; k < dimension; ++k) set(force_[k].row(row), span, static_cast<T>(setting_.body_force[k]));
    });
  }
}

template <class T, class Set>
void Fluid<T, Set>::collide_row(int i, const Row& row, Call& call) {
  const bool layer = in_layer(row);
  int at = 0;  // where the pointers stand
  const auto move_to = [&](int x) {
    if (x == at) return;
    Set::for_each_velocity([&](auto q) { call.in[q] += x - at, call.out[q] += x - at; });
    at = x;
  };
  Block& block = call.block;
  mask_.for_spans(i, [&](const MaskSpan& span) {
    move_to(span.begin);
    block.count = static_cast<std::uint32_t>(span.end - span.begin);
    const bool active = span.active && setting_.membranes;
    if (active) {
      for (int k = 0; k < dimension; ++k) call.force[k] = force_[k].row(row) + span.begin;
    }
    block.force = active ? call.force : call.background;
    block.velocity = active ? call.force : nullptr;
    block.relaxation_rate =
        layer || (active && setting_.viscosity_contrast) ? relaxation_rate_.row(row) + span.begin : nullptr;
    call_foreign(collision_.id, "collide", [&] { collide_(collision_.self.get(), &block); });
  });
  move_to(0);
}

template <class T, class Set>
void Fluid<T, Set>::fetch_row(int i, const Call& call, const Row& from) const {
  const Row row = lattice_.row(i);
  lattice_.fetch_row(call.in, from, row);
  if (!setting_.membranes || !mask_.any(i)) return;
  for (const auto& component : force_) fetch(component.row(row), nx());
}

template <class T, class Set>
void Fluid<T, Set>::rest_solid(int i, const Row& row) {
  if (!setting_.membranes || !mask_.marked(i)) return;
  mask_.for_solid(i, [&](int begin, int end) {
    for (auto& component : force_) std::fill(component.row(row) + begin, component.row(row) + end, T(0));
  });
}

template <class T, class Set>
void Fluid<T, Set>::add_moving_frame(int i, const Row& row, T* (&out)[velocity_count]) {
  if constexpr (dimension == 2) {
    static const auto function = Dispatch<AddMovingFrame, const MovingFrameTask<T>*>::pick();
    const auto of = [](const std::array<double, 2>& values, T(&to)[2]) {
      for (int k = 0; k < 2; ++k) to[k] = static_cast<T>(values[k]);
    };
    MovingFrameTask<T> task{};
    task.rate = static_cast<T>(rate_of_row(row));
    of(setting_.body_force, task.body_force);
    of(frame_, task.frame);
    mask_.for_spans(i, [&](const MaskSpan& span) {
      const bool active = span.active && setting_.membranes;
      Set::for_each_velocity([&](auto q) { task.out[q] = out[q] + span.begin; });
      for (int k = 0; k < 2; ++k) task.velocity[k] = active ? force_[k].row(row) + span.begin : nullptr;
      task.relaxation_rate = active && setting_.viscosity_contrast ? relaxation_rate_.row(row) + span.begin : nullptr;
      task.count = span.end - span.begin;
      function(&task);
    });
  }
}

template <class T, class Set>
void Fluid<T, Set>::step(Range rows) {
  const bool even = parity_ == Parity::even;
  const bool frame_moves = frame_ != std::array<double, dimension>{};
  Call call;
  call.block = {};
  call.block.struct_size = sizeof(Block);
  call.block.in = call.in, call.block.out = call.out;
  for (int k = 0; k < dimension; ++k) call.body_force[k] = body_force_row_[k].data();
  call.background = body_force_row_[0].empty() ? nullptr : call.body_force;
  Row last{};
  const bool fetches = lattice_.fetches_ahead();
  const int count = rows.end - rows.begin, first = even ? rows.begin : rows.end - 1, way = even ? 1 : -1;
  for (int k = 0; k < count; ++k) {
    const int i = first + way * k;
    const Row row = lattice_.row(i);
    if (k == 0) {
      lattice_.row_pointers(parity_, row, call.in, call.out);
    } else {
      lattice_.next_row_pointers(parity_, last, row, call.in, call.out);
    }
    last = row;
    if (even) receive_row(lattice_, row);
    if (links_) links_->before_step(parity_, i);
    if (fetches && k + 1 < count) fetch_row(i + way, call, row);
    collide_row(i, row, call);
    if (links_) links_->after_step(parity_, i), rest_solid(i, row);
    if (frame_moves) add_moving_frame(i, row, call.out);
    add_wall_momentum(lattice_, row, setting_.walls);
    if (even) send_row(lattice_, row);
    if (setting_.membranes && reaches_border(i, row)) {
      fill_velocity_halo<T, dimension>(force_, row, setting_.domain, setting_.walls);
    }
  }
}

template <class T, class Set>
void Fluid<T, Set>::settle() {
  for (int i = 0; parity_ == Parity::even && i < lattice_.rows(); ++i) receive_row(lattice_, lattice_.row(i));
  for (int i = 0; links_ && i < lattice_.rows(); ++i) links_->before_step(parity_, i);
}

template <class T, class Set>
double Fluid<T, Set>::population(int q, int x, const Row& row) const {
  const T* in[velocity_count];
  lattice_.row_pointers(parity_, row, in);
  return static_cast<double>(in[q][x]);
}

template <class T, class Set>
void Fluid<T, Set>::moments(int i, std::vector<NodeMoments>& values) const {
  values.resize(static_cast<std::size_t>(nx()));
  copy_moments(i, values.data());
}

template <class T, class Set>
void Fluid<T, Set>::copy_moments(int i, NodeMoments* to) const {
  const T* in[velocity_count];
  const Row row = lattice_.row(i);
  lattice_.row_pointers(parity_, row, in);
  std::fill_n(to, nx(), NodeMoments{});
  mask_.for_spans(i, [&](const MaskSpan& span) {
    for (int x = span.begin; x < span.end; ++x) {
      NodeMoments& m = to[x];
      for (int q = 0; q < velocity_count; ++q) {
        const double f = static_cast<double>(in[q][x]);
        m.density += f;
        for (int k = 0; k < dimension; ++k) m.velocity[k] += Set::velocity[q][k] * f;
      }
      const bool own_force = span.active && setting_.membranes;
      for (int k = 0; k < dimension; ++k)
        m.velocity[k] += 0.5 * (own_force ? static_cast<double>(force_[k].row(row)[x]) : setting_.body_force[k]);
    }
  });
}

template <class T, class Set>
void Fluid<T, Set>::copy_relaxation_rates(int i, double* to) const {
  const Row row = lattice_.row(i);
  std::fill_n(to, nx(), rate_of_row(row));
  mask_.for_spans(i, [&](const MaskSpan& span) {
    if (!span.active || !setting_.viscosity_contrast) return;
    const T* const rates = relaxation_rate_.row(row);
    std::copy(rates + span.begin, rates + span.end, to + span.begin);
  });
}

template <class T, class Set>
void Fluid<T, Set>::copy_population(int q, int i, double* to) const {
  const T* in[velocity_count];
  lattice_.row_pointers(parity_, lattice_.row(i), in);
  std::copy_n(in[q], nx(), to);
  mask_.for_solid(i, [&](int begin, int end) { std::fill(to + begin, to + end, 0.0); });
}

template <class T, class Set>
void Fluid<T, Set>::gather_moments(const Bands<dimension>& bands, const Take<NodeMoments>& take) const {
  gather_bands<NodeMoments>(
      ranks_, setting_.domain, bands, [&](int i, NodeMoments* to) { copy_moments(i, to); }, take);
}

template <class T, class Set>
void Fluid<T, Set>::gather_relaxation_rates(const Bands<dimension>& bands, const Take<double>& take) const {
  gather_bands<double>(
      ranks_, setting_.domain, bands, [&](int i, double* to) { copy_relaxation_rates(i, to); }, take);
}

template <class T, class Set>
void Fluid<T, Set>::gather_populations(int q, const Bands<dimension>& bands, const Take<double>& take) const {
  gather_bands<double>(
      ranks_, setting_.domain, bands, [&](int i, double* to) { copy_population(q, i, to); }, take);
}

template <class T, class Set>
template <class Function>
std::vector<double> Fluid<T, Set>::means_of_rows(Function add) const {
  const Domain<dimension>& domain = setting_.domain;
  std::vector<ExactSum> sums(static_cast<std::size_t>(domain.nodes() / domain.size[0]));
  for (int i = 0; i < lattice_.rows(); ++i) {
    const Row row = lattice_.row(i);
    std::size_t of_lattice = 0;
    for (int k = dimension - 1; k > 0; --k)
      of_lattice = of_lattice * static_cast<std::size_t>(domain.size[k]) +
                   static_cast<std::size_t>(domain.block.begin[k] + row[k - 1]);
    add(i, sums[of_lattice]);
  }
  add_up(ranks_, sums);
  std::vector<double> means;
  means.reserve(sums.size());
  for (const ExactSum& sum : sums) means.push_back(sum.value() / domain.size[0]);
  return means;
}

template <class T, class Set>
std::vector<double> Fluid<T, Set>::row_velocities() const {
  std::vector<NodeMoments> row;
  return means_of_rows([&](int i, ExactSum& sum) {
    moments(i, row);
    for (const NodeMoments& m : row) sum.add(m.velocity[0]);
  });
}

template <class T, class Set>
std::vector<double> Fluid<T, Set>::row_velocities_without_membranes() const {
  std::vector<double> momentum(static_cast<std::size_t>(nx()));
  std::vector<double> means = means_of_rows([&](int i, ExactSum& sum) {
    const T* in[velocity_count];
    lattice_.row_pointers(parity_, lattice_.row(i), in);
    std::fill(momentum.begin(), momentum.end(), 0.0);
    Set::for_each_velocity([&](auto q) {
      constexpr int along = Set::velocity[q][0];
      if constexpr (along != 0) {
        for (int x = 0; x < nx(); ++x) momentum[x] += along * static_cast<double>(in[q][x]);
      }
    });
    mask_.for_fluid(i, [&](int begin, int end) {
      for (int x = begin; x < end; ++x) sum.add(momentum[x] + (links_ ? setting_.body_force[0] / 2 : 0));
    });
  });
  for (double& mean : means) mean += links_ ? 0 : setting_.body_force[0] / 2;
  return means;
}

template <class T, class Set>
typename Fluid<T, Set>::MassAndSpeed Fluid<T, Set>::mass_and_speed() const {
  using Task = MassAndSpeedTask<T, Set>;
  static const auto function = Dispatch<FindMassAndSpeed<T, Set>, Task*>::pick();
  struct Part {
    ExactSum mass;
    double speed_square = 0, zero = 0;
  };
  Part own, all;
  for (int i = 0; i < lattice_.rows(); ++i) {
    const T* in[velocity_count];
    const Row row = lattice_.row(i);
    lattice_.row_pointers(parity_, row, in);
    mask_.for_spans(i, [&](const MaskSpan& span) {
      Task task{};
      Set::for_each_velocity([&](auto q) { task.in[q] = in[q] + span.begin; });
      for (int k = 0; k < dimension; ++k) {
        if (span.active && setting_.membranes) task.force[k] = force_[k].row(row) + span.begin;
        task.body_force[k] = static_cast<T>(setting_.body_force[k]);
      }
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

template <class T, class Set>
auto Fluid<T, Set>::wall_forces() const -> WallForces<dimension> {
  using Sums = WallForceSums<dimension>;
  Sums sums;
  // A population that leaves towards the wall and returns gives the wall c_q f_q - c_-q f_-q = c_q (f_q + f_-q); the
  // one that left is the one that came back plus the wall's own momentum: f_q = f_-q + 6 w_q c_q . u_wall.
  for (int i = 0; i < lattice_.rows(); ++i) {
    const Row row = lattice_.row(i);
    const T* in[velocity_count];
    lattice_.row_pointers(parity_, row, in);
    const auto beyond = [&](int axis, int c) {
      const int place = row[axis - 1] + c;
      return (place < 0 && setting_.domain.wall_below(axis)) ||
             (place >= lattice_.size(axis) && setting_.domain.wall_above(axis));
    };
    const auto wall_of = [&](const auto& c) {
      return !beyond(1, c[1]) ? Sums::other : c[1] < 0 ? Sums::lower : Sums::upper;
    };
    // What a plane in direction q gets, times `sign`.
    const auto add_plane = [&](int q, int x, double sign) {
      const auto& c = Set::velocity[q];
      const typename Sums::Wall wall = wall_of(c);
      const double speed = wall == Sums::other ? 0 : wall == Sums::lower ? last_walls_.lower : last_walls_.upper;
      const double force = 2 * static_cast<double>(in[Set::opposite[q]][x]) + 6 * Set::weight[q] * c[0] * speed;
      for (int k = 0; k < dimension; ++k)
        if (c[k] != 0) sums.add(wall, k, sign * c[k] * force);
    };
    for (int q = 1; q < velocity_count; ++q) {
      const auto& c = Set::velocity[q];
      if (!beyond(1, c[1]) && !(dimension == 3 && beyond(dimension - 1, c[dimension - 1]))) continue;
      mask_.for_fluid(i, [&](int begin, int end) {
        for (int x = begin; x < end; ++x) add_plane(q, x, 1);
      });
    }
    if (!links_) continue;
    links_->for_links(i, [&](int x, int q, double left, bool plane) {
      if (plane) add_plane(Set::opposite[q], x, -1);  // a wall before it takes all
      for (int k = 0; k < dimension; ++k) {
        if (Set::velocity[q][k] != 0)
          sums.add(Sums::other, k, -Set::velocity[q][k] * (left + static_cast<double>(in[q][x])));
      }
    });
  }
  WallForces<dimension> forces = sums.total(ranks_);
  if (!walls_have_acted_)
    forces.lower.fill(std::nan("")), forces.upper.fill(std::nan("")), forces.other.fill(std::nan(""));
  return forces;
}

template <class T, class Set>
double Fluid<T, Set>::equilibrium(int q, double density, const std::array<double, dimension>& u) const {
  const auto dot = [](const auto& a, const auto& b) {
    double sum = a[0] * b[0];
    for (int k = 1; k < dimension; ++k) sum += a[k] * b[k];
    return sum;
  };
  const auto& c = Set::velocity[q];
  const auto quadratic = [&](const auto& a) { return 4.5 * dot(c, a) * dot(c, a) - 1.5 * dot(a, a); };
  double terms = 0;
  if (setting_.inertia) {
    terms = quadratic(u);
  } else if (frame_ != std::array<double, dimension>{}) {
    std::array<double, dimension> seen = u;
    for (int k = 0; k < dimension; ++k) seen[k] -= frame_[k];
    terms = quadratic(u) - quadratic(seen);
  }
  return Set::weight[q] * (density + 3 * dot(c, u) + terms);
}

template <class T, class Set>
void Fluid<T, Set>::set_state(const StateOfNode& state) {
  parity_ = Parity::even;
  walls_have_acted_ = true;  // a state that is given is one that goes with these walls
  const auto& begin = setting_.domain.block.begin;
  for (int i = 0; i < lattice_.rows(); ++i) {
    const Row row = lattice_.row(i);
    const double tau = 1 / rate_of_row(row);
    for (int x = 0; x < nx(); ++x) {
      State s;
      if constexpr (dimension == 2) {
        s = state(begin[0] + x, begin[1] + row[0]);
      } else {
        s = state(begin[0] + x, begin[1] + row[0], begin[2] + row[1]);
      }
      // Populations hold the momentum without the half force that the velocity includes.
      std::array<double, dimension> momentum;
      for (int k = 0; k < dimension; ++k) momentum[k] = s.velocity[k] - 0.5 * setting_.body_force[k];
      for (int q = 0; q < velocity_count; ++q) {
        const auto& c = Set::velocity[q];
        double strain = 0, divergence = 0;
        for (int k = 0; k < dimension; ++k) {
          strain += static_cast<double>(c[k] * c[k]) * s.gradient[(dimension + 1) * k];
          for (int l = k + 1; l < dimension; ++l)
            strain +=
                static_cast<double>(c[k] * c[l]) * (s.gradient[dimension * k + l] + s.gradient[dimension * l + k]);
          divergence += s.gradient[(dimension + 1) * k];
        }
        strain -= divergence / 3;
        lattice_.slot(q, row)[x] =
            static_cast<T>(equilibrium(q, s.density, momentum) - 3 * tau * Set::weight[q] * strain);
      }
    }
    send_row(lattice_, row);
  }
  restart_links();
}

template <class T, class Set>
void Fluid<T, Set>::set_rest() {
  if (!driven()) return;
  set_profile([](double) { return 0.0; }, [](double) { return 0.0; });
  walls_have_acted_ = false;
}

template <class T, class Set>
void Fluid<T, Set>::set_profile(const std::function<double(double)>& velocity,
                                const std::function<double(double)>& shear_rate) {
  const auto at = [&](int y) {
    State s{};
    s.velocity[0] = velocity(y);
    s.gradient[1] = shear_rate(y);
    return s;
  };
  if constexpr (dimension == 2) {
    set_state([&](int, int y) { return at(y); });
  } else {
    set_state([&](int, int y, int) { return at(y); });
  }
}

template <class T, class Set>
void Fluid<T, Set>::take_over(Fluid& other, double factor) {
  other.settle();
  parity_ = Parity::even;
  std::array<double, dimension> half;  // that the velocity has of the forces, before and now
  for (int k = 0; k < dimension; ++k) half[k] = (factor * other.setting_.body_force[k] - setting_.body_force[k]) / 2;
  for (int i = 0; i < lattice_.rows(); ++i) {
    const Row row = lattice_.row(i);
    const T* in[velocity_count];
    other.lattice_.row_pointers(other.parity_, row, in);
    mask_.for_fluid(i, [&](int begin, int end) {
      for (int x = begin; x < end; ++x) {
        double density = 0;
        std::array<double, dimension> momentum{}, scaled;
        for (int q = 0; q < velocity_count; ++q) {
          const double f = static_cast<double>(in[q][x]);
          density += f;
          for (int k = 0; k < dimension; ++k) momentum[k] += Set::velocity[q][k] * f;
        }
        for (int k = 0; k < dimension; ++k) scaled[k] = factor * momentum[k] + half[k];
        for (int q = 0; q < velocity_count; ++q) {
          const double rest = static_cast<double>(in[q][x]) - other.equilibrium(q, density, momentum);
          lattice_.slot(q, row)[x] = static_cast<T>(equilibrium(q, factor * density, scaled) + factor * rest);
        }
      }
    });
    send_row(lattice_, row);
  }
  restart_links();
}

template <class T, class Set>
void Fluid<T, Set>::restart_links() {
  if (links_) links_->restart();
}

template <class T, class Set>
void Fluid<T, Set>::copy_populations(int q, std::vector<double>& values) const {
  values.resize(static_cast<std::size_t>(nx()) * static_cast<std::size_t>(lattice_.rows()));
  for (int i = 0; i < lattice_.rows(); ++i)
    copy_population(q, i, values.data() + static_cast<std::ptrdiff_t>(nx()) * i);
}

template <class T, class Set>
void Fluid<T, Set>::restore(const std::function<std::vector<double>(int)>& populations, bool walls_have_acted) {
  parity_ = Parity::even;
  walls_have_acted_ = walls_have_acted;
  last_walls_ = setting_.walls;
  for (int q = 0; q < velocity_count; ++q) {
    const std::vector<double> values = populations(q);
    const double* from = values.data();
    for (int i = 0; i < lattice_.rows(); ++i, from += nx()) std::copy_n(from, nx(), lattice_.slot(q, lattice_.row(i)));
  }
  for (int i = 0; i < lattice_.rows(); ++i) send_row(lattice_, lattice_.row(i));
  restart_links();
}

template class Fluid<float>;
template class Fluid<double>;
template class Fluid<float, D3Q19>;
template class Fluid<double, D3Q19>;

}  // namespace rouleau::core
