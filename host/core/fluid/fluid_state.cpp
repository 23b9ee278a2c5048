#include "fluid_state.hpp"

#include <algorithm>
#include <rouleau/dispatch.hpp>

#include "developed_flow.hpp"
#include "moving_frame.hpp"
#include "openings/section.hpp"
#include "periodic.hpp"
#include "relaxation.hpp"

namespace rouleau::core {

template <class T, class Set>
FluidState<T, Set>::FluidState(const FluidSetting<dimension>& of_fluid)
    : setting(of_fluid),
      mask(of_fluid.domain, of_fluid.solid.get()),
      lattice(of_fluid.domain,
              of_fluid.solid
                  ? RowPieces<dimension>(of_fluid.domain, [this](int i, auto add) { mask.for_fluid(i, add); })
                  : RowPieces<dimension>()) {
  std::array<int, dimension> size{};
  for (int k = 0; k < dimension; ++k) size[k] = setting.domain.block.size(k);
  if (setting.membranes)
    for (int k = 0; k < dimension; ++k) force[k] = Field<T, dimension>(size, k, setting.solid != nullptr);
  const bool layered = !setting.viscosity_of_rows.empty();
  if (setting.viscosity_contrast || layered) relaxation_rate = Field<T, dimension>(size, 0, setting.solid != nullptr);
  for (int y = 0; layered && y < size[1]; ++y) {
    const double ratio = setting.viscosity_of_rows.at(setting.domain.block.begin[1] + y);
    rate_of_height.push_back(rate_of_layer(setting.relaxation_rate, ratio));
  }
  set_plain_rates();
  if (setting.solid) links = std::make_unique<SolidLinks<T, Set>>(lattice, *setting.solid, setting.wall_time);
  for (int i = 0; setting.solid && i <= lattice.rows(); ++i) {
    fluid_below.push_back(i == 0 ? 0 : fluid_below.back());
    if (i > 0) mask.for_fluid(i - 1, [&](int begin, int end) { fluid_below.back() += end - begin; });
  }
  if (setting.openings) {
    parts_of_ends = core::parts_of_ends(setting.domain, setting.solid.get());
    openings = std::make_unique<OpenLinks<T, Set>>(
        lattice, *setting.openings, setting.solid.get(), setting.walls,
        typename OpenLinks<T, Set>::FlowThere{viscosity_of(1 / setting.relaxation_rate),
                                              setting.body_force[setting.domain.flow_axis()], setting.inertia});
  }
}

template <class T, class Set>
std::size_t FluidState<T, Set>::bytes() const {
  std::size_t sum = lattice.bytes() + relaxation_rate.bytes() + (links ? links->bytes() : 0);
  for (const auto& component : force) sum += component.bytes();
  return sum;
}

template <class T, class Set>
void FluidState<T, Set>::set_plain_rates() {
  if (!setting.viscosity_contrast && rate_of_height.empty()) return;
  for (int i = 0; i < lattice.rows(); ++i) {
    const Row row = lattice.row(i);
    T* const rates = relaxation_rate.row(row);
    mask.for_fluid(
        i, [&](int begin, int end) { std::fill(rates + begin, rates + end, static_cast<T>(rate_of_row(row))); });
  }
}

template <class T, class Set>
void FluidState<T, Set>::settle() {
  for (int i = 0; parity == Parity::even && i < lattice.rows(); ++i) receive_row(lattice, lattice.row(i));
  for (int i = 0; openings && i < lattice.rows(); ++i) openings->before_step(parity, i);
  for (int i = 0; i < lattice.rows(); ++i)
    for_links(i, [&](std::size_t piece, const Pointers& at) { links->before_step(piece, at.out); });
}

template <class T, class Set>
double FluidState<T, Set>::equilibrium(int q, double density, const std::array<double, dimension>& u) const {
  const auto dot = [](const auto& a, const auto& b) {
    double sum = a[0] * b[0];
    for (int k = 1; k < dimension; ++k) sum += a[k] * b[k];
    return sum;
  };
  const auto& c = Set::velocity[q];
  const auto quadratic = [&](const auto& a) { return 4.5 * dot(c, a) * dot(c, a) - 1.5 * dot(a, a); };
  double terms = 0;
  if (setting.inertia) {
    terms = quadratic(u);
  } else if (frame != std::array<double, dimension>{}) {
    std::array<double, dimension> seen = u;
    for (int k = 0; k < dimension; ++k) seen[k] -= frame[k];
    terms = quadratic(u) - quadratic(seen);
  }
  return Set::weight[q] * (density + 3 * dot(c, u) + terms);
}

template <class T, class Set>
void FluidState<T, Set>::set(const StateOfNode<dimension>& state) {
  const auto& begin = setting.domain.block.begin;
  for (int i = 0; i < lattice.rows(); ++i) {
    const Row row = lattice.row(i);
    const double tau = 1 / rate_of_row(row);
    lattice.for_pieces(i, [&](const RowPiece& piece, std::size_t) {
      T* slots[velocity_count];
      for (int q = 0; q < velocity_count; ++q) slots[q] = lattice.slot(q, row, piece.begin);
      for (int x = piece.begin; x < piece.end; ++x) {
        NodeState<dimension> s;
        if constexpr (dimension == 2)
          s = state(begin[0] + x, begin[1] + row[0]);
        else
          s = state(begin[0] + x, begin[1] + row[0], begin[2] + row[1]);
        // Populations hold the momentum without the half force that the velocity includes.
        std::array<double, dimension> momentum;
        for (int k = 0; k < dimension; ++k) momentum[k] = s.velocity[k] - 0.5 * setting.body_force[k];
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
          slots[q][x] = static_cast<T>(equilibrium(q, s.density, momentum) - 3 * tau * Set::weight[q] * strain);
        }
      }
    });
  }
  restart();
}

