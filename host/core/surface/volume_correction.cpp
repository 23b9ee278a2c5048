#include "volume_correction.hpp"

#include <cmath>

#include "core/membrane/area_correction.hpp"

namespace rouleau::core {

void take_out_pressures(Worker worker, Surfaces& surfaces, const SurfaceNormals& normals) {
  const auto [x, y, z] = normals.sums();
  for (const int cell : surfaces.own_cells(worker)) {
    const CellRange& range = surfaces.cells[cell];
    double work = 0, square = 0;
    for (int i = range.first; i < range.end(); ++i) {
      square += x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
      work += surfaces.force[0][i] * x[i] + surfaces.force[1][i] * y[i] + surfaces.force[2][i] * z[i];
    }
    const double pressure = square > 0 ? work / square : 0;
    for (int i = range.first; i < range.end(); ++i) {
      surfaces.force[0][i] -= pressure * x[i];
      surfaces.force[1][i] -= pressure * y[i];
      surfaces.force[2][i] -= pressure * z[i];
    }
  }
}

void keep_enclosed(Worker worker, Surfaces& surfaces, const SurfaceNormals& normals, double strain) {
  const auto [x, y, z] = normals.sums();
  const double kept = std::exp(-strain);
  for (const int cell : surfaces.own_cells(worker)) {
    const CellRange& range = surfaces.cells[cell];
    const RestSurface& rest = surfaces.type_of(cell);
    const Vec<3> origin = surfaces.nodes(cell)[0];
    double gain = 0, volume = 0, square = 0;  // gain: of volume in this step without the correction
    for (int i = range.first; i < range.end(); ++i) {
      square += x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
      gain += surfaces.velocity[0][i] * x[i] + surfaces.velocity[1][i] * y[i] + surfaces.velocity[2][i] * z[i];
      volume += (surfaces.position[0][i] - origin.x()) * x[i] + (surfaces.position[1][i] - origin.y()) * y[i] +
                (surfaces.position[2][i] - origin.z()) * z[i];
    }
    gain /= 6, volume /= 18;  // A.X is three volumes
    const double wanted = (rest.rest_volume - volume) / area_relaxation_steps;
    const double factor = square > 0 ? 6 * (wanted - gain) / square : 0;
    for (int i = range.first; i < range.end(); ++i) {
      surfaces.velocity[0][i] += factor * x[i];
      surfaces.velocity[1][i] += factor * y[i];
      surfaces.velocity[2][i] += factor * z[i];
    }
    surfaces.area_leakage[cell] = kept * surfaces.area_leakage[cell] - gain / rest.rest_volume;
  }
}

}  // namespace rouleau::core
