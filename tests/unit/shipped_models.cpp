#include "unit/shipped_models.hpp"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/model/compiled_in.hpp"

using Open = const rouleau_plugin*(std::uint32_t host_minor);
extern "C" Open SHIPPED_MODELS;  // open_area, open_bending, ...: what the sources call rouleau_open_v1

namespace rouleau::test {

namespace {

const rouleau_model& find(const std::string& id) {
  for (Open* const open : {SHIPPED_MODELS}) {
    for (const rouleau_model* const* model = open(ROULEAU_ABI_MINOR)->models; *model != nullptr; ++model) {
      if ((*model)->id == id) return **model;
    }
  }
  throw std::invalid_argument("no model \"" + id + "\" is shipped");
}

/// What the manifest beside a model's source says of it.
core::Facts facts(const std::string& id, const std::vector<double>& values, int dimension) {
  nlohmann::json manifest;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SHIPPED_SOURCES)) {
    if (entry.path().filename() == id + ".json") std::ifstream(entry.path()) >> manifest;
  }
  const nlohmann::json none = nlohmann::json::array(), parameters = manifest.value("parameters", none);
  if (parameters.size() != values.size()) throw std::invalid_argument("\"" + id + "\" has other parameters");
  const nlohmann::json& one = dimension == 3 && manifest.contains("in_3d") ? manifest["in_3d"] : manifest;
  core::Facts found;
  for (std::size_t k = 0; k < values.size(); ++k)
    found.parameters.emplace_back(parameters[k]["name"].get<std::string>(), values[k]);
  found.needs = one.value("needs", std::vector<std::string>());
  found.gives = one.value("gives", std::vector<std::string>());
  for (const nlohmann::json& state : manifest.value("state", none))
    found.state.push_back({state["name"].get<std::string>(), state["initial"].get<double>(), 1});
  return found;
}

}  // namespace

core::MembraneLaw law(const std::string& id, const std::vector<double>& values) {
  return core::membrane_law(find(id), facts(id, values, 2));
}
core::MembraneLaw surface_law(const std::string& id, const std::vector<double>& values) {
  return core::membrane_law(find(id), facts(id, values, 3), 3);
}
core::Potential potential(const std::string& id, const std::vector<double>& values) {
  return core::potential(find(id), facts(id, values, 2));
}
core::CollisionOperator shipped_collision(const std::string& id, const std::vector<double>& values, double tau,
                                          bool inertia, int dimension) {
  return core::collision_operator(find(id), tau, facts(id, values, dimension), inertia, dimension);
}

}  // namespace rouleau::test
