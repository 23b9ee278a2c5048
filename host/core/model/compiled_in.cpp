#include "compiled_in.hpp"

#include <array>
#include <rouleau/d2q9.hpp>
#include <rouleau/d3q19.hpp>
#include <stdexcept>

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

template <class Set>
void describe(rouleau_setup& setup) {
  static const auto velocities = [] {
    std::array<double, std::size_t{Set::velocity_count} * Set::dimension> flat{};
    for (int q = 0; q < Set::velocity_count; ++q)
      for (int k = 0; k < Set::dimension; ++k) flat[Set::dimension * q + k] = Set::velocity[q][k];
    return flat;
  }();
  setup.dimension = Set::dimension;
  setup.velocity_count = Set::velocity_count;
  setup.velocities = velocities.data();
  setup.weights = Set::weight;
}

}  // namespace

rouleau_setup lattice_setup(int dimension, double relaxation_rate, bool inertia) {
  rouleau_setup setup{};
  setup.struct_size = sizeof setup;
  setup.host_minor = ROULEAU_ABI_MINOR;
  setup.length_unit = setup.time_unit = setup.mass_unit = 1;
  if (dimension == 2)
    describe<D2Q9>(setup);
  else
    describe<D3Q19>(setup);
  setup.sound_speed_squared = d2q9::sound_speed_squared;
  setup.relaxation_rate = relaxation_rate;
  setup.inertia = inertia ? 1 : 0;
  return setup;
}

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
