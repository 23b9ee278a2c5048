#include "compiled_in.hpp"

#include <array>
#include <stdexcept>

#include "lattice_setup.hpp"

namespace rouleau::core {

namespace {

template <class Table>
Model<Table> instance(const rouleau_model& model, const Table* table, rouleau_setup setup, const Facts& facts) {
  if (table == nullptr) throw std::invalid_argument(std::string("\"") + model.id + "\" is a model of another kind");
  std::vector<const char*> names;
  std::vector<double> values;
  for (const auto& [name, value] : facts.parameters) {
    names.push_back(name.c_str());
    values.push_back(value);
  }
  setup.parameter_count = static_cast<std::uint32_t>(values.size());
  setup.parameter_names = names.data();
  setup.parameter_values = values.data();
  std::array<char, 1024> message{};
  void* self = nullptr;
  if (model.create(&setup, &self, message.data(), message.size()) != 0) {
    message.back() = '\0';
    throw std::invalid_argument(std::string("\"") + model.id + "\" could not be made: " + message.data());
  }
  return {.id = model.id,
          .table = table,
          .self = std::shared_ptr<const void>(self, [destroy = model.destroy](void* made) { destroy(made); }),
          .needs = facts.needs,
          .gives = facts.gives,
          .state = facts.state};
}

}  // namespace

CollisionOperator collision_operator(const rouleau_model& model, double tau, const Facts& facts, bool inertia,
                                     int dimension) {
  return instance(model, model.collision, lattice_setup(dimension, 1 / tau, inertia), facts);
}

MembraneLaw membrane_law(const rouleau_model& model, const Facts& facts, int dimension) {
  return instance(model, model.membrane, lattice_setup(dimension, 1, false), facts);
}

Potential potential(const rouleau_model& model, const Facts& facts) {
  return instance(model, model.interaction, lattice_setup(2, 1, false), facts);
}

}  // namespace rouleau::core
