// Kinetic energy and viscous dissipation of the fluid, for the energy ledger.
#include <rouleau/dispatch.hpp>
#include <rouleau/pack.hpp>

#include "core/domain/exact_sum.hpp"
#include "fluid.hpp"

namespace rouleau::core {

namespace {

template <class T, class S>
ROULEAU_ALWAYS_INLINE S load_wide(const T* from) {
  return S(__builtin_convertvector(Pack<T, S::size>::load(from).vector, typename S::Vector));
}

/// Consecutive nodes of a row.
template <class T, class Set>
struct VelocityTask {
  const T* in[Set::velocity_count];
  const T* force[Set::dimension];  // null: body_force
  double body_force[Set::dimension];
  int count;
  double* velocity[Set::dimension];  // to be set
};

template <class T, class Set>
struct FindVelocity {
  using Task = VelocityTask<T, Set>;
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const Task* task) {
    using S = Pack<double, register_bytes / 8>;
    const Task t = *task;
    const int whole = t.count / S::size * S::size;
    for (int x = 0; x < whole; x += S::size) set<S>(t, x);
    for (int x = whole; x < t.count; ++x) set<Pack<double, 1>>(t, x);
  }

 private:
  template <class S>
  ROULEAU_ALWAYS_INLINE static void set(const Task& t, int x) {
    S u[Set::dimension];
    for (S& component : u) component = S(0.0);
    Set::for_each_velocity([&](auto q) {
      const S f = load_wide<T, S>(t.in[q] + x);
      for (int k = 0; k < Set::dimension; ++k) {
        if (Set::velocity[q][k] != 0) u[k] = Set::velocity[q][k] > 0 ? u[k] + f : u[k] - f;
      }
    });
    for (int k = 0; k < Set::dimension; ++k) {
      const S force = t.force[k] != nullptr ? load_wide<T, S>(t.force[k] + x) : S(t.body_force[k]);
      (u[k] + 0.5 * force).store(t.velocity[k] + x);
    }
  }
};

/// Rows beside a row, itself in the middle, are counted along y first: by -1, 0 or 1 along y and z.
template <class Set>
struct RowsAround {
  static constexpr int count = Set::dimension == 2 ? 3 : 9, middle = count / 2;
  /// The row that velocity q comes from.
  static constexpr int origin(int q) {
    int at = 0;
    for (int k = Set::dimension - 1; k > 0; --k) at = 3 * at + 1 - Set::velocity[q][k];
    return at;
  }
};

/// A row of nodes; its velocities and those of the rows around it, with a node more at both ends.
template <class T, class Set>
struct EnergyTask {
  const T* in[Set::velocity_count];
  const double* velocity[RowsAround<Set>::count][Set::dimension];  // null: there is a wall
  double wall_speed[3];                                            // by the place along y
  int count;
  ExactSum* sum[Set::dimension];
  ExactSum *kinetic, *dissipation;
};

template <class T, class Set>
struct SumEnergy {
  using Task = EnergyTask<T, Set>;
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const Task* task) {
    using S = Pack<double, register_bytes / 8>;
    const Task t = *task;
    double kinetic[stretch], lost[stretch];
    for (int begin = 0; begin < t.count; begin += stretch) {
      const int count = std::min(stretch, t.count - begin), whole = count / S::size * S::size;
      for (int i = 0; i < whole; i += S::size) set<S>(t, begin + i, kinetic + i, lost + i);
      for (int i = whole; i < count; ++i) set<Pack<double, 1>>(t, begin + i, kinetic + i, lost + i);
      const auto terms = static_cast<std::size_t>(count);
      for (int k = 0; k < Set::dimension; ++k) t.sum[k]->add(t.velocity[RowsAround<Set>::middle][k] + begin, terms);
      t.kinetic->add(kinetic, terms);
      t.dissipation->add(lost, terms);
    }
  }

 private:
  static constexpr int stretch = 256;
  template <class S>
  ROULEAU_ALWAYS_INLINE static void set(const Task& t, int x, double* kinetic, double* lost) {
    S u[Set::dimension];
    for (int k = 0; k < Set::dimension; ++k) u[k] = S::load(t.velocity[RowsAround<Set>::middle][k] + x);
    S sum = 0.0, square = u[0] * u[0];
    for (int k = 1; k < Set::dimension; ++k) square += u[k] * u[k];
    Set::for_each_velocity([&](auto q) {
      constexpr auto& c = Set::velocity[q];
      if constexpr (q == 0) return;
      const S f = load_wide<T, S>(t.in[q] + x);
      const double* const* origin = t.velocity[RowsAround<Set>::origin(q)];
      if (origin[0] != nullptr) {
        S change = c[0] * (u[0] - S::load(origin[0] + x - c[0]));
        for (int k = 1; k < Set::dimension; ++k) change += c[k] * (u[k] - S::load(origin[k] + x - c[0]));
        sum -= f * change;
      } else {
        const double speed = t.wall_speed[1 - c[1]], moved = 6 * Set::weight[q] * c[0] * speed;  // as in wall_stress()
        S change = c[0] * (u[0] - speed);
        for (int k = 1; k < Set::dimension; ++k) change += c[k] * u[k];
        sum -= (2.0 * f - moved) * change;
      }
    });
    (0.5 * square).store(kinetic);
    sum.store(lost);
  }
};

