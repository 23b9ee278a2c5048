#include "surface_slip.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace rouleau::core {

namespace {

/// By the mass matrix of hat functions, on a mesh of equal sides: s is from 0 to 6, and 8 would be left with nothing.
int surface_smoothings(double square_of_length, double mobility, double stiffness) {
  return slip_smoothings(static_cast<int>(std::lround(2 / square_of_length)), mobility * stiffness / square_of_length,
                         8);
}

}  // namespace

SurfaceSlip::SurfaceSlip(const Surfaces& surfaces, std::vector<Type> types, double viscosity)
    : types_(std::move(types)), viscosity_(viscosity), area_(surfaces.x.size()) {
  for (std::size_t t = 0; t < types_.size(); ++t) {
    const RestSurface& rest = *surfaces.types[t];
    // Of equal triangles with sides l: sqrt(3)/4 l^2 each.
    const double square = rest.rest_surface_area / rest.mesh.triangle_count() * 4 / std::sqrt(3.0);
    smoothings_.push_back(
        surface_smoothings(square, types_[t].constants.slip / viscosity, types_[t].stretching_stiffness));
  }
  for (auto* vectors : {&normal_, &touch_, &force_, &slip_}) {
    for (auto& values : *vectors) values = PagedArray<double>(surfaces.x.size());
  }
}

void SurfaceSlip::forget(std::span<const Range> nodes) {
  release(area_, nodes);
  for (auto* vectors : {&normal_, &touch_, &force_, &slip_}) {
    for (auto& values : *vectors) release(values, nodes);
  }
}

void SurfaceSlip::measure(Worker worker, const Surfaces& surfaces, Whose whose) {
  for (const int cell : surfaces.known_cells(worker)) {
    if (!surfaces.is(cell, whose)) continue;
    const CellRange& range = surfaces.cells[cell];
    const Nodes nodes = surfaces.nodes(cell);
    double *const x = &normal_[0][range.first], *const y = &normal_[1][range.first],
                  *const z = &normal_[2][range.first];
    double* const area = &area_[range.first];
    for (double* of : {x, y, z, area}) std::fill_n(of, range.count, 0.0);
    for (const auto& [a, b, c] : surfaces.type_of(cell).mesh.triangles()) {
      const Vec<3> normal = (nodes[b] - nodes[a]).cross(nodes[c] - nodes[a]);
      const double sixth = normal.norm() / 6;
      for (const int k : {a, b, c}) x[k] += normal.x(), y[k] += normal.y(), z[k] += normal.z(), area[k] += sixth;
    }
    const double shift = constants(surfaces, cell).shift;
    for (int i = 0; i < range.count; ++i) {
      const double length = std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
      const double inverse = length > 0 ? 1 / length : 0;  // a fold without width has no direction
      x[i] *= inverse, y[i] *= inverse, z[i] *= inverse;
      touch_[0][range.first + i] = nodes.x[i] - shift * x[i];
      touch_[1][range.first + i] = nodes.y[i] - shift * y[i];
      touch_[2][range.first + i] = nodes.z[i] - shift * z[i];
    }
  }
}

void SurfaceSlip::find_areas(const Surfaces& surfaces, int cell, Scratch& scratch) const {
  const Nodes nodes = surfaces.nodes(cell);
  scratch.area.clear();
  for (const auto& [a, b, c] : surfaces.type_of(cell).mesh.triangles())
    scratch.area.push_back((nodes[b] - nodes[a]).cross(nodes[c] - nodes[a]).norm() / 2);
}

void SurfaceSlip::find_gradients(const Surfaces& surfaces, int cell, Scratch& scratch) const {
  const CellRange& range = surfaces.cells[cell];
  const Nodes nodes{&touch_[0].data()[range.first], &touch_[1].data()[range.first], &touch_[2].data()[range.first]};
  const auto& triangles = surfaces.type_of(cell).mesh.triangles();
  scratch.gradient.clear();
  scratch.turned.assign(range.count, Eigen::Matrix3d::Zero());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    const Vec<3> normal = (nodes[b] - nodes[a]).cross(nodes[c] - nodes[a]);
    const double square = normal.squaredNorm(), inverse = square > 0 ? 1 / square : 0;
    scratch.gradient.push_back({inverse * normal.cross(nodes[c] - nodes[b]),
                                inverse * normal.cross(nodes[a] - nodes[c]),
                                inverse * normal.cross(nodes[b] - nodes[a])});
    // The projection on the triangle, as far as gradients reproduce it.
    const Eigen::Matrix3d along = Eigen::Matrix3d::Identity() - inverse * normal * normal.transpose();
    for (const int k : {a, b, c}) scratch.turned[k] += scratch.area[t] / 3 * along;
  }
  // R with P M R = P, M the mean projection of the triangles around a node: then couples have no torque.
  for (int i = 0; i < range.count; ++i) {
    const Vec<3> n = normal(range.first + i);
    const Eigen::Matrix3d p = Eigen::Matrix3d::Identity() - n * n.transpose();
    const Eigen::Matrix3d m = p * scratch.turned[i] * p / area_[range.first + i] + n * n.transpose();
    scratch.turned[i] = m.determinant() > 0.01 ? Eigen::Matrix3d(p * m.inverse() * p) : p;
  }
}

