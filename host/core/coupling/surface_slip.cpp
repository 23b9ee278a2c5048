#include "surface_slip.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/domain/run_loop.hpp"

namespace rouleau::core {

namespace {

template <std::size_t n>
std::array<const double*, n> to_read(double* const (&arrays)[n]) {
  std::array<const double*, n> pointers;
  std::copy_n(arrays, n, pointers.begin());
  return pointers;
}

}  // namespace

// Slip is smoothed by B = 1 - s/3 (surface_slip_smoothing): M, the mass matrix of hat functions, over A, its row sums,
// is 1 - s/8. That is symmetric over areas, and its polynomial is not negative, so that slip never gives energy: a sum
// over k from 0 to n - 1 of (n - k) (2 - [k = 0]) T_k/n^2.
SurfaceSlip::Shared::Shared(const Mesh& of, int order)
    : mesh(of), neighbours(neighbours_of(of)), own(static_cast<std::size_t>(of.node_count()), -1.0 / 3) {
  for (const int edge : of.node_edges().entry) {
    left.push_back(of.edges()[edge].left);
    right.push_back(of.edges()[edge].right);
  }
  for (int k = 0; k < order; ++k) coefficients.push_back((k == 0 ? 1.0 : 2.0) * (order - k) / order / order);
}

SurfaceSlip::SurfaceSlip(const Surfaces& surfaces, std::vector<Type> types, double viscosity)
    : types_(std::move(types)), viscosity_(viscosity), scratch_(surfaces.cells.size()) {
  for (std::size_t t = 0; t < types_.size(); ++t) {
    const RestSurface& rest = *surfaces.types[t];
    // Of equal triangles with sides l: sqrt(3)/4 l^2 each.
    const double square = rest.rest_surface_area / rest.mesh.triangle_count() * 4 / std::sqrt(3.0);
    shared_.emplace_back(rest.mesh, surface_slip_smoothing(square, types_[t].constants.slip / viscosity,
                                                           types_[t].stretching_stiffness));
  }
  const auto make = [&](auto& arrays) {
    for (auto& values : arrays) values = PagedArray<double>(surfaces.position[0].size());
  };
  make(normal_), make(touch_), make(force_), make(slip_), make(turn_);
}

void SurfaceSlip::forget(std::span<const Range> nodes) {
  const auto release_all = [&](auto& arrays) {
    for (auto& values : arrays) release(values, nodes);
  };
  release_all(normal_), release_all(touch_), release_all(force_), release_all(slip_), release_all(turn_);
}

SurfaceSlip::Scratch& SurfaceSlip::scratch_of(int first_cell) {
  Scratch& scratch = scratch_.of(first_cell);
  if (!scratch.pressure.empty()) return scratch;
  std::size_t triangles = 0, nodes = 0, neighbours = 0;
  for (const Shared& type : shared_) {
    triangles = std::max(triangles, static_cast<std::size_t>(type.mesh.size));
    nodes = std::max(nodes, type.own.size());
    neighbours = std::max(neighbours, type.left.size());
  }
  const auto make = [](auto& arrays, std::size_t size) {
    for (auto& values : arrays) values.assign(size, 0.0);
  };
  make(scratch.gradient[0], triangles), make(scratch.gradient[1], triangles), make(scratch.covered_triangle, triangles);
  make(scratch.result, 3 * triangles);
  make(scratch.covered, nodes), make(scratch.turned, nodes), make(scratch.along, nodes);
  scratch.pressure.assign(nodes, 0.0);
  scratch.weight.assign(neighbours, 0.0);
  scratch.smoothing.resize(nodes);
  return scratch;
}

SlipArrays SurfaceSlip::arrays_of(const Surfaces& surfaces, int cell, const SurfaceNormals& normals, Scratch& scratch) {
  const CellRange& range = surfaces.cells[cell];
  const PaddedTriangles& mesh = shared_[range.type].mesh;
  const auto first = static_cast<std::size_t>(range.first);
  SlipArrays arrays{};
  arrays.triangles = mesh.count, arrays.nodes = range.count;
  arrays.shift = constants(surfaces, cell).shift;
  point_into(arrays.corner, mesh.corner);
  point_into(arrays.touch, touch_, first), point_into(arrays.normal, normal_, first),
      point_into(arrays.turn, turn_, first);
  for (std::size_t k = 0; k < 3; ++k) arrays.normal_sum[k] = normals.sums()[k] + first;
  arrays.area = normals.node_areas() + first;
  arrays.place[0] = &surfaces.position[0][first], arrays.place[1] = &surfaces.position[1][first],
  arrays.place[2] = &surfaces.position[2][first];
  arrays.force[0] = &surfaces.force[0][first], arrays.force[1] = &surfaces.force[1][first];
  arrays.force[2] = &surfaces.force[2][first];
  point_into(arrays.covered, scratch.covered), point_into(arrays.along, scratch.along);
  point_into(arrays.turned, scratch.turned);
  arrays.pressure = scratch.pressure.data();
  arrays.triangle_area = normals.triangle_areas(cell);
  for (std::size_t k = 0; k < 2; ++k) point_into(arrays.gradient[k], scratch.gradient[k]);
  point_into(arrays.covered_triangle, scratch.covered_triangle);
  for (std::size_t k = 0; k < 3; ++k)
    point_into(arrays.result[k], scratch.result, k * static_cast<std::size_t>(mesh.size));
  return arrays;
}

void SurfaceSlip::measure(Worker worker, const Surfaces& surfaces, const SurfaceNormals& normals, Whose whose) {
  const CellNumbers cells = surfaces.known_cells(worker);
  if (cells.empty()) return;
  Scratch& scratch = scratch_of(cells.first_place());
  for (const int cell : cells) {
    if (!surfaces.is(cell, whose)) continue;
    run_loop<FindTouch>(arrays_of(surfaces, cell, normals, scratch));
  }
}

void SurfaceSlip::complete(Worker worker, const Surfaces& surfaces, const SurfaceNormals& normals) {
  const CellNumbers cells = surfaces.own_cells(worker);
  if (cells.empty()) return;
  Scratch& scratch = scratch_of(cells.first_place());
  for (const int cell : cells) {
    const SlipArrays arrays = arrays_of(surfaces, cell, normals, scratch);
    if (arrays.shift != 0) {
      add_couples(cell, surfaces, arrays);
    } else {
      run_loop<ForcesAlong>(arrays);
      for (int k = 0; k < 3; ++k) std::copy_n(arrays.force[k], arrays.nodes, &force_[k][surfaces.cells[cell].first]);
    }
    find_slip(cell, surfaces, arrays, scratch);
  }
}

void SurfaceSlip::add_couples(int cell, const Surfaces& surfaces, const SlipArrays& arrays) {
  const CellRange& range = surfaces.cells[cell];
  const PaddedTriangles& mesh = shared_[range.type].mesh;
  run_loop<MeasureTouch>(arrays);
  const auto covered = to_read(arrays.covered_triangle);
  for (int i = 0; i < range.count; ++i) {
    const auto sum = mesh.sums_of_triangles(covered, i);
    for (std::size_t c = 0; c < sum.size(); ++c) arrays.covered[c][i] = sum[c];
  }
  run_loop<TurnForces>(arrays);
  run_loop<MakeCouples>(arrays);
  const auto couples = to_read(arrays.result[0]);
  for (int i = 0; i < range.count; ++i) {
    const auto sum = mesh.sums_of_corners(couples, i);
    for (std::size_t c = 0; c < 3; ++c) force_[c][range.first + i] = arrays.force[c][i] + sum[c];
  }
}

void SurfaceSlip::find_slip(int cell, const Surfaces& surfaces, const SlipArrays& arrays, Scratch& scratch) {
  const CellRange& range = surfaces.cells[cell];
  const Shared& shared = shared_[range.type];
  const double mobility = constants(surfaces, cell).slip / viscosity_;
  const std::vector<int>& first = shared.neighbours.first;
  const bool smooths = shared.coefficients.size() > 1;
  for (int i = 0; i < range.count; ++i) {
    for (int c = 0; c < 3; ++c) scratch.smoothing.value[4 * i + c] = mobility * scratch.along[c][i];
    const double by_area = arrays.area[i] > 0 ? 2.0 / 9 / arrays.area[i] : 0;
    for (int k = first[i]; k < first[i + 1] && smooths; ++k)
      scratch.weight[k] = by_area * (arrays.triangle_area[shared.left[k]] + arrays.triangle_area[shared.right[k]]);
  }
  const double* const smoothed = apply_polynomial(
      {range.count, first.data(), shared.neighbours.entry.data(), shared.own.data(), scratch.weight.data()},
      shared.coefficients, scratch.smoothing);
  for (int i = 0; i < range.count; ++i) {
    const Vec<3> n(normal_[0][range.first + i], normal_[1][range.first + i], normal_[2][range.first + i]);
    const Eigen::Map<const Vec<3>> slip(smoothed + 4 * i);
    const Vec<3> along = slip - slip.dot(n) * n;
    for (int c = 0; c < 3; ++c) slip_[c][range.first + i] = along[c];
  }
}

void SurfaceSlip::correct(Worker worker, Surfaces& surfaces, const SurfaceNormals& normals) {
  const CellNumbers cells = surfaces.own_cells(worker);
  if (cells.empty()) return;
  Scratch& scratch = scratch_of(cells.first_place());
  for (const int cell : cells) {
    const CellRange& range = surfaces.cells[cell];
    if (SlipArrays arrays = arrays_of(surfaces, cell, normals, scratch); arrays.shift != 0) {
      arrays.velocity[0] = &surfaces.velocity[0][range.first], arrays.velocity[1] = &surfaces.velocity[1][range.first];
      arrays.velocity[2] = &surfaces.velocity[2][range.first];
      run_loop<MakeTurns>(arrays);
      const auto turns = to_read(arrays.result[0]);
      const PaddedTriangles& mesh = shared_[range.type].mesh;
      for (int i = 0; i < range.count; ++i) {
        const auto [x, y, z] = mesh.sums_of_corners(turns, i);
        scratch.turned[0][i] = x, scratch.turned[1][i] = y, scratch.turned[2][i] = z;
      }
      run_loop<TurnVelocities>(arrays);
    }
    for (int i = range.first; i < range.end(); ++i) {
      surfaces.velocity[0][i] += slip_[0][i];
      surfaces.velocity[1][i] += slip_[1][i];
      surfaces.velocity[2][i] += slip_[2][i];
    }
  }
}

}  // namespace rouleau::core
