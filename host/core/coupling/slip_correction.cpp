#include "slip_correction.hpp"

#include <algorithm>
#include <cmath>
#include <rouleau/dispatch.hpp>

#include "core/membrane/closed_outline.hpp"

namespace rouleau::core {

namespace {

/// One cell's nodes [begin, end) in arrays of all nodes.
struct SlipTask {
  int begin, end;
  double shift, mobility;  // of the cell's type; mobility: slip per tangential force per length
  int smoothings;
  const double *x, *y;
  const double *node_force_x, *node_force_y;
  double *tangent_x, *tangent_y, *inverse_chord;
  double *touch_x, *touch_y, *force_x, *force_y, *slip, *scratch_x, *scratch_y;
  double *velocity_x, *velocity_y;
};

template <class S>
ROULEAU_ALWAYS_INLINE S load(const double* from, int i) {
  return S::load(from + i);
}

struct Measure {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SlipTask* task) {
    const SlipTask t = *task;
    core::for_closed_outline<register_bytes>(t.begin, t.end, [&](auto tag, int i, int before, int after) {
      using S = decltype(tag);
      const S dx = load<S>(t.x, after) - load<S>(t.x, before), dy = load<S>(t.y, after) - load<S>(t.y, before);
      const S chord = sqrt(dx * dx + dy * dy);
      const S inverse = select(chord > S(0.0), 1.0 / chord, S(0.0));  // a fold without width has no direction
      const S tx = dx * inverse, ty = dy * inverse;
      tx.store(t.tangent_x + i);
      ty.store(t.tangent_y + i);
      inverse.store(t.inverse_chord + i);
      (load<S>(t.x, i) - t.shift * ty).store(t.touch_x + i);  // outward normal: (ty, -tx)
      (load<S>(t.y, i) + t.shift * tx).store(t.touch_y + i);
    });
  }
};

struct Slip {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SlipTask* task) {
    const SlipTask t = *task;
    double *slip = t.slip, *other = t.scratch_x;
    if (t.smoothings % 2 != 0) std::swap(slip, other);  // so that the last smoothing ends in t.slip
    core::for_closed_outline<register_bytes>(t.begin, t.end, [&](auto tag, int i, int, int) {
      using S = decltype(tag);
      const S tx = load<S>(t.tangent_x, i), ty = load<S>(t.tangent_y, i);
      const S along = load<S>(t.node_force_x, i) * tx + load<S>(t.node_force_y, i) * ty;
      (2.0 * t.mobility * along * load<S>(t.inverse_chord, i)).store(slip + i);
    });
    for (int k = 0; k < t.smoothings; ++k) {
      core::for_closed_outline<register_bytes>(t.begin, t.end, [&](auto tag, int i, int before, int after) {
        using S = decltype(tag);
        (0.25 * (load<S>(slip, before) + load<S>(slip, after)) + 0.5 * load<S>(slip, i)).store(other + i);
      });
      std::swap(slip, other);
    }
  }
};

struct Couple {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SlipTask* task) {
    const SlipTask t = *task;
    // The couple of every node: to the node after it, and its reverse to the node before.
    core::for_closed_outline<register_bytes>(t.begin, t.end, [&](auto tag, int i, int, int) {
      using S = decltype(tag);
      const S tx = load<S>(t.tangent_x, i), ty = load<S>(t.tangent_y, i);
      const S fx = load<S>(t.node_force_x, i), fy = load<S>(t.node_force_y, i);
      const S along = fx * tx + fy * ty, outward = fx * ty - fy * tx;
      const S lever = t.shift * load<S>(t.inverse_chord, i);
      (-lever * (along * ty + outward * tx)).store(t.scratch_x + i);
      (-lever * (outward * ty - along * tx)).store(t.scratch_y + i);
    });
    core::for_closed_outline<register_bytes>(t.begin, t.end, [&](auto tag, int i, int before, int after) {
      using S = decltype(tag);
      (load<S>(t.scratch_x, before) - load<S>(t.scratch_x, after)).store(t.force_x + i);
      (load<S>(t.scratch_y, before) - load<S>(t.scratch_y, after)).store(t.force_y + i);
    });
  }
};