void SurfaceSlip::add_couples(const Surfaces& surfaces, int cell, Scratch& scratch) {
  const CellRange& range = surfaces.cells[cell];
  const double shift = constants(surfaces, cell).shift;
  find_gradients(surfaces, cell, scratch);
  scratch.value.clear();
  for (int i = range.first; i < range.end(); ++i) {
    const Vec<3> force(surfaces.force_x[i], surfaces.force_y[i], surfaces.force_z[i]);
    scratch.value.emplace_back(scratch.turned[i - range.first] * (force - force.dot(normal(i)) * normal(i)));
  }
  const auto& triangles = surfaces.type_of(cell).mesh.triangles();
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Vec<3> on[3] = {Vec<3>::Zero(), Vec<3>::Zero(), Vec<3>::Zero()};
    for (const int local : triangles[t]) {
      const int i = range.first + local;
      const Vec<3> n = normal(i), force(surfaces.force_x[i], surfaces.force_y[i], surfaces.force_z[i]);
      const double share = -shift * scratch.area[t] / (3 * area_[i]);
      for (int k = 0; k < 3; ++k) {
        const Vec<3>& g = scratch.gradient[t][k];
        on[k] += share * (force.dot(n) * g + scratch.value[local].dot(g) * n);
      }
    }
    for (int k = 0; k < 3; ++k) {
      const int i = range.first + triangles[t][k];
      for (int c = 0; c < 3; ++c) force_[c][i] += on[k][c];
    }
  }
}

void SurfaceSlip::find_slip(const Surfaces& surfaces, int cell, Scratch& scratch) {
  const CellRange& range = surfaces.cells[cell];
  const double mobility = constants(surfaces, cell).slip / viscosity_;
  scratch.value.clear();
  for (int i = range.first; i < range.end(); ++i) {
    const Vec<3> n = normal(i), force(surfaces.force_x[i], surfaces.force_y[i], surfaces.force_z[i]);
    const double by_area = area_[i] > 0 ? mobility / area_[i] : 0;
    scratch.value.emplace_back(by_area * (force - force.dot(n) * n));
  }
  // (A^-1 M)^p, M the mass matrix of hat functions and A its row sums: symmetric over areas, so that slip never gives energy.
  const auto& triangles = surfaces.type_of(cell).mesh.triangles();
  for (int pass = 0; pass < smoothings_[surfaces.cells[cell].type]; ++pass) {
    scratch.other.assign(range.count, Vec<3>::Zero());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto& [a, b, c] = triangles[t];
      const double share = scratch.area[t] / 12;
      const Vec<3> all = scratch.value[a] + scratch.value[b] + scratch.value[c];
      for (const int k : {a, b, c}) scratch.other[k] += share * (all + scratch.value[k]);
    }
    for (int i = 0; i < range.count; ++i) scratch.value[i] = scratch.other[i] / area_[range.first + i];
  }
  for (int i = range.first; i < range.end(); ++i) {
    const Vec<3> n = normal(i), slip = scratch.value[i - range.first];
    const Vec<3> along = slip - slip.dot(n) * n;
    for (int c = 0; c < 3; ++c) slip_[c][i] = along[c];
  }
}

void SurfaceSlip::complete(Worker worker, const Surfaces& surfaces) {
  Scratch scratch;
  for (const int cell : surfaces.own_cells(worker)) {
    const CellRange& range = surfaces.cells[cell];
    find_areas(surfaces, cell, scratch);
    std::copy_n(&surfaces.force_x[range.first], range.count, &force_[0][range.first]);
    std::copy_n(&surfaces.force_y[range.first], range.count, &force_[1][range.first]);
    std::copy_n(&surfaces.force_z[range.first], range.count, &force_[2][range.first]);
    if (constants(surfaces, cell).shift != 0) add_couples(surfaces, cell, scratch);
    find_slip(surfaces, cell, scratch);
  }
}

void SurfaceSlip::correct(Worker worker, Surfaces& surfaces) {
  Scratch scratch;
  for (const int cell : surfaces.own_cells(worker)) {
    const CellRange& range = surfaces.cells[cell];
    const double shift = constants(surfaces, cell).shift;
    if (shift != 0) {
      find_areas(surfaces, cell, scratch);
      find_gradients(surfaces, cell, scratch);
      const auto& triangles = surfaces.type_of(cell).mesh.triangles();
      scratch.value.assign(range.count, Vec<3>::Zero());
      scratch.other.assign(range.count, Vec<3>::Zero());  // (grad_s u).n over areas; of div_s u, along n
      for (std::size_t t = 0; t < triangles.size(); ++t) {
        Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
        for (int k = 0; k < 3; ++k) {
          const int i = range.first + triangles[t][k];
          gradient += scratch.gradient[t][k] *
                      Vec<3>(surfaces.velocity_x[i], surfaces.velocity_y[i], surfaces.velocity_z[i]).transpose();
        }
        for (const int local : triangles[t]) {
          const double share = scratch.area[t] / (3 * area_[range.first + local]);
          const Vec<3> n = normal(range.first + local);
          scratch.value[local] += share * (gradient * n);
          scratch.other[local] += share * gradient.trace() * n;
        }
      }
      for (int i = range.first; i < range.end(); ++i) {
        const int local = i - range.first;
        const Vec<3> turn = shift * (scratch.turned[local] * scratch.value[local] + scratch.other[local]);
        surfaces.velocity_x[i] -= turn.x();
        surfaces.velocity_y[i] -= turn.y();
        surfaces.velocity_z[i] -= turn.z();
      }
    }
    for (int i = range.first; i < range.end(); ++i) {
      surfaces.velocity_x[i] += slip_[0][i];
      surfaces.velocity_y[i] += slip_[1][i];
      surfaces.velocity_z[i] += slip_[2][i];
    }
  }
}

}  // namespace rouleau::core
