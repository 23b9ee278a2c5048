// Kinetic energy and viscous dissipation of the fluid, for the energy ledger.
#include <rouleau/d2q9.hpp>

#include "fluid.hpp"

namespace rouleau::core {

namespace {

/// Sum over a row of f c . (u - u at the link's origin).
template <class T>
double change_along(const T* f, int nx, double cx, double cy, const double* ux, const double* uy,
                    const double* origin_x, const double* origin_y) {
  double sum = 0;
  for (int x = 0; x < nx; ++x)
    sum += static_cast<double>(f[x]) * (cx * (ux[x] - origin_x[x]) + cy * (uy[x] - origin_y[x]));
  return sum;
}

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
  Energetics sum{};
  std::vector<Moments> row;
  for (int y = 0; y < ny; ++y) {
    moments(y, row);
    double *ux = at(velocity_x, y), *uy = at(velocity_y, y);
    for (int x = 0; x < nx; ++x) {
      const Moments& m = row[x];
      ux[x] = m.ux;
      uy[x] = m.uy;
      sum.kinetic += 0.5 * (m.ux * m.ux + m.uy * m.uy);
      sum.velocity_x += m.ux;
      sum.velocity_y += m.uy;
    }
    for (double* u : {ux, uy}) u[-1] = u[nx - 1], u[nx] = u[0];
    if (!setting_.membranes) continue;
    activity_.for_runs(y, [&](const Run& run) {
      for (int x = run.begin; x < run.end && run.active; ++x)
        sum.membrane_power += (static_cast<double>(force_.x.row(y)[x]) - setting_.body_force_x) * ux[x] +
                              (static_cast<double>(force_.y.row(y)[x]) - setting_.body_force_y) * uy[x];
    });
  }
  for (int y = 0; y < ny; ++y) {
    const T* in[9];
    lattice_.row_pointers(parity_, y, in);
    for (int q = 1; q < 9; ++q) {
      const int cx = d2q9::velocity[q][0], cy = d2q9::velocity[q][1];
      const int from = setting_.domain.wrapped(1, y - cy);
      if (from >= 0) {
        sum.dissipation -= change_along(in[q], nx, cx, cy, at(velocity_x, y), at(velocity_y, y),
                                        at(velocity_x, from) - cx, at(velocity_y, from) - cx);
        continue;
      }
      const double speed = y < cy ? setting_.walls.lower : setting_.walls.upper;
      const double moved = 6 * d2q9::weight[q] * cx * speed;  // as in wall_stress()
      for (int x = 0; x < nx; ++x)
        sum.dissipation -= (2 * static_cast<double>(in[q][x]) - moved) *
                           (cx * (at(velocity_x, y)[x] - speed) + cy * at(velocity_y, y)[x]);
    }
  }
  return sum;
}

template Fluid<float>::Energetics Fluid<float>::energetics() const;
template Fluid<double>::Energetics Fluid<double>::energetics() const;

}  // namespace rouleau::core
