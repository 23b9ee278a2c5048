#include "table_checks.hpp"

#include <vector>

#include "base/synonyms.hpp"
#include "base/text.hpp"

namespace rouleau::plugin {

namespace {

// Sizes of the structs in interface 1.0: what every plugin must have, however many fields are appended later.
constexpr std::size_t smallest_plugin = offsetof(rouleau_plugin, models) + sizeof(rouleau_plugin::models);
constexpr std::size_t smallest_model = offsetof(rouleau_model, interaction) + sizeof(rouleau_model::interaction);
constexpr std::size_t smallest_named_model = offsetof(rouleau_model, id) + sizeof(rouleau_model::id);
constexpr std::size_t smallest_collision =
    offsetof(rouleau_collision, collide_f32) + sizeof(rouleau_collision::collide_f32);
constexpr std::size_t smallest_membrane = offsetof(rouleau_membrane, compute) + sizeof(rouleau_membrane::compute);
constexpr std::size_t smallest_interaction =
    offsetof(rouleau_interaction, compute) + sizeof(rouleau_interaction::compute);

std::string size_fault(const char* name, std::size_t found, std::size_t wanted) {
  return std::string("has a ") + name + " with struct_size " + std::to_string(found) + "; it must be at least " +
         std::to_string(wanted);
}

std::string kind_name(std::uint32_t kind) {
  if (kind < ROULEAU_COLLISION_KIND || kind > ROULEAU_INTERACTION_KIND) return std::to_string(kind);
  return to_string(static_cast<ModelKind>(kind));
}

/// Fault of the function table that the model's kind asks for; empty: none.
std::string table_fault(const rouleau_model& model) {
  const int tables = (model.collision != nullptr) + (model.membrane != nullptr) + (model.interaction != nullptr);
  const std::string which = "model " + in_quotes(model.id);
  const auto fault = [&](const auto* table, const char* name, std::size_t smallest, auto complete) -> std::string {
    if (table == nullptr) return "has no " + std::string(name) + " in its " + which;
    if (tables > 1) return "has more than one function table in its " + which;
    if (table->struct_size < smallest) return size_fault(name, table->struct_size, smallest);
    if (!complete(*table)) return "has a " + std::string(name) + " without all of its functions in its " + which;
    return {};
  };
  switch (static_cast<ModelKind>(model.kind)) {
    case ModelKind::collision:
      return fault(model.collision, "rouleau_collision", smallest_collision,
                   [](const auto& t) { return t.collide_f64 != nullptr && t.collide_f32 != nullptr; });
    case ModelKind::membrane:
      return fault(model.membrane, "rouleau_membrane", smallest_membrane,
                   [](const auto& t) { return t.compute != nullptr; });
    case ModelKind::interaction:
      return fault(model.interaction, "rouleau_interaction", smallest_interaction,
                   [](const auto& t) { return t.cutoff != nullptr && t.compute != nullptr; });
  }
  return {};
}

std::string model_fault(const rouleau_model& model, const Manifest& manifest) {
  if (model.struct_size < smallest_model) return size_fault("rouleau_model", model.struct_size, smallest_model);
  if (model.kind != static_cast<std::uint32_t>(manifest.kind)) {
    return "has a model " + in_quotes(manifest.id) + " of the kind " + kind_name(model.kind) +
           ", its manifest is for the kind " + to_string(manifest.kind);
  }
  if (model.version == nullptr || model.version != manifest.version) {
    return "has version " + (model.version == nullptr ? "(none)" : std::string(model.version)) + " of " +
           in_quotes(manifest.id) + ", its manifest is for version " + manifest.version;
  }
  if (model.create == nullptr || model.destroy == nullptr) {
    return "has no create or no destroy function in its model " + in_quotes(manifest.id);
  }
  return table_fault(model);
}

}  // namespace

FoundModel find_model(const rouleau_plugin& plugin, const Manifest& manifest) {
  if (plugin.struct_size < smallest_plugin) {
    return {nullptr, size_fault("rouleau_plugin", plugin.struct_size, smallest_plugin)};
  }
  if (plugin.models == nullptr) return {nullptr, "holds no list of models"};
  std::vector<std::string> ids;
  for (const rouleau_model* const* entry = plugin.models; *entry != nullptr; ++entry) {
    const rouleau_model& model = **entry;
    // A broken model beside the wanted one is no reason to refuse that, as long as its name can be read.
    if (model.struct_size < smallest_named_model) {
      return {nullptr, size_fault("rouleau_model", model.struct_size, smallest_model)};
    }
    if (model.id == nullptr) return {nullptr, "holds a model without an id"};
    if (model.id == manifest.id) {
      std::string fault = model_fault(model, manifest);
      if (!fault.empty()) return {nullptr, std::move(fault)};
      return {&model, {}};
    }
    ids.emplace_back(model.id);
  }
  return {nullptr, "holds no model with the manifest's id " + in_quotes(manifest.id) + did_you_mean(manifest.id, ids) +
                       "\n  its models: " + listed(ids)};
}

}  // namespace rouleau::plugin
