// A plan for people and for programs.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "plan_report.hpp"
#include "scene/driving_flow.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::plan {

namespace {

std::string formatted(double value, const char* format = "%.4g") {
  if (std::isnan(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

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

std::string well_text(const WellInSi& well) {
  if (!well.attracts()) return "no attraction";
  return formatted(well.depth) + " J/m2 at " + formatted(well.distance) + " m, width " + formatted(well.width) + " m";
}

void write_wells(std::ostringstream& out, const std::vector<InteractionWell>& wells) {
  if (wells.empty()) return;
  out << "\nWells of the interactions (width: depth over strongest attraction)\n";
  for (const InteractionWell& described : wells) {
    const auto& [a, b] = described.between;
    out << "  " << padded(described.model + ", " + a + " - " + b, 30) << well_text(described.well) << "\n";
    if (!described.stands_for) continue;
    out << "  " << padded("  which stands for", 30) << well_text(*described.stands_for);
    if (described.widened) out << "; widened " << formatted(*described.widened) << " times";
    out << "\n";
  }
}

void write_choice(std::ostringstream& out, const NumericsChoice& choice, bool knows_developed) {
  out << "\nNumerics, chosen for an error of " << formatted(100 * choice.target) << " % of the "
      << (choice.steady ? "steady state" : "motion") << "\n";
  for (const ChosenValue& chosen : choice.values)
    out << "  " << padded(chosen.pointer, 28) << padded(chosen.value.dump(), 16) << chosen.why << "\n";
  out << "  expected error " << formatted(100 * choice.expected.total(), "%.2g") << " %: lattice "
      << formatted(100 * choice.expected.resolution, "%.2g") << " %, relaxed density "
      << formatted(100 * choice.expected.inertia, "%.2g") << " %"
      << (choice.expected.start > 0 ? ", the start of the flow " + formatted(100 * choice.expected.start, "%.2g") +
                                          (knows_developed ? " % (none with \"start\": \"developed\")" : " %")
                                    : "")
      << " (docs/auto.md)\n";
}

void write_output(std::ostringstream& out, const scene::Scene& scene, const OutputEstimate& output) {
  out << "Output: at most " << size(output.frames_bytes) << " in frames.h5 (" << formatted(output.outputs, "%.0f")
      << " frames, " << formatted(output.field_outputs, "%.0f") << " with fields), about " << size(output.tables_bytes)
      << " in the tables";
  if (output.checkpoint_bytes > 0) out << ", " << size(output.checkpoint_bytes) << " in a checkpoint";
  out << "\n";
  if (output.fields_compressed)
    out << "  " << size(output.fields_bytes) << " of it are fields, which compression makes smaller by an unknown "
        << "factor\n";
  const scene::FieldStorage& storage = scene.output.field_storage;
  if (scene.output.fields.never() || storage.whole()) return;
  const double spacing = scene::lattice_spacing(scene) * 1e6;
  out << "  fields at";
  for (int axis = 0; axis < scene.domain.dimension(); ++axis) {
    const int first = storage.first[axis], count = storage.count(axis, scene.domain.nodes[axis]);
    out << (axis == 0 ? " " : ", ") << scene::axis_names[axis] << " = " << formatted(units::coordinate(first, spacing))
        << " um";
    if (count > 1)
      out << " to " << formatted(units::coordinate(first + (count - 1) * storage.stride, spacing)) << " um (" << count
          << " nodes)";
  }
  out << ", " << formatted(storage.stride * spacing) << " um apart: lattice nodes inside the region"
      << (storage.stride > 1 ? " from its lower left corner" : "") << "\n";
}

}  // namespace

std::string to_text(const Plan& plan, const PlanReport& report) {
  std::ostringstream out;
  const scene::Scene& scene = *plan.scene;
  out << (scene.title.empty() ? "untitled scene" : scene.title) << "\n";
  for (const std::string& warning : report.warnings) out << "  warning: " << warning << "\n";

  if (plan.numerics_choice) write_choice(out, *plan.numerics_choice, scene::knows_developed_flows(scene));
  const auto whole = [](const Conversion& row) { return row.quantity + (row.of.empty() ? "" : " (" + row.of + ")"); };
  std::size_t stage = 5, quantity = 8;
  for (const Conversion& row : report.conversions) {
    stage = std::max(stage, row.stage.size());
    quantity = std::max(quantity, whole(row).size());
  }
  out << "\nConversions\n  " << padded("stage", stage) << padded("quantity", quantity) << padded("SI", 10)
      << padded("lattice", 10) << "SI unit\n";
  for (const Conversion& row : report.conversions) {
    out << "  " << padded(row.stage, stage) << padded(whole(row), quantity) << padded(formatted(row.si), 10)
        << padded(formatted(row.lattice), 10) << row.unit << "\n";
  }

  if (!report.packings.empty()) out << "\nCells packed at random\n";
  for (const PackedCells& packed : report.packings) {
    out << "  " << packed.count << " of type " << packed.type << ", hematocrit " << formatted(packed.hematocrit);
    if (!std::isnan(packed.hematocrit_asked)) out << " of " << formatted(packed.hematocrit_asked) << " asked";
    out << ", gap " << formatted(packed.gap_m * 1e6, "%.3g") << " um, seed " << packed.seed << " (" << packed.pointer
        << ")\n";
  }

  if (!report.first_stretches.empty()) out << "\nFirst shapes against stress-free ones\n";
  for (const shape::FirstStretch& first : report.first_stretches) {
    out << "  " << first.type << ": principal stretches from " << formatted(first.least) << " to "
        << formatted(first.most) << ", elastic energy " << formatted(first.energy) << " J/m2 and tension "
        << formatted(first.tension) << " N/m on average\n";
  }

  out << "\nDimensionless numbers\n";
  for (const auto& [name, value] : report.dimensionless) out << "  " << padded(name, 24) << formatted(value) << "\n";
  if (!scene.fluid.inertia) {
    out << "  Convective inertia is left out (fluid.inertia false), so the simulated Reynolds number only scales the "
           "unsteady term; the flow is Stokes flow.\n";
  }
  for (const LateStart& late : report.late_starts) {
    out << "  The fluid starts from rest: " << in_words(late)
        << (late.avoidable ? ". With \"start\": \"developed\" it would not.\n" : ".\n");
  }
  if (report.box_share) {
    out << "  Walls and images " << formatted(report.box_share->radii, "%.3g") << " radii apart add "
        << (report.box_share->at_least ? "more than " : "about ")
        << formatted(100 * report.box_share->deformation, "%.2g")
        << " % to the deformation in a fluid without end; no error bar has that share (docs/three-dimensions.md).\n";
  }

  write_wells(out, report.wells);
  out << "\nLimits, sharpest first (margin below 1: beyond the limit)\n  " << padded("value", 11) << padded("limit", 11)
      << padded("margin", 9) << "of\n";
  for (const Limit& limit : report.limits) {
    out << "  " << padded(formatted(limit.value), 11) << padded(formatted(limit.limit), 11)
        << padded(formatted(limit.margin, "%.3g"), 9) << limit.name << (limit.margin < 1 ? "; " + limit.remedy : "")
        << "\n";
  }

  out << "\nModels\n";
  for (const PlannedModel* model : plan.active_models()) {
    out << "  " << padded(std::string(plugin::to_string(model->manifest->kind)) + " " + model->manifest->id, 30)
        << model->manifest->library.string() << "\n";
  }
  if (plan.lock) out << "  as locked by " << plan.lock->file << "\n";
  out << "\nCoupling of membranes and fluid\n  " << plan.coupling << "\n";
  out << "\nPasses of a step\n";
  for (const PlannedPass& pass : report.passes) out << "  " << padded(pass.name, 14) << pass.why << "\n";
  out << "\nLeft out\n";
  for (const Omission& omission : report.left_out) out << "  " << omission.what << ": " << omission.why << "\n";

  out << "\nAt most " << formatted(report.estimate.steps, "%.0f") << " steps, about "
      << duration(report.estimate.wall_s) << " on one core, " << size(report.estimate.memory_bytes)
      << " of memory for fields\n";
  write_output(out, scene, report.estimate.output);
  return out.str();
}

std::string in_words(const LateStart& late) {
  return "in stage " + late.stage + " everything comes late by a strain of " + number(late.strain, 3) + " (of " +
         number(late.stage_strain, 3) + ")";
}

nlohmann::json shared_sections(const PlanReport& report) {
  auto attracting = nlohmann::json::array();
  for (const auto& [between, depth] : report.attracting) attracting.push_back(between);
  return {{"warnings", report.warnings},
          {"conversions", report.conversions},
          {"packings", report.packings},
          {"first_stretches", report.first_stretches},
          {"limits", report.limits},
          {"dimensionless", report.dimensionless},
          {"wells", report.wells},
          {"left_out", report.left_out},
          {"late_starts", report.late_starts},
          {"box_share", report.box_share ? nlohmann::json(*report.box_share) : nlohmann::json()},
          {"contacts", {{"close_below_m", report.close_gap}, {"attracting", attracting}}}};
}

nlohmann::json to_json(const Plan& plan, const PlanReport& report) {
  nlohmann::json json = shared_sections(report);
  json["title"] = plan.scene->title;
  json["numerics_choice"] = to_json(plan.numerics_choice);
  json["models"] = nlohmann::json::array();
  for (const PlannedModel* model : plan.active_models()) {
    json["models"].push_back({{"id", model->manifest->id},
                              {"kind", plugin::to_string(model->manifest->kind)},
                              {"version", model->manifest->version},
                              {"library", model->manifest->library.string()}});
  }
  json["lock"] = plan.lock ? nlohmann::json(*plan.lock) : nlohmann::json();
  json["coupling"] = {{"semi_implicit", plan.semi_implicit}, {"why", plan.coupling}};
  json["passes"] = report.passes;
  json["estimate"] = {{"steps_at_most", report.estimate.steps},
                      {"wall_s", report.estimate.wall_s},
                      {"memory_bytes", report.estimate.memory_bytes},
                      {"output_bytes", report.estimate.output.bytes()},
                      {"output", report.estimate.output}};
  return json;
}

}  // namespace rouleau::plan
