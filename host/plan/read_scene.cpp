#include "read_scene.hpp"

#include <algorithm>
#include <cmath>

#include "base/input_file.hpp"
#include "base/text.hpp"
#include "constants.hpp"
#include "json/document.hpp"
#include "limits.hpp"
#include "numerics_auto.hpp"
#include "plan.hpp"
#include "scene/driving_flow.hpp"
#include "scene/named_files.hpp"
#include "shape/extent.hpp"
#include "shape/passages.hpp"
#include "shape/random_cells.hpp"
#include "shape/surface.hpp"

namespace rouleau::plan {
namespace {

/// Every try at least halves what exceeds a limit, or nearly keeps it.
constexpr int most_tries = 20, most_packings = 3;
constexpr double to_spare = 1.02;

bool attracts_strongly(const Plan& plan) {
  if (plan.has_self_interactions || plan.scene->domain.dimension() == 3) return false;
  const double modulus = stretching_modulus(plan, plan.facts);
  return std::any_of(plan.facts.wells.begin(), plan.facts.wells.end(), [&](const InteractionWell& described) {
    return described.well.attracts() && described.between[1] != scene::wall_name &&
           !(described.well.depth <= deepest_corrected_well * modulus);
  });
}

NumericsBounds tightened(NumericsBounds bounds, const Plan& plan) {
  if (attracts_strongly(plan)) bounds.slip_correction = false;
  bounds.recovery = recovery_rates(plan, plan.facts);
  for (const Limit& limit : find_limits(plan)) {
    if (limit.margin >= 1 || !(limit.margin > 0)) continue;
    if (limit.remedied_by == RemediedBy::density_factor) {
      const auto stage = static_cast<std::size_t>(limit.stage);
      const double kept =
          plan.scene->stages[stage].density_factor * std::pow(limit.margin, 1 / limit.power_of_density) / to_spare;
      double& most =
          plan.scene->domain.dimension() == 3
              ? bounds.most_density_factor_at.try_emplace({stage, plan.scene->numerics.tau}, kept).first->second
              : bounds.most_density_factor.try_emplace(stage, kept).first->second;
      most = std::min(most, kept);
    } else if (limit.remedied_by == RemediedBy::resolution) {
      const double of_cells = shape::smallest_radius(*plan.scene);
      const double radius =
          (of_cells > 0 ? of_cells : plan.scene->domain.across(1) / 2) / scene::lattice_spacing(*plan.scene);
      bounds.least_radius = std::max(bounds.least_radius, radius / limit.margin);
    }
  }
  return bounds;
}

/// The hash of a file that is there; `wanted`: the one that is written, at `place`, or nothing.
std::string pinned_hash(const std::filesystem::path& file, const std::string& name, const std::string& wanted,
                        const Place& place) {
  static_cast<void>(InputFile(file, largest_named));  // before hours of hashing
  std::string found = sha256(file);
  if (wanted.empty() || wanted == found) return found;
  throw Error(Cause::bad_input, place,
              in_quotes(name) + " has another hash, " + found + ": it is not the file that was meant, or has changed",
              {"bring the file back, or leave out sha256"});
}

/// The document says from here on which files it names, wherever it is kept, and what was in them.
void pin_files(json::Document& document) {
  for (const std::string& entry : scene::entries_with_files(document.root())) {
    auto written = document.root().at(nlohmann::json::json_pointer(entry));
    std::vector<std::string> wanted, found;
    scene::each_text(written["sha256"], [&](const auto& hash) { wanted.push_back(hash); });
    bool there = true;
    scene::each_text(written["file"], [&](auto& text) {
      const auto name = text.template get<std::string>();
      const auto file = std::filesystem::absolute(std::filesystem::path(document.file()).parent_path() / name);
      std::error_code ignored;
      if (name.find('\0') != std::string::npos || !std::filesystem::is_regular_file(file, ignored)) there = false;
      if (!there) return;
      const std::string before = found.size() < wanted.size() ? wanted[found.size()] : "";
      found.push_back(pinned_hash(file, name, before, document.place(entry + "/sha256")));
      text = file.lexically_normal().string();
    });
    if (!there) continue;
    if (wanted.size() > found.size())
      throw Error(Cause::bad_input, document.place(entry + "/sha256"), "there are more hashes than files");
    document.put(entry + "/file", written["file"], document.file());
    document.put(entry + "/sha256", written["file"].is_array() ? nlohmann::json(found) : nlohmann::json(found.front()),
                 document.file());
  }
}

/// A scene's file, read once. Faults are added.
OpenScene read_file(const std::filesystem::path& file, const std::vector<std::string>& overrides, Faults& faults) {
  json::Document document = scene::read_document(file, overrides, faults);
  if (faults.empty()) faults.attempt([&] { pin_files(document); });
  return {std::move(document), faults};
}

/// Where cells come in: the piece behind the inlet where none is written, which must lie within the domain.
void complete_feed(scene::Scene& scene) {
  const scene::Feed* const written = scene.domain.feed();
  if (written == nullptr) return;
  constexpr double diameters = 2;
  scene::Feed& feed = *scene.domain.openings->front().cells;
  if (feed.length == 0) feed.length = diameters * 2 * shape::shape_radius(scene.cell_types[feed.type].shape);
  const double size = scene.domain.size[scene.domain.open_axis];
  if (feed.length <= size / 2) return;
  throw Error(Cause::bad_input, scene.place(feed.pointer),
              "cells appear within " + number(feed.length * 1e6, 6) + " um behind the inlet, and the domain is " +
                  number(size * 1e6, 6) + " um long",
              {"make the domain at least twice as long, or give the cells a length of their own"});
}

/// What forces pull at, once all cells are known: a patch is known of those that are placed.
void check_forced_cells(const scene::Scene& scene) {
  for (const scene::Stage& stage : scene.stages) {
    for (const scene::CellForce& force : stage.forces) {
      const std::size_t count = scene.cells.size();
      const auto last =
          force.cells.empty() ? std::max(count, std::size_t{1}) - 1 : static_cast<std::size_t>(force.cells.back());
      if (last >= count)
        throw Error(Cause::bad_input, scene.place(force.pointer),
                    "there is no cell " + std::to_string(last) + " that it could pull at; the scene has " +
                        std::to_string(count) + ", numbered from 0",
                    {"name others, or leave the force out"});
      if (last >= scene.placed().size() && force.toward != scene::Vector())
        throw Error(Cause::bad_input, scene.place(force.pointer + "/patch"),
                    "patches are of cells as placed, and some of these come in through the inlet",
                    {"leave patch out, or name cells that are placed"});
    }
  }
}

/// The scene with all values. Faults are added; with some, it is what could be read. `former`: what was read with other
/// bounds, or null.
ReadScene completed(const OpenScene& open, const NumericsBounds& bounds, Faults& faults,
                    const ReadScene* former = nullptr) {
  std::optional<NumericsChoice> choice;
  auto document = std::make_shared<json::Document>(open.filled_in(bounds, choice));
  ReadScene read{scene::read_scene(std::move(document), faults), std::move(choice)};
  if (faults.empty()) faults.attempt([&] { shape::check_stress_free(read.scene); });
  if (faults.empty()) faults.attempt([&] { complete_feed(read.scene); });
  if (faults.empty()) open.build_walls(read.scene, faults);
  if (faults.empty()) {
    const bool same = former != nullptr && former->scene.domain.nodes == read.scene.domain.nodes;
    shape::survey_walls(read.scene, same ? former->scene.domain.passages : nullptr);
  }
  if (faults.empty()) faults.attempt([&] { shape::add_random_cells(read.scene); });
  if (faults.empty()) faults.attempt([&] { shape::add_fed_cells(read.scene); });
  if (faults.empty()) faults.attempt([&] { check_forced_cells(read.scene); });
  return read;
}

/// Refuses passages that the lattice does not resolve, and a flow along x that finds no way.
void require_passages(const scene::Scene& scene) {
  if (!scene.domain.passages) return;
  const scene::Passages& passages = *scene.domain.passages;
  const std::string pointer = scene.domain.within ? scene.domain.within->pointer : "/domain/obstacles";
  const auto refuse = [&](const std::string& problem, const std::string& remedy) {
    throw Error(Cause::bad_input, scene.place(pointer), problem, {remedy});
  };
  constexpr double measured = 0.99;  // to a per cent
  if (passages.narrowest < measured * least_passage) {
    const double finer = std::ceil(narrowest_passage / passages.narrowest * scene.domain.nodes[0]);
    refuse("between walls at (" + scene::by_axes(passages.narrowest_at, 1e6, 5, " um", ", ") + ") a passage is " +
               number(passages.narrowest, 3) + " lattice spacings wide, and below " + number(least_passage) +
               " its flow is not resolved",
           "take " + number(finer, 12) +
               " nodes along x and as many more along the others, close the passage, or widen it");
  }
  const auto drives = [&](const scene::Stage& stage) {
    return scene::driving_force(stage, scene).x() != 0 || stage.changes();
  };
  if (scene.domain.openings && !passages.through)
    refuse("these walls leave no way from the inlet to the outlet",
           std::string("let their opening begin at the domain's lower end along ") +
               scene::axis_names[scene.domain.open_axis] + " and reach to its upper end");
  if (!scene.domain.openings && !passages.through && std::any_of(scene.stages.begin(), scene.stages.end(), drives))
    refuse("a flow is driven along x, and these walls leave no way through the domain from one end to the other",
           "open a way, or leave out what drives the flow");
}

}  // namespace

ReadScene read_unpacked_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Faults faults;
  ReadScene read = completed(read_file(file, overrides, faults), {}, faults);
  faults.raise();
  require_passages(read.scene);
  return read;
}