template <class T, class Set>
void FluidState<T, Set>::take_over(const FluidState& other, double factor) {
  std::array<double, dimension> half;  // that the velocity has of the forces, before and now
  for (int k = 0; k < dimension; ++k) half[k] = (factor * other.setting.body_force[k] - setting.body_force[k]) / 2;
  for (int i = 0; i < lattice.rows(); ++i) {
    const Row row = lattice.row(i);
    other.for_fluid(i, [&](int begin, int end, const auto& in) {
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
          lattice.slot(q, row, begin)[x] = static_cast<T>(equilibrium(q, factor * density, scaled) + factor * rest);
        }
      }
    });
  }
  restart();
}

template <class T, class Set>
void FluidState<T, Set>::restore(const std::function<std::vector<double>(int)>& populations) {
  for (int q = 0; q < velocity_count; ++q) {
    const std::vector<double> values = populations(q);
    const double* from = values.data();
    for (int i = 0; i < lattice.rows(); ++i, from += nx()) {
      lattice.for_pieces(i, [&](const RowPiece& piece, std::size_t) {
        std::copy(from + piece.begin, from + piece.end, lattice.slot(q, lattice.row(i), piece.begin) + piece.begin);
      });
    }
  }
  restart();
}

template <class T, class Set>
void FluidState<T, Set>::restart() {
  parity = Parity::even;
  for (int i = 0; i < lattice.rows(); ++i) send_row(lattice, lattice.row(i));
  for (int i = 0; i < lattice.rows(); ++i)
    for_links(i, [&](std::size_t piece, const Pointers& at) { links->restart(piece, at.out); });
  if (openings) openings->restart();
}

template <class T, class Set>
void FluidState<T, Set>::add_moving_frame(const RowPiece& piece, const Row& row,
                                          const typename Lattice<T, Set>::Out& out) const {
  if constexpr (dimension == 2) {
    static const auto function = Dispatch<AddMovingFrame, const MovingFrameTask<T>*>::pick();
    const auto of = [](const std::array<double, 2>& values, T(&to)[2]) {
      for (int k = 0; k < 2; ++k) to[k] = static_cast<T>(values[k]);
    };
    MovingFrameTask<T> task{};
    task.rate = static_cast<T>(rate_of_row(row));
    of(setting.body_force, task.body_force);
    of(frame, task.frame);
    mask.for_spans(piece.row, [&](const MaskSpan& span) {
      if (span.begin < piece.begin || span.begin >= piece.end) return;
      const bool active = has_force(span);
      Set::for_each_velocity([&](auto q) { task.out[q] = out[q] + span.begin; });
      for (int k = 0; k < 2; ++k) task.velocity[k] = active ? force[k].row(row) + span.begin : nullptr;
      task.relaxation_rate = active && setting.viscosity_contrast ? relaxation_rate.row(row) + span.begin : nullptr;
      task.count = span.end - span.begin;
      function(&task);
    });
  }
}

template <class T, class Set>
LinkMemory FluidState<T, Set>::link_memory(const Ranks<dimension>& ranks) const {
  std::vector<std::array<double, 3>> mine;  // place, and what LinkMemory has of it
  for (int i = 0; i < lattice.rows(); ++i) {
    for_links(i, [&](std::size_t piece, const Pointers&) {
      for (const auto& link : links->of_piece(piece))
        mine.push_back(
            {place_of_link(i, link.x, link.q), static_cast<double>(link.left), static_cast<double>(link.away)});
    });
    for_open_links(i, [&](const auto& link, double place) { mine.push_back({place, link.passed, 0}); });
  }
  std::vector<std::array<double, 3>> all;
  for (const auto& of_rank : all_of(ranks, std::move(mine))) all.insert(all.end(), of_rank.begin(), of_rank.end());
  std::sort(all.begin(), all.end());
  LinkMemory memory;
  for (const auto& [place, left, away] : all) {
    memory.place.push_back(place);
    memory.left.push_back(left), memory.away.push_back(away);
  }
  return memory;
}

template <class T, class Set>
void FluidState<T, Set>::recall_links(const LinkMemory& memory) {
  const auto recall = [&](double place, auto take) {
    const auto found = std::lower_bound(memory.place.begin(), memory.place.end(), place);
    if (found == memory.place.end() || *found != place) return;
    const auto at = static_cast<std::size_t>(found - memory.place.begin());
    take(memory.left[at], memory.away[at]);
  };
  for (int i = 0; i < lattice.rows(); ++i) {
    for_links(i, [&](std::size_t piece, const Pointers&) {
      for (auto& link : links->of_piece(piece))
        recall(place_of_link(i, link.x, link.q),
               [&](double left, double away) { link.left = static_cast<T>(left), link.away = static_cast<T>(away); });
    });
    for_open_links(i, [&](auto& link, double place) { recall(place, [&](double sum, double) { link.passed = sum; }); });
  }
}

template struct FluidState<float, D2Q9>;
template struct FluidState<double, D2Q9>;
template struct FluidState<float, D3Q19>;
template struct FluidState<double, D3Q19>;

}  // namespace rouleau::core