/// Velocities of rows with a node more at both ends, and of those around the block, of three layers across the last axis
/// that follow each other.
template <int D>
class VelocityRows {
 public:
  explicit VelocityRows(const Box<D>& block) {
    stride_[0] = 1;
    for (int k = 1; k < D; ++k) stride_[k] = stride_[k - 1] * (block.size(k - 1) + 2);
    for (auto& values : values_) values.resize(static_cast<std::size_t>(stride_[D - 1]) * layers);
  }
  /// Every component of a row, at x = 0; its coordinates in [-1, size].
  [[nodiscard]] std::array<double*, D> row(std::array<int, D - 1> row) {
    row[D - 2] = (row[D - 2] + 1) % layers - 1;
    std::ptrdiff_t at = 1;
    for (int k = 1; k < D; ++k) at += stride_[k] * (row[k - 1] + 1);
    std::array<double*, D> u;
    for (int k = 0; k < D; ++k) u[k] = values_[k].data() + at;
    return u;
  }

 private:
  static constexpr int layers = 3;
  std::array<std::ptrdiff_t, D> stride_;
  std::array<std::vector<double>, D> values_;
};

}  // namespace

// Every step, population q brings momentum c_q f_q from node x - c_q to node x. Summed by parts, the change of the
// kinetic energy is the forces' power, the walls' power, and
//
//     - D = sum over x and q of f_q(x) c_q . (u(x) - u(x - c_q)),
//
// for links that end in a wall the momentum exchanged with it times u(x) - u_wall. In a flow that varies slowly this is
// 2 mu S:S. Unlike that it is right on the scale of the lattice, too, on which the membranes' forces are spread.
template <class T, class Set>
void Fluid<T, Set>::velocities(int i, const std::array<double*, dimension>& u) const {
  using Task = VelocityTask<T, Set>;
  static const auto function = Dispatch<FindVelocity<T, Set>, const Task*>::pick();
  const T* in[velocity_count];
  const Row row = lattice_.row(i);
  lattice_.row_pointers(parity_, row, in);
  mask_.for_solid(i, [&](int begin, int end) {
    for (double* component : u) std::fill(component + begin, component + end, 0.0);
  });
  mask_.for_spans(i, [&](const MaskSpan& span) {
    Task task{};
    task.count = span.end - span.begin;
    for (int q = 0; q < velocity_count; ++q) task.in[q] = in[q] + span.begin;
    for (int k = 0; k < dimension; ++k) {
      task.body_force[k] = setting_.body_force[k];
      task.velocity[k] = u[k] + span.begin;
      if (span.active && setting_.membranes) task.force[k] = force_[k].row(row) + span.begin;
    }
    function(&task);
  });
  for (double* component : u) {
    if (setting_.domain.wraps(0)) component[-1] = component[nx() - 1], component[nx()] = component[0];
  }
}

