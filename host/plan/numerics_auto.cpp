#include "numerics_auto.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/text.hpp"
#include "constants.hpp"
#include "json/json_pointer.hpp"
#include "numerics_problem.hpp"
#include "scene/driving_flow.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene_reader.hpp"
#include "shape/outline.hpp"
#include "shape/random_cells.hpp"
#include "shape/walls.hpp"

namespace rouleau::plan {

namespace {

using Json = nlohmann::json;

constexpr const char* origin = "numerics.auto";

/// By dimension.
constexpr const char* why_uncorrected[2] = {
    "left out, for plasma between cells drains with it, and some that attract each other strongly "
    "then become so thin that they cross themselves",
    "left out: in three dimensions it was measured with the kernel sharp6 alone, and without layers"};
/// Into how many pieces a membrane is cut before they are chosen, but one of a shape that has them.
constexpr struct {
  const char *key, *but_of;
  int count;
} draft_pieces[2] = {{"segments", "", 64}, {"triangles", "mesh", 320}};

/// What a person would write: three digits, rounded down. Whole numbers stay whole.
Json three_digits_below(double value) {
  const double digit = std::pow(10, std::floor(std::log10(value)) - 2);
  const double rounded = std::stod(number(std::floor(value / digit * (1 + 1e-12)) * digit, 3));
  if (rounded == std::floor(rounded) && rounded < 1e15) return static_cast<std::int64_t>(rounded);
  return rounded;
}

/// Gives "numerics": "auto" the form of an object.
void spell_out_numerics(json::Document& document) {
  if (!document.root().at("numerics").is_object()) document.put("/numerics", {{"auto", Json::object()}}, origin);
}

/// Gives a document values with which it can be read; they mean nothing.
void put_draft_numerics(json::Document& document) {
  const Json root = document.root();
  const scene::SceneFields fields(document);
  const int dimension = static_cast<int>(root.at("domain").at("size").size());
  if (!root.at("domain").contains("nodes")) {
    const auto lattice =
        scene::coarsest_lattice(fields.quantities("/domain/size", "m", scene::range::length, dimension));
    if (!lattice) {
      const std::string most = std::to_string(scene::most_coarse_rows);
      const std::array wrong{
          "the ratio of these sides is not one of whole numbers up to " + most +
              ", so that no lattice with the same spacing along both can be chosen\n"
              "write sides with a simple ratio, such as [\"50 um\", \"25 um\"], or give nodes",
          "the ratios of these sides are not those of whole numbers up to " + most +
              ", or want more nodes than can be computed (" + std::to_string(scene::most_nodes_of_block) +
              "), so that no lattice with the same spacing along all three can be chosen\n"
              "write sides with simple ratios, such as [\"50 um\", \"25 um\", \"25 um\"], or give nodes"};
      fields.refuse("/domain/size", wrong[dimension - 2]);
    }
    // As fine as a lattice that might be chosen: a region of output must hold nodes.
    const int factor = std::max(1, 1024 / *std::max_element(lattice->begin(), lattice->end()));
    document.put("/domain/nodes", scene::refined(*lattice, factor).value(), origin);
  }
  const Json types = root.value("cell_types", Json::object());
  for (const auto& [name, type] : types.items()) {
    const std::string cell = json::child_pointer("/cell_types", name);
    const auto& [key, but_of, count] = draft_pieces[dimension - 2];
    if (!type.contains(key) && !type.at("shape").contains(but_of)) document.put(cell + "/" + key, count, origin);
  }
}

bool leaves_numerics_open(const Json& numerics) {
  return numerics == "auto" || (numerics.is_object() && numerics.contains("auto"));
}

}  // namespace

std::string NumericsProblem::why_density_factor(const Trial& best, std::size_t stage, const std::string& gain) const {
  if (!has_cells_) return "without cells the fluid's own inertia is what decides";
  const Flow& flow = flows_[stage];
  const double factor = best.density_factors[stage];
  const bool limited = factor >= most_by_limits(stage, best.tau) * 0.99;
  if (flow.at_rest()) {
    return limited                           ? "at rest, as large as the limits of the membranes' stiffness allow"
           : factor < density_factor_at_rest ? "at rest, no larger than in the flow before"
                                             : "at rest, the largest with which cells were measured to come to rest";
  }
  if (flow.rate == 0) return "carried along by both walls, as large as their Mach number allows";
  const ErrorShares error = error_of(flow, factor, compression_of(spacing_of(best.nodes), best.tau));
  std::string why = "simulated Reynolds number " + number(momentum_time_ * flow.rate * factor, 3) + ": " +
                    number(100 * error.inertia, 2) + " % of error";
  if (error.start > 0) why += ", and " + number(100 * error.start, 2) + " % by the start of the flow" + gain;
  if (limited) why += "; more is beyond a limit of the plan";
  return why;
}

std::optional<std::size_t> NumericsProblem::least_dense(const Trial& best) const {
  std::optional<std::size_t> least;
  for (std::size_t i = 0; i < flows_.size(); ++i)
    if (!flows_[i].given_factor && (!least || best.density_factors[i] < best.density_factors[*least])) least = i;
  return least;
}

/// The least one is that of the scene; stages that bear a much denser fluid get their own.
void NumericsProblem::choose_density_factors(const Trial& best, NumericsChoice& choice) const {
  constexpr double much = 1.25;
  const std::optional<std::size_t> least = least_dense(best);
  if (!least) return;
  const std::string gain = gain_by_developed_start(best);
  const auto choose = [&](const std::string& of, std::size_t stage) {
    choice.values.push_back({of + "/density_factor", three_digits_below(best.density_factors[stage]),
                             why_density_factor(best, stage, gain)});
  };
  choose("/numerics", *least);
  for (std::size_t i = 0; i < flows_.size(); ++i)
    if (!flows_[i].given_factor && best.density_factors[i] > much * best.density_factors[*least])
      choose(scene_.stages[i].pointer, i);
}

/// What flows that are developed from the start would save; empty: little.
std::string NumericsProblem::gain_by_developed_start(const Trial& best) const {
  constexpr double little = 0.8;
  if (std::none_of(flows_.begin(), flows_.end(), [](const Flow& flow) { return flow.lag > 0; }) ||
      !scene::knows_developed_flows(scene_))
    return {};
  NumericsProblem developed = *this;
  for (Flow& flow : developed.flows_) flow.lag = 0;
  const Trial other = developed.cheapest();
  if (!good_enough(best) || !developed.meets_target(other) || other.cost > little * best.cost) return {};
  return ", without which (\"start\": \"developed\") the run would take " + number(other.cost / best.cost, 2) +
         " times as long";
}

NumericsChoice NumericsProblem::chosen(const Trial& best) const {
  NumericsChoice choice{target_, steady_, best.error, {}, {}};
  const auto choose = [&](const std::string& pointer, const Json& value, const std::string& why) {
    choice.values.push_back({pointer, value, why});
  };
  const auto percent = [](double share) { return number(100 * share, 2) + " %"; };
  const double spacing = spacing_of(best.nodes);
  if (!written_.at("domain").contains("nodes")) {
    choose("/domain/nodes", best.nodes,
           has_cells_ ? "the smallest cell's radius is " + number(radius_ / spacing, 3) +
                            " spacings: " + percent(best.error.resolution) + " of error"
                      : std::to_string(best.nodes[1]) + " rows: " + percent(best.error.resolution) + " of error");
  }
  for (const scene::CellType& type : scene_.cell_types) {
    // Nodes of surfaces lie a spacing apart anyway.
    if (type.segments == 0 || written_.at("cell_types").at(type.name).contains("segments")) continue;
    const double segments = std::clamp(std::round(shape::shape_perimeter(type.shape) / spacing), 8.0, 100000.0);
    choose("/cell_types/" + type.name + "/segments", static_cast<int>(segments), "one for each spacing");
  }
  const auto set = [&](const char* key, const Json& value, const std::string& why) {
    if (!numerics_.contains(key)) choose(std::string("/numerics/") + key, value, why);
  };
  set("tau", best.tau, "the cheapest with this resolution");
  choose_density_factors(best, choice);
  if (has_cells_) {
    set("coupling", "auto", "explicit or semi-implicit, by the limits of the membranes' stiffness");
    const bool corrected = coupling_ != MembraneCoupling::plain;
    if (coupling_ == MembraneCoupling::sharp)
      set("kernel", sharp_kernel,
          "has no second moment: what the slip correction leaves is a fifth of that of peskin4");
    set("slip_correction", corrected,
        corrected ? "takes the first-order error of the immersed boundary out"
                  : why_uncorrected[scene_.domain.dimension() - 2]);
    set("area_correction", true, std::string("cells keep their ") + scene_.domain.words().contents);
  }
  choice.doubt = doubt_about(best);
  return choice;
}

/// Why the target may not be met, or only at a price; empty: it should.
std::string NumericsProblem::doubt_about(const Trial& best) const {
  const auto percent = [](double share) { return number(100 * share, 2) + " %"; };
  const auto unknown = [](const std::string& what, double value, double least, double most) {
    return "numerics.auto: the " + what + " " + number(value, 3) + " lies outside of what errors were measured for (" +
           number(least) + " to " + number(most) + ")";
  };
  if (!meets_target(best)) {
    std::string pins;
    for (const char* key : {"density_factor", "tau"})
      if (!pinned(key).is_null()) pins += (pins.empty() ? "" : " and ") + std::string("numerics.") + key;
    for (const scene::Stage& stage : scene_.stages)
      if (stage.has_own_density_factor()) pins += (pins.empty() ? "" : " and ") + stage.density_factor_key;
    if (written_.at("domain").contains("nodes")) pins += (pins.empty() ? "" : " and ") + std::string("domain.nodes");
    const ErrorShares& error = best.error;
    std::string total = percent(error.total());
    if (total == percent(target_)) total = number(100 * error.total(), 4) + " %";
    return "numerics.auto: the expected error is " + total + ", more than the target of " + percent(target_) + ": " +
           percent(error.resolution) + " by the lattice, " + percent(error.inertia) + " by the fluid's density, " +
           percent(error.start) + " by the start; " +
           (pins.empty() ? "allow a larger error" : "leave " + pins + " open, or allow a larger error");
  }
  if (!has_cells_) return {};
  constexpr double most_of_the_target = 0.8;
  const std::optional<std::size_t> least_dense_stage = least_dense(best);
  if (best.error.resolution > most_of_the_target * target_ && least_dense_stage &&
      flows_[*least_dense_stage].rate > 0 && written_.at("domain").contains("nodes")) {
    return "numerics.auto: the lattice that domain.nodes names takes " + percent(best.error.resolution) +
           " of error already, and what is left of " + percent(target_) + " asks for small steps (density_factor " +
           number(best.density_factors[*least_dense_stage], 3) + "); leave domain.nodes out, or allow a larger error";
  }
  if (!scene_.fluid.layers.empty())
    return "numerics.auto: the error of cells was measured in a fluid of one viscosity, and fluid.layers has others";
  if (viscosity_ratio_ < 0.99 || viscosity_ratio_ > 1.01 * measured_ratio)
    return unknown("viscosity ratio", viscosity_ratio_, 1, measured_ratio);
  const MeasuredCapillary& measured = measured_capillary[scene_.domain.dimension() - 2][static_cast<int>(coupling_)];
  if (!measured.known || !bounds_.recovery) return {};
  const auto& [least, most] = capillary_;
  if (!measured.unstretched && !std::isfinite(most))
    return "numerics.auto: the error of cells was measured with membranes that resist stretching";
  if (least < measured.least) return unknown("capillary number", least, measured.least, measured.most);
  if (most > measured.most && std::isfinite(most))
    return unknown("capillary number", most, measured.least, measured.most);
  return {};
}

OpenScene::OpenScene(json::Document document, Faults& faults) : document_(std::move(document)) {
  if (!faults.empty() || !leaves_numerics_open(document_.root().value("numerics", Json()))) return;
  auto draft = std::make_shared<json::Document>(document_);
  faults.attempt([&] {
    spell_out_numerics(document_);
    *draft = document_;
    put_draft_numerics(*draft);
  });
  if (!faults.empty()) return;
  Faults of_draft;
  draft_ = scene::read_scene(draft, of_draft);
  if (of_draft.empty()) shape::build_walls(*draft_, of_draft);
  if (of_draft.empty()) of_draft.attempt([&] { shape::add_random_cells(*draft_), shape::add_fed_cells(*draft_); });
  if (of_draft.empty()) return;
  document_ = *draft;  // whose reading says them
  draft_.reset();
}

json::Document OpenScene::filled_in(const NumericsBounds& bounds, std::optional<NumericsChoice>& choice) const {
  json::Document document = document_;
  if (!draft_) return document;
  choice = NumericsProblem(*draft_, document_.root(), bounds).solve();
  for (const ChosenValue& value : choice->values) document.put(value.pointer, value.value, origin);
  return document;
}

void OpenScene::build_walls(scene::Scene& scene, Faults& faults) const {
  if (!draft_) return shape::build_walls(scene, faults);
  scene.domain.region_in_plane = draft_->domain.region_in_plane;
  scene.domain.region_in_space = draft_->domain.region_in_space;
  scene.domain.region_content = draft_->domain.region_content;
  scene.domain.region_width = draft_->domain.region_width;
}

}  // namespace rouleau::plan
