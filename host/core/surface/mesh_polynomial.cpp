#include "mesh_polynomial.hpp"

#include <rouleau/pack.hpp>
#include <utility>

#include "core/domain/run_loop.hpp"

namespace rouleau::core {

namespace {

struct Degree {
  NeighbourMatrix matrix;
  const double* now;
  double *former, *result;
  double coefficient;
};

/// T_k+1 = 2 B T_k - T_k-1, written over T_k-1, or, of the first degree, B T_0; and its share in the result.
template <bool first>
struct NextDegree {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const Degree* degree) {
    using Four = Pack<double, 4>;
    const Degree d = *degree;
    const NeighbourMatrix& b = d.matrix;
    for (int i = 0; i < b.nodes; ++i) {
      Four next = Four::broadcast(b.own + i) * Four::load(d.now + 4 * i);
      for (int k = b.first[i]; k < b.first[i + 1]; ++k)
        next += Four::broadcast(b.weight + k) * Four::load(d.now + 4 * b.neighbour[k]);
      if constexpr (!first) next = 2.0 * next - Four::load(d.former + 4 * i);
      next.store(d.former + 4 * i);
      (Four::load(d.result + 4 * i) + d.coefficient * next).store(d.result + 4 * i);
    }
  }
};

}  // namespace

void apply_polynomial(const NeighbourMatrix& matrix, std::span<const double> coefficients, PolynomialRoom& room) {
  const std::size_t count = 4 * static_cast<std::size_t>(matrix.nodes);
  for (std::size_t i = 0; i < count; ++i) room.result[i] = coefficients[0] * room.value[i];
  double *now = room.value.data(), *former = room.other.data();
  for (std::size_t k = 1; k < coefficients.size(); ++k) {
    const Degree degree{matrix, now, former, room.result.data(), coefficients[k]};
    k == 1 ? run_loop<NextDegree<true>>(degree) : run_loop<NextDegree<false>>(degree);
    std::swap(now, former);
  }
}

Mesh::Rings neighbours_of(const Mesh& mesh) {
  Mesh::Rings rings = mesh.node_edges();
  for (int i = 0; i < mesh.node_count(); ++i) {
    for (int k = rings.first[i]; k < rings.first[i + 1]; ++k) {
      const Mesh::Edge& edge = mesh.edges()[rings.entry[k]];
      rings.entry[k] = edge.a == i ? edge.b : edge.a;
    }
  }
  return rings;
}

}  // namespace rouleau::core