template <class T, class Set>
typename Fluid<T, Set>::Energetics Fluid<T, Set>::energetics() const {
  using Task = EnergyTask<T, Set>;
  static const auto function = Dispatch<SumEnergy<T, Set>, const Task*>::pick();
  const int nx = this->nx();
  const Domain<dimension>& domain = setting_.domain;
  constexpr int last = dimension - 1;
  const int layers = lattice_.size(last), rows_of_layer = lattice_.rows() / layers;
  VelocityRows<dimension> rows(domain.block);
  // Of the nodes at borders to other blocks, which tell each other of theirs before any row is summed up.
  std::array<std::vector<double>, dimension> edge;
  if (energetics_halo_) {
    std::array<double*, dimension> edge_nodes;
    for (int k = 0; k < dimension; ++k) {
      edge[k].resize(edge_nodes_->count());
      edge_nodes[k] = edge[k].data();
    }
    for (int i = 0; i < lattice_.rows(); ++i) {
      const Row row = lattice_.row(i);
      const bool whole = edge_nodes_->whole(row);
      if (!whole && domain.wraps(0)) continue;
      const std::array<double*, dimension> u = rows.row(row);  // for a moment
      velocities(i, u);
      for (int k = 0; k < dimension; ++k) {
        double* const to = edge_nodes[k];
        if (whole) {
          std::copy_n(u[k], nx, to + edge_nodes_->place(0, row));
        } else {
          for (const int x : {0, nx - 1}) to[edge_nodes_->place(x, row)] = u[k][x];
        }
      }
    }
    energetics_halo_->begin(Way::out, edge_nodes);
    energetics_halo_->end(Way::out, edge_nodes);
  }
  const auto inside = [&](int axis, int place) {
    const int n = lattice_.size(axis);
    return domain.wraps(axis) ? (place + n) % n : (place < n ? place : -1);
  };
  // A row of this block or, `from` negative, of others.
  const auto find_row = [&](int from, const Row& row) {
    const std::array<double*, dimension> u = rows.row(row);
    if (from >= 0) velocities(from, u);
    for (int k = 0; energetics_halo_ && k < dimension; ++k) {
      const auto other = [&](int x) { return edge[k][static_cast<std::size_t>(edge_nodes_->place(x, row))]; };
      if (from < 0) {
        for (int x = -1; x <= nx; ++x) u[k][x] = other(x);
      } else if (!domain.wraps(0)) {
        u[k][-1] = other(-1), u[k][nx] = other(nx);
      }
    }
  };
  const auto find = [&](int layer) {
    const int from = inside(last, layer);
    if constexpr (dimension == 2) {
      find_row(from, {layer});
    } else {
      for (int y = -1; y <= lattice_.size(1); ++y) {
        const int from_y = inside(1, y);
        find_row(from < 0 || from_y < 0 ? -1 : from_y + lattice_.size(1) * from, {y, layer});
      }
    }
  };
  find(-1), find(0);
  enum { kinetic, membrane_power, dissipation, sum_of_velocity };
  std::vector<ExactSum> sums(sum_of_velocity + dimension);
  std::vector<double> power(static_cast<std::size_t>(nx));
  for (int i = 0; i < lattice_.rows(); ++i) {
    const Row row = lattice_.row(i);
    if (i % rows_of_layer == 0) find(row[last - 1] + 1);
    Task task{};
    task.wall_speed[0] = last_walls_.lower, task.wall_speed[2] = last_walls_.upper;
    task.count = nx;
    for (int k = 0; k < dimension; ++k) task.sum[k] = &sums[sum_of_velocity + k];
    task.kinetic = &sums[kinetic];
    task.dissipation = &sums[dissipation];
    lattice_.row_pointers(parity_, row, task.in);
    for (int place = 0; place < RowsAround<Set>::count; ++place) {
      Row beside = row;
      bool wall = false;
      for (int k = 1, rest = place; k < dimension; ++k, rest /= 3) {
        int& coordinate = beside[k - 1];
        coordinate += rest % 3 - 1;
        wall = wall || (coordinate < 0 && domain.wall_below(k)) ||
               (coordinate >= lattice_.size(k) && domain.wall_above(k));
      }
      if (wall) continue;
      const std::array<double*, dimension> u = rows.row(beside);
      std::copy(u.begin(), u.end(), task.velocity[place]);
    }
    const std::array<double*, dimension> u = rows.row(row);
    if (!links_) {
      function(&task);
    } else {
      mask_.for_fluid(i, [&](int begin, int end) {
        Task part = task;
        part.count = end - begin;
        for (const T*& in : part.in) in += begin;
        for (auto& beside : part.velocity) {
          for (const double*& component : beside) component += component != nullptr ? begin : 0;
        }
        function(&part);
      });
      // A link into a wall counts with what left, too; beyond plane walls that has been taken for what came back.
      links_->for_links(i, [&](int x, int q, double left, bool plane) {
        double change = 0;
        for (int k = 0; k < dimension; ++k) change += Set::velocity[q][k] * u[k][x];
        sums[dissipation].add(-(plane ? left - static_cast<double>(task.in[q][x]) : left) * change);
      });
    }
    if (!setting_.membranes) continue;
    mask_.for_spans(i, [&](const MaskSpan& span) {
      if (!span.active) return;
      for (int x = span.begin; x < span.end; ++x) {
        power[x] = 0;
        for (int k = 0; k < dimension; ++k)
          power[x] += (static_cast<double>(force_[k].row(row)[x]) - setting_.body_force[k]) * u[k][x];
      }
      sums[membrane_power].add(power.data() + span.begin, static_cast<std::size_t>(span.end - span.begin));
    });
  }
  add_up(ranks_, sums);
  Energetics energetics{.kinetic = sums[kinetic].value(),
                        .dissipation = sums[dissipation].value(),
                        .velocity = {},
                        .membrane_power = sums[membrane_power].value()};
  for (int k = 0; k < dimension; ++k) energetics.velocity[k] = sums[sum_of_velocity + k].value();
  return energetics;
}

#define ROULEAU_INSTANTIATE(T, Set)                                                          \
  template void Fluid<T, Set>::velocities(int, const std::array<double*, dimension>&) const; \
  template Fluid<T, Set>::Energetics Fluid<T, Set>::energetics() const;
ROULEAU_INSTANTIATE(float, D2Q9)
ROULEAU_INSTANTIATE(double, D2Q9)
ROULEAU_INSTANTIATE(float, D3Q19)
ROULEAU_INSTANTIATE(double, D3Q19)
#undef ROULEAU_INSTANTIATE

}  // namespace rouleau::core
