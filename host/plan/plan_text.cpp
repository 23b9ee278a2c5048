// A plan for people and for programs.
#include <cmath>
#include <cstdio>
#include <sstream>

#include "json/number_or_null.hpp"
#include "plan.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::plan {

namespace {

std::string formatted(double value, const char* format = "%.4g") {
  if (std::isnan(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string formatted(const nlohmann::json& value) { return value.is_number() ? formatted(value.get<double>()) : "-"; }

std::string size(double bytes) {
  if (bytes < 1e6) return formatted(bytes / 1e3, "%.0f") + " kB";
  if (bytes < 1e9) return formatted(bytes / 1e6, "%.1f") + " MB";
  return formatted(bytes / 1e9, "%.1f") + " GB";
}

std::string duration(double seconds) {
  if (seconds < 120) return formatted(seconds, "%.1f") + " s";
  if (seconds < 7200) return formatted(seconds / 60, "%.1f") + " min";
  return formatted(seconds / 3600, "%.1f") + " h";
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text + " ";
}

std::string well_text(const nlohmann::json& well) {
  if (well["depth_J_m2"].is_null()) return "no attraction";
  return formatted(well["depth_J_m2"]) + " J/m2 at " + formatted(well["zero_force_distance_m"]) + " m, width " +
         formatted(well["width_m"]) + " m";
}

void write_wells(std::ostringstream& out, const nlohmann::json& wells) {
  if (wells.empty()) return;
  out << "\nWells of the interactions (width: depth over strongest attraction)\n";
  for (const auto& well : wells) {
    const std::string between = well["between"][0].get<std::string>() + " - " + well["between"][1].get<std::string>();
    out << "  " << padded(well["model"].get<std::string>() + ", " + between, 30) << well_text(well) << "\n";
    if (!well.contains("stands_for")) continue;
    out << "  " << padded("  which stands for", 30) << well_text(well["stands_for"]);
    if (well.contains("widened")) out << "; widened " << formatted(well["widened"]) << " times";
    out << "\n";
  }
}

void write_choice(std::ostringstream& out, const scene::NumericsChoice& choice) {
  out << "\nNumerics, chosen for an error of " << formatted(100 * choice.target) << " % of the "
      << (choice.steady ? "steady state" : "motion") << "\n";
  for (const scene::ChosenValue& chosen : choice.values) {
    out << "  " << padded(chosen.pointer, 28) << padded(chosen.value.dump(), 16) << chosen.why << "\n";
  }
  out << "  expected error " << formatted(100 * choice.expected.total(), "%.2g") << " %: lattice "
      << formatted(100 * choice.expected.resolution, "%.2g") << " %, relaxed density "
      << formatted(100 * choice.expected.inertia, "%.2g") << " % (docs/accuracy.md)\n";
}

void write_output(std::ostringstream& out, const Plan& plan) {
  const OutputEstimate& output = plan.estimate.output;
  out << "Output: at most " << size(output.frames_bytes) << " in frames.h5 (" << formatted(output.outputs, "%.0f")
      << " frames, " << formatted(output.field_outputs, "%.0f") << " with fields), about " << size(output.tables_bytes)
      << " in the tables\n";
  if (output.compressed)
    out << "  " << size(output.fields_bytes) << " of it are fields, which compression makes smaller by an unknown "
        << "factor\n";
  const scene::FieldStorage& storage = plan.scene->output.field_storage;
  if (plan.scene->output.fields.never() || storage.whole()) return;
  const double spacing = lattice_spacing(*plan.scene) * 1e6;
  out << "  fields at";
  for (const int axis : {0, 1}) {
    const auto a = static_cast<std::size_t>(axis);
    const int count = storage.count(axis, plan.scene->domain.nodes[a]);
    out << (axis == 0 ? " x = " : ", y = ") << formatted(units::coordinate(storage.first[a], spacing)) << " um";
    if (count > 1)
      out << " to " << formatted(units::coordinate(storage.first[a] + (count - 1) * storage.stride, spacing)) << " um ("
          << count << " nodes)";
  }
  out << ", " << formatted(storage.stride * spacing) << " um apart: lattice nodes inside the region"
      << (storage.stride > 1 ? " from its lower left corner" : "") << "\n";
}

}  // namespace

std::string to_text(const Plan& plan) {
  std::ostringstream out;
  const scene::Scene& scene = *plan.scene;
  out << (scene.title.empty() ? "untitled scene" : scene.title) << "\n";
  for (const std::string& warning : plan.warnings) out << "  warning: " << warning << "\n";

  if (scene.numerics_choice) write_choice(out, *scene.numerics_choice);
  out << "\nConversions\n  " << padded("stage", 12) << padded("quantity", 40) << padded("SI", 14)
      << padded("lattice", 14) << "SI unit\n";
  for (const auto& row : plan.conversions) {
    const std::string of = row["of"];
    const std::string quantity = row["quantity"].get<std::string>() + (of.empty() ? "" : " (" + of + ")");
    out << "  " << padded(row["stage"].get<std::string>(), 12) << padded(quantity, 40)
        << padded(formatted(row["si"]), 14) << padded(formatted(row["lattice"]), 14) << row["unit"].get<std::string>()
        << "\n";
  }

  if (!plan.packings.empty()) out << "\nCells packed at random\n";
  for (const auto& packing : plan.packings) {
    out << "  " << packing["count"] << " of type " << packing["type"].get<std::string>() << ", hematocrit "
        << formatted(packing["hematocrit"]);
    if (packing["hematocrit_asked"].is_number()) out << " of " << formatted(packing["hematocrit_asked"]) << " asked";
    out << ", gap " << formatted(packing["gap_m"].get<double>() * 1e6, "%.3g") << " um, seed " << packing["seed"]
        << " (" << packing["pointer"].get<std::string>() << ")\n";
  }

  out << "\nDimensionless numbers\n";
  for (const auto& [name, value] : plan.dimensionless.items())
    out << "  " << padded(name, 24) << formatted(value) << "\n";
  if (!scene.fluid.inertia) {
    out << "  Convective inertia is left out (fluid.inertia false), so the simulated Reynolds number only scales the\n"
           "  unsteady term; the flow is Stokes flow.\n";
  }

  write_wells(out, plan.wells);
  out << "\nLimits, sharpest first (margin below 1: beyond the limit)\n  " << padded("limit", 62) << padded("value", 12)
      << padded("limit", 12) << "margin\n";
  for (const Limit& limit : plan.limits) {
    out << "  " << padded(limit.name, 62) << padded(formatted(limit.value), 12) << padded(formatted(limit.limit), 12)
        << formatted(limit.margin, "%.3g") << (limit.margin < 1 ? "   " + limit.remedy : "") << "\n";
  }

  out << "\nModels\n";
  for (const PlannedModel* model : plan.active_models()) {
    out << "  " << padded(std::string(plugin::to_string(model->manifest->kind)) + " " + model->manifest->id, 30)
        << model->manifest->library.string() << "\n";
  }
  if (plan.lock) out << "  as locked by " << plan.lock->file << "\n";
  out << "\nCoupling of membranes and fluid\n  " << plan.coupling << "\n";
  out << "\nPasses of a step\n";
  for (const PlannedPass& pass : plan.passes) out << "  " << padded(pass.name, 14) << pass.why << "\n";
  out << "\nLeft out\n";
  for (const Omission& omission : plan.left_out) out << "  " << omission.what << ": " << omission.why << "\n";

  out << "\nAt most " << formatted(plan.estimate.steps, "%.0f") << " steps, about " << duration(plan.estimate.wall_s)
      << " on one core, " << size(plan.estimate.memory_bytes) << " of memory for fields\n";
  write_output(out, plan);
  return out.str();
}

nlohmann::json to_json(const Plan& plan) {
  nlohmann::json json;
  json["title"] = plan.scene->title;
  json["warnings"] = plan.warnings;
  json["numerics_choice"] = plan.numerics_choice;
  json["conversions"] = plan.conversions;
  json["packings"] = plan.packings;
  json["dimensionless"] = plan.dimensionless;
  json["wells"] = plan.wells;
  json["limits"] = nlohmann::json::array();
  for (const Limit& limit : plan.limits) {
    json["limits"].push_back({{"name", limit.name},
                              {"value", json::number_or_null(limit.value)},
                              {"limit", json::number_or_null(limit.limit)},
                              {"margin", json::number_or_null(limit.margin)},
                              {"remedy", limit.remedy}});
  }
  json["models"] = nlohmann::json::array();
  for (const PlannedModel* model : plan.active_models()) {
    json["models"].push_back({{"id", model->manifest->id},
                              {"kind", plugin::to_string(model->manifest->kind)},
                              {"version", model->manifest->version},
                              {"library", model->manifest->library.string()}});
  }
  json["lock"] =
      plan.lock ? nlohmann::json{{"file", plan.lock->file}, {"sha256", plan.lock->sha256}} : nlohmann::json();
  json["coupling"] = {{"semi_implicit", plan.semi_implicit}, {"why", plan.coupling}};
  json["passes"] = nlohmann::json::array();
  for (const PlannedPass& pass : plan.passes) json["passes"].push_back({{"name", pass.name}, {"why", pass.why}});
  json["left_out"] = nlohmann::json::array();
  for (const Omission& o : plan.left_out) json["left_out"].push_back({{"what", o.what}, {"why", o.why}});
  json["estimate"] = {{"steps_at_most", plan.estimate.steps},
                      {"wall_s", plan.estimate.wall_s},
                      {"memory_bytes", plan.estimate.memory_bytes},
                      {"output_bytes", plan.estimate.output.bytes()},
                      {"output", to_json(plan.estimate.output)}};
  return json;
}

}  // namespace rouleau::plan