scene::Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  scene::Scene scene = read_unpacked_scene(file, overrides).scene;
  shape::pack_cells(scene);  // may take a while: after everything else has been found right
  return scene;
}

ReadScene read_within_limits(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                             const std::function<plugin::Catalog(const scene::Scene&)>& catalog_of,
                             const shape::PackingWatch& watch) {
  NumericsBounds bounds;
  Faults faults;
  const OpenScene open = read_file(file, overrides, faults);
  ReadScene read = completed(open, bounds, faults);
  if (!faults.empty()) {
    faults.attempt([&] { find_model_faults(read.scene, catalog_of(read.scene), faults); });
    faults.raise();
  }
  if (!read.numerics_choice) {
    require_passages(read.scene);
    shape::pack_cells(read.scene, watch);
    return read;
  }
  const plugin::Catalog catalog = catalog_of(read.scene);  // numerics change no model
  const auto tighten = [&] {
    const NumericsBounds tighter = tightened(bounds, make_plan(read.scene, catalog, read.numerics_choice));
    if (tighter == bounds) return false;
    bounds = tighter;
    read = completed(open, bounds, faults, &read);
    faults.raise();
    return true;
  };
  for (int packed = 0; packed < most_packings; ++packed) {
    for (int tries = 0; tries < most_tries && tighten(); ++tries) continue;
    require_passages(read.scene);
    shape::pack_cells(read.scene, watch);
    // Where they lie they may exceed a limit that cells anywhere do not.
    if (read.scene.packings.empty() || packed + 1 == most_packings || !tighten()) break;
  }
  return read;
}

}  // namespace rouleau::plan