struct Correct {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const SlipTask* task) {
    const SlipTask t = *task;
    std::copy(t.velocity_x + t.begin, t.velocity_x + t.end, t.scratch_x + t.begin);
    std::copy(t.velocity_y + t.begin, t.velocity_y + t.end, t.scratch_y + t.begin);
    core::for_closed_outline<register_bytes>(t.begin, t.end, [&](auto tag, int i, int before, int after) {
      using S = decltype(tag);
      const S tx = load<S>(t.tangent_x, i), ty = load<S>(t.tangent_y, i);
      const S lever = t.shift * load<S>(t.inverse_chord, i);
      const S du = lever * (load<S>(t.scratch_x, after) - load<S>(t.scratch_x, before));
      const S dv = lever * (load<S>(t.scratch_y, after) - load<S>(t.scratch_y, before));
      const S along = du * tx + dv * ty, outward = du * ty - dv * tx;
      const S tangential = load<S>(t.slip, i) - outward;
      (load<S>(t.scratch_x, i) + tangential * tx - along * ty).store(t.velocity_x + i);
      (load<S>(t.scratch_y, i) + tangential * ty + along * tx).store(t.velocity_y + i);
    });
  }
};

}  // namespace

SlipCorrection::SlipCorrection(const Membranes& membranes, std::vector<Type> types, double viscosity)
    : types_(std::move(types)), viscosity_(viscosity) {
  for (std::size_t t = 0; t < types_.size(); ++t) {
    const Type& type = types_[t];
    const RestShape& rest = *membranes.types[t];
    // Sliding along a curved membrane changes its curvature too, by curvature x d slide / d length.
    double curvature = 0;
    for (const double at_rest : rest.rest_curvature) curvature = std::max(curvature, std::abs(at_rest));
    const double stiffness = type.stretching_stiffness + type.bending_stiffness * curvature * curvature;
    smoothings_.push_back(outline_slip_smoothings(rest.rest_perimeter / static_cast<double>(rest.x.size()),
                                                  type.constants.slip / viscosity, stiffness));
  }
  for (auto* values : {&tangent_x_, &tangent_y_, &inverse_chord_, &touch_x_, &touch_y_, &force_x_, &force_y_, &slip_,
                       &scratch_x_, &scratch_y_})
    *values = PagedArray<double>(membranes.position[0].size());
}

void SlipCorrection::forget(std::span<const Range> nodes) {
  for (auto* values : {&tangent_x_, &tangent_y_, &inverse_chord_, &touch_x_, &touch_y_, &force_x_, &force_y_, &slip_,
                       &scratch_x_, &scratch_y_})
    release(*values, nodes);
}

template <class Loop>
void SlipCorrection::run(Worker worker, const Membranes& membranes, double* velocity_x, double* velocity_y,
                         Whose whose) {
  static const auto function = Dispatch<Loop, const SlipTask*>::pick();
  const CellNumbers cells = membranes.known_cells(worker);
  for (const int c : cells) {
    if (!membranes.is(c, whose)) continue;
    const CellRange& cell = membranes.cells[c];
    const SlipConstants& constants = types_[cell.type].constants;
    const SlipTask task{cell.first,
                        cell.end(),
                        constants.shift,
                        constants.slip / viscosity_,
                        smoothings_[cell.type],
                        membranes.position[0].data(),
                        membranes.position[1].data(),
                        membranes.force[0].data(),
                        membranes.force[1].data(),
                        tangent_x_.data(),
                        tangent_y_.data(),
                        inverse_chord_.data(),
                        touch_x_.data(),
                        touch_y_.data(),
                        force_x_.data(),
                        force_y_.data(),
                        slip_.data(),
                        scratch_x_.data(),
                        scratch_y_.data(),
                        velocity_x,
                        velocity_y};
    function(&task);
  }
}

std::vector<NodeMobility> SlipCorrection::mobility() const {
  std::vector<NodeMobility> mobility;
  for (const Type& type : types_) mobility.push_back({type.constants.shift, type.constants.slip / viscosity_});
  return mobility;
}

void SlipCorrection::measure(Worker worker, const Membranes& membranes, Whose whose) {
  run<Measure>(worker, membranes, nullptr, nullptr, whose);
}

void SlipCorrection::complete(Worker worker, const Membranes& membranes) {
  run<Couple>(worker, membranes, nullptr, nullptr, Whose::own);
  run<Slip>(worker, membranes, nullptr, nullptr, Whose::own);
  for (const int c : membranes.own_cells(worker)) {
    const CellRange& cell = membranes.cells[c];
    for (auto i = static_cast<std::size_t>(cell.first); i < static_cast<std::size_t>(cell.end()); ++i) {
      force_x_[i] = membranes.force[0][i] + force_x_[i];
      force_y_[i] = membranes.force[1][i] + force_y_[i];
    }
  }
}

void SlipCorrection::correct(Worker worker, Membranes& membranes) {
  run<Correct>(worker, membranes, membranes.velocity[0].data(), membranes.velocity[1].data(), Whose::own);
}

}  // namespace rouleau::core
