#include "mesh_polynomial.hpp"

#include <rouleau/pack.hpp>
#include <utility>

#include "core/domain/run_loop.hpp"

namespace rouleau::core {

namespace {

using Four = Pack<double, 4>;

struct Degree {
  NeighbourMatrix matrix;
  const double *value, *now;
  double* former;
  double coefficient, factor;
};

// Nodes around one in a mesh of regular triangles. Their sum is written out, in two parts, since each waits for its
// last term.
constexpr int regular = 6;

/// Row i of the product of a matrix and vectors.
ROULEAU_ALWAYS_INLINE Four product(const NeighbourMatrix& matrix, const double* vectors, int i) {
  const int first = matrix.first[i], count = matrix.first[i + 1] - first;
  const double* const weight = matrix.weight + first;
  const int* const neighbour = matrix.neighbour + first;
  const auto times = [](double number, const double* vector) {
    return Four(Four::Vector{number, number, number, number}) * Four::load(vector);
  };
  const auto term = [&](int k) { return times(weight[k], vectors + 4 * static_cast<std::size_t>(neighbour[k])); };
  Four one = times(matrix.own[i], vectors + 4 * static_cast<std::size_t>(i));
  if (count != regular) {
    for (int k = 0; k < count; ++k) one += term(k);
    return one;
  }
  Four two = term(0);
  one += term(1), two += term(2), one += term(3), two += term(4), one += term(5);
  return one + two;
}

/// b_k = c_k value + 2 B b_k+1 - b_k+2, written over b_k+2, which of the first that is found so is zero. The last has 1
/// for 2.
template <bool first>
struct NextDegree {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const Degree* degree) {
    const Degree d = *degree;
    for (int i = 0; i < d.matrix.nodes; ++i) {
      Four next = d.coefficient * Four::load(d.value + 4 * i) + d.factor * product(d.matrix, d.now, i);
      if constexpr (!first) next -= Four::load(d.former + 4 * i);
      next.store(d.former + 4 * i);
    }
  }
};

}  // namespace

const double* apply_polynomial(const NeighbourMatrix& matrix, std::span<const double> coefficients,
                               PolynomialRoom& room) {
  double *now = room.one.data(), *former = room.other.data();
  const std::size_t highest = coefficients.size() - 1, count = 4 * static_cast<std::size_t>(matrix.nodes);
  for (std::size_t i = 0; i < count; ++i) now[i] = coefficients[highest] * room.value[i];
  for (std::size_t k = highest; k-- > 0;) {
    const Degree degree{matrix, room.value.data(), now, former, coefficients[k], k == 0 ? 1.0 : 2.0};
    k + 1 == highest ? run_loop<NextDegree<true>>(degree) : run_loop<NextDegree<false>>(degree);
    std::swap(now, former);
  }
  return now;
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
