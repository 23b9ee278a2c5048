#include "volume_correction.hpp"

#include <algorithm>

#include "core/membrane/area_correction.hpp"

namespace rouleau::core {

VolumeCorrection::VolumeCorrection(const Surfaces& surfaces)
    : along_x_(surfaces.x.size()), along_y_(surfaces.x.size()), along_z_(surfaces.x.size()) {}

void VolumeCorrection::find_gradient(const Surfaces& surfaces, int cell) {
  const CellRange& range = surfaces.cells[cell];
  const Nodes nodes = surfaces.nodes(cell);
  double *const x = &along_x_[range.first], *const y = &along_y_[range.first], *const z = &along_z_[range.first];
  for (double* along : {x, y, z}) std::fill_n(along, range.count, 0.0);
  // A corner's share in the gradient is a third of the triangle along its normal: the rest cancels around the node.
  for (const auto& [a, b, c] : surfaces.type_of(cell).mesh.triangles()) {
    const Vec<3> third = (nodes[b] - nodes[a]).cross(nodes[c] - nodes[a]) / 6;
    for (const int corner : {a, b, c}) x[corner] += third.x(), y[corner] += third.y(), z[corner] += third.z();
  }
}

void VolumeCorrection::take_out_pressures(Worker worker, Surfaces& surfaces) {
  for (const int cell : surfaces.own_cells(worker)) {
    const CellRange& range = surfaces.cells[cell];
    find_gradient(surfaces, cell);
    double work = 0, square = 0;
    for (int i = range.first; i < range.end(); ++i) {
      square += along_x_[i] * along_x_[i] + along_y_[i] * along_y_[i] + along_z_[i] * along_z_[i];
      work += surfaces.force_x[i] * along_x_[i] + surfaces.force_y[i] * along_y_[i] + surfaces.force_z[i] * along_z_[i];
    }
    const double pressure = square > 0 ? work / square : 0;
    for (int i = range.first; i < range.end(); ++i) {
      surfaces.force_x[i] -= pressure * along_x_[i];
      surfaces.force_y[i] -= pressure * along_y_[i];
      surfaces.force_z[i] -= pressure * along_z_[i];
    }
  }
}

void VolumeCorrection::keep_volumes(Worker worker, Surfaces& surfaces) {
  for (const int cell : surfaces.own_cells(worker)) {
    const CellRange& range = surfaces.cells[cell];
    const RestSurface& rest = surfaces.type_of(cell);
    const double x = surfaces.x[range.first], y = surfaces.y[range.first], z = surfaces.z[range.first];
    double gain = 0, thrice = 0;  // of volume in this step without the correction; three volumes, for A.X is as much
    double square = 0;
    for (int i = range.first; i < range.end(); ++i) {
      square += along_x_[i] * along_x_[i] + along_y_[i] * along_y_[i] + along_z_[i] * along_z_[i];
      gain += surfaces.velocity_x[i] * along_x_[i] + surfaces.velocity_y[i] * along_y_[i] +
              surfaces.velocity_z[i] * along_z_[i];
      thrice +=
          (surfaces.x[i] - x) * along_x_[i] + (surfaces.y[i] - y) * along_y_[i] + (surfaces.z[i] - z) * along_z_[i];
    }
    const double factor = square > 0 ? ((rest.rest_volume - thrice / 3) / area_relaxation_steps - gain) / square : 0;
    for (int i = range.first; i < range.end(); ++i) {
      surfaces.velocity_x[i] += factor * along_x_[i];
      surfaces.velocity_y[i] += factor * along_y_[i];
      surfaces.velocity_z[i] += factor * along_z_[i];
    }
    surfaces.area_leakage[cell] -= gain / rest.rest_volume;
  }
}

}  // namespace rouleau::core
