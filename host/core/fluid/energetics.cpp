// Kinetic energy and viscous dissipation of the fluid, for the energy ledger.
#include <rouleau/d2q9.hpp>

#include "core/domain/exact_sum.hpp"
#include "fluid.hpp"

namespace rouleau::core {

namespace {

/// Terms of a row, then added to a sum at once.
class RowTerms {
 public:
  explicit RowTerms(int nx) : terms_(static_cast<std::size_t>(nx)) {}
  template <class Term>
  void add_to(ExactSum& sum, int begin, int end, Term term) {
    for (int x = begin; x < end; ++x) terms_[x] = term(x);
    sum.add(terms_.data() + begin, static_cast<std::size_t>(end - begin));
  }

 private:
  std::vector<double> terms_;
};

}  // namespace

// Every step, population q brings momentum c_q f_q from node x - c_q to node x. Summed by parts, the change of the
// kinetic energy is the forces' power, the walls' power, and
//
//     - D = sum over x and q of f_q(x) c_q . (u(x) - u(x - c_q)),
//
// for links that end in a wall the momentum exchanged with it times u(x) - u_wall. In a flow that varies slowly this is
// 2 mu S:S. Unlike that it is right on the scale of the lattice, too, on which the membranes' forces are spread.
template <class T>
typename Fluid<T>::Energetics Fluid<T>::energetics() const {
  const int nx = this->nx(), ny = this->ny();
  // Velocities with a copy of the last node before the first and of the first behind the last.
  const auto width = static_cast<std::size_t>(nx) + 2;
  std::vector<double> velocity_x(width * static_cast<std::size_t>(ny)), velocity_y(velocity_x.size());
  const auto at = [width](auto& values, int y) { return values.data() + width * static_cast<std::size_t>(y) + 1; };
  ExactSum kinetic, sum_x, sum_y, membrane_power, dissipation;
  RowTerms terms(nx);
  std::vector<Moments> row;
  for (int y = 0; y < ny; ++y) {
    moments(y, row);
    double *ux = at(velocity_x, y), *uy = at(velocity_y, y);
    for (int x = 0; x < nx; ++x) {
      ux[x] = row[x].ux;
      uy[x] = row[x].uy;
    }
    sum_x.add(ux, static_cast<std::size_t>(nx));
    sum_y.add(uy, static_cast<std::size_t>(nx));
    terms.add_to(kinetic, 0, nx, [&](int x) { return 0.5 * (ux[x] * ux[x] + uy[x] * uy[x]); });
    for (double* u : {ux, uy}) u[-1] = u[nx - 1], u[nx] = u[0];
    if (!setting_.membranes) continue;
    mask_.for_spans(y, [&](const MaskSpan& run) {
      if (!run.active) return;
      const T *fx = force_.x.row(y), *fy = force_.y.row(y);
      terms.add_to(membrane_power, run.begin, run.end, [&](int x) {
        return (static_cast<double>(fx[x]) - setting_.body_force_x) * ux[x] +
               (static_cast<double>(fy[x]) - setting_.body_force_y) * uy[x];
      });
    });
  }
  for (int y = 0; y < ny; ++y) {
    const T* in[9];
    lattice_.row_pointers(parity_, y, in);
    for (int q = 1; q < 9; ++q) {
      const int cx = d2q9::velocity[q][0], cy = d2q9::velocity[q][1];
      const int from = setting_.domain.wrapped(1, y - cy);
      const T* f = in[q];
      const double *ux = at(velocity_x, y), *uy = at(velocity_y, y);
      if (from >= 0) {
        const double *origin_x = at(velocity_x, from) - cx, *origin_y = at(velocity_y, from) - cx;
        terms.add_to(dissipation, 0, nx, [&](int x) {
          return -static_cast<double>(f[x]) * (cx * (ux[x] - origin_x[x]) + cy * (uy[x] - origin_y[x]));
        });
        continue;
      }
      const double speed = y < cy ? setting_.walls.lower : setting_.walls.upper;
      const double moved = 6 * d2q9::weight[q] * cx * speed;  // as in wall_stress()
      terms.add_to(dissipation, 0, nx, [&](int x) {
        return -(2 * static_cast<double>(f[x]) - moved) * (cx * (ux[x] - speed) + cy * uy[x]);
      });
    }
  }
  return {.kinetic = kinetic.value(),
          .dissipation = dissipation.value(),
          .velocity_x = sum_x.value(),
          .velocity_y = sum_y.value(),
          .membrane_power = membrane_power.value()};
}

template Fluid<float>::Energetics Fluid<float>::energetics() const;
template Fluid<double>::Energetics Fluid<double>::energetics() const;

}  // namespace rouleau::core
