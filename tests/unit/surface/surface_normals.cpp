// Normals of nodes and areas of triangles: the gradient of the volume, the areas that the mesh has, and any workers.
#include "core/surface/surface_normals.hpp"

#include "fixture.hpp"
#include "unit/random.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

TEST_CASE("the normals around a node add up to six times the gradient of the volume") {
  auto random = generator(95);
  Surfaces s = cells_out_of_shape(random);
  const SurfaceNormals normals = normals_of(s);
  constexpr double little = 1e-2;  // the volume is linear in each coordinate
  for (int cell = 0; cell < s.cell_count(); ++cell) {
    const auto volume = [&] { return enclosed_volume(s.type_of(cell).mesh, s.nodes(cell)); };
    for (const int i : {s.cells[cell].first, s.cells[cell].first + 7, s.cells[cell].end() - 1}) {
      auto& places = s.position;
      for (std::size_t k = 0; k < 3; ++k) {
        double& place = places[k][i];
        const double before = place;
        place = before + little;
        const double more = volume();
        place = before - little;
        const double less = volume();
        place = before;
        CHECK(normals.sums()[k][i] == Approx(6 * (more - less) / (2 * little)).epsilon(1e-7).margin(1e-7));
      }
    }
  }
}

TEST_CASE("areas of triangles and nodes are those of the mesh, and no node's depend on the workers") {
  auto random = generator(96);
  const Surfaces s = cells_out_of_shape(random);
  const SurfaceNormals normals = normals_of(s);
  SurfaceNormals shared(s);
  for (int worker = 0; worker < 3; ++worker) shared.measure({worker, 3}, s);
  for (int cell = 0; cell < s.cell_count(); ++cell) {
    const std::vector<Vec<3>> vectors = area_vectors(s.type_of(cell).mesh, s.nodes(cell));
    double surface = 0;
    for (std::size_t t = 0; t < vectors.size(); ++t) {
      CHECK(normals.triangle_areas(cell)[t] == Approx(vectors[t].norm() / 2).epsilon(1e-14));
      surface += vectors[t].norm() / 2;
    }
    double of_nodes = 0;
    for (int i = s.cells[cell].first; i < s.cells[cell].end(); ++i) {
      of_nodes += normals.node_areas()[i];
      CHECK(shared.node_areas()[i] == normals.node_areas()[i]);
      for (std::size_t k = 0; k < 3; ++k) CHECK(shared.sums()[k][i] == normals.sums()[k][i]);
    }
    CHECK(of_nodes == Approx(surface).epsilon(1e-13));
  }
}
