#include "operators.hpp"

#include <stdexcept>

#include "unit/sdk/operators/source.hpp"

namespace rouleau::test {

namespace {

const OperatorSource& source(const std::string& id) {
  static const OperatorSource sources[] = {bgk(), trt(), mrt(), regularised(), central_moment()};
  for (const OperatorSource& candidate : sources) {
    if (id == candidate.id) return candidate;
  }
  throw std::invalid_argument("no operator " + id);
}

}  // namespace

const rouleau_model& collision_model(const std::string& id) { return *source(id).open(0)->models[0]; }
NamedValues parameters_of(const std::string& id) { return source(id).parameters; }

Operator make_operator(const std::string& id, const std::string& set, double relaxation_rate, bool inertia,
                       const NamedValues& parameters) {
  return source(id).with_loops(make(collision_model(id), {parameters, relaxation_rate, inertia}), id, set, inertia);
}

}  // namespace rouleau::test
