#include "error_bars.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/text.hpp"
#include "json/shown.hpp"

namespace rouleau::accuracy {

namespace {

using Json = nlohmann::json;

// Measured with capsules (docs/accuracy.md, "Error bars").
constexpr double doubt_of_a_share = 0.5, least_part_of_deformation = 0.75;
/// Coarse lattices answer to another density otherwise than the run does: near walls by half as much, or twice.
constexpr double doubt_of_inertia = 1;

const Quantity* find(const std::vector<Quantity>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Quantity& q) { return q.name == name; });
  return found == all.end() ? nullptr : &*found;
}

/// Value of a quantity in the run and in each companion.
struct Values {
  double run = 0;
  std::vector<double> companions;
};

/// Early events err as the Reynolds number to the power 0.7 (docs/accuracy.md, passage of 45 deg), so that what is
/// added with the density shows less than in proportion; what is taken away with it shows more.
constexpr double least_power_of_density = 0.7;

/// Change of the error between a companion of this relative density and the run, over the run's error.
double change_by_density(double density) {
  return 1 - (density < 1 ? density : std::pow(density, least_power_of_density));
}

/// Shares of a quantity that all companions have, or all but the one for the order.
struct FoundShares {
  Shares shares;
  double doubt = 0;  ///< of their sum
};

LatticeShare share_of_lattice(double run, const std::vector<double>& values, const Companions& companions,
                              const std::vector<Measured>& measured) {
  double coarsest = std::nan("");
  for (std::size_t i = 0; i < measured.size(); ++i)
    if (measured[i].role == Role::order) coarsest = values[i];
  const double s = std::isfinite(coarsest) ? companions.coarsest : 1;
  return lattice_share(run, values[0], companions.refinement, coarsest, s, companions.order, companions.usual_order);
}

FoundShares shares_of(const Values& values, const Companions& companions, const std::vector<Measured>& measured) {
  FoundShares found;
  const LatticeShare lattice = share_of_lattice(values.run, values.companions, companions, measured);
  found.shares.lattice = lattice.error;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const int against = companions.runs[i].against;
    const double value = values.companions[i],
                 before = against < 0 ? values.run : values.companions[static_cast<std::size_t>(against)];
    if (measured[i].role == Role::start) found.shares.start = before - value;
    if (measured[i].role == Role::inertia)
      found.shares.inertia = companions.relaxed * (before - value) / change_by_density(companions.density);
  }
  found.doubt = lattice.doubt + doubt_of_a_share * std::abs(found.shares.start) +
                doubt_of_inertia * std::abs(found.shares.inertia);
  return found;
}

std::string words_of(const Shares& shares, const std::vector<Measured>& measured) {
  std::string words;
  for (const Measured& companion : measured) {
    if (!words.empty()) words += ", ";
    const std::string differs = " (" + companion.differs + ")";
    if (companion.role == Role::lattice) words += "lattice " + number(shares.lattice, 2) + differs;
    if (companion.role == Role::order) words += "its order by " + companion.differs;
    if (companion.role == Role::start) words += "start " + number(shares.start, 2) + differs;
    if (companion.role == Role::inertia) words += "relaxed density " + number(shares.inertia, 2) + differs;
  }
  return words;
}

ErrorBar count_bar(const Quantity& quantity, const Values& values) {
  ErrorBar bar{quantity, {}, 0, 0, {}};
  std::string others;
  for (const double value : values.companions) {
    if (std::isnan(value)) continue;
    bar.error = std::max(*bar.error, std::abs(value - quantity.value));
    others += (others.empty() ? "" : ", ") + number(value);
  }
  bar.estimate = *bar.error;
  bar.how = *bar.error == 0 ? "the same in every companion" : "in the companions " + others;
  return bar;
}

/// How the companions' cells end otherwise than the run's.
std::string other_end(const std::vector<Quantity>& run, const std::vector<Measured>& measured) {
  const Quantity* own = find(run, "aggregates");
  for (const Measured& companion : measured) {
    const Quantity* other = find(companion.quantities, "aggregates");
    if (own != nullptr && other != nullptr && own->value != other->value) {
      return "; cells aggregate otherwise with " + companion.differs + " (" + number(other->value) +
             " aggregates, not " + number(own->value) + "), so that this is the difference of two histories";
    }
  }
  return {};
}

int decimals_of(double error) {
  const double exponent = std::floor(std::log10(error));
  const bool begins_with_one = error / std::pow(10, exponent) < 2;
  return static_cast<int>(-exponent) + (begins_with_one ? 1 : 0);
}

/// Relative share of the lattice in the deformation; 0 where there is none.
double shape_error(const std::vector<Quantity>& run, const Companions& companions,
                   const std::vector<Measured>& measured) {
  const Quantity* own = find(run, "deformation");
  if (own == nullptr || own->value == 0) return 0;
  std::vector<double> values;
  for (const Measured& companion : measured) {
    const Quantity* other = find(companion.quantities, "deformation");
    values.push_back(other != nullptr ? other->value : std::nan(""));
  }
  const double share = std::abs(share_of_lattice(own->value, values, companions, measured).error / own->value);
  return std::isfinite(share) ? share : 0;
}

bool is_angle(const Quantity& quantity) { return quantity.name.ends_with("angle_rad"); }

}  // namespace

LatticeShare lattice_share(double value, double coarse, double r, double coarser, double s, double p, double q) {
  const double change = coarse - value, low = std::pow(r, p) - 1, high = std::pow(r, 2 * p) - 1;
  const double plain = change / low, usual = change / (std::pow(r, q) - 1);
  const double doubt_of_usual = std::max(doubt_of_a_share * std::abs(usual), std::abs(plain - usual));
  if (s == 1 || change == 0) return {usual, doubt_of_usual};
  const double further = coarser - value;
  if (further / change < 1) return {usual, std::max(doubt_of_usual, std::abs(further) / low)};  // no more wrong
  const double low_s = std::pow(s, p) - 1, high_s = std::pow(s, 2 * p) - 1;
  const double b = (further * low - change * low_s) / (high_s * low - high * low_s), a = (change - b * high) / low;
  const double part = std::clamp((a + b) / plain, low / high, 2.0);
  const double error = part * plain;
  return {error, std::max(doubt_of_a_share * std::abs(error), std::abs(error - plain))};
}

std::vector<ErrorBar> error_bars(const std::vector<Quantity>& run, const Companions& companions,
                                 const std::vector<Measured>& measured) {
  std::vector<ErrorBar> bars;
  const std::string otherwise = other_end(run, measured);
  const double shape = shape_error(run, companions, measured);
  for (const Quantity& quantity : run) {
    ErrorBar bar{quantity, {}, 0, {}, {}};
    Values values{quantity.value, {}};
    double uncertainty = quantity.uncertainty;
    for (const Measured& companion : measured) {
      const Quantity* other = find(companion.quantities, quantity.name);
      if (other == nullptr) {
        values.companions.push_back(std::nan(""));
        if (bar.how.empty() && companion.role != Role::order)
          bar.how = "the companion with " + companion.differs + " has none to compare with";
        continue;
      }
      values.companions.push_back(other->value);
      uncertainty = std::max(uncertainty, other->uncertainty);
    }
    if (bar.how.empty() && quantity.nature == Nature::count) {
      bar = count_bar(quantity, values);
    } else if (bar.how.empty()) {
      const FoundShares found = shares_of(values, companions, measured);
      bar.shares = found.shares;
      const auto& [lattice, start, inertia] = bar.shares;
      const double least = least_part_of_deformation * shape * std::abs(quantity.part_of_cells);
      bar.estimate = std::max(std::abs(lattice + start + inertia), least) + uncertainty;
      bar.error = bar.estimate + found.doubt;
      bar.how = words_of(bar.shares, measured);
      if (uncertainty > 0) bar.how += ", between outputs " + number(uncertainty, 2);
      bar.how += otherwise;
      if (!std::isfinite(*bar.error)) bar = {quantity, {}, 0, {}, "a companion has no finite value"};
    }
    bars.push_back(std::move(bar));
  }
  return bars;
}

Json to_json(const std::vector<ErrorBar>& bars) {
  Json all = Json::object();
  for (const ErrorBar& bar : bars) {
    all[bar.quantity.name] = {{"value", json::number_or_null(bar.quantity.value)},
                              {"error", bar.error ? Json(*bar.error) : Json()},
                              {"how", bar.how}};
  }
  return all;
}

std::string with_error(double value, double error) {
  if (!(error > 0)) return number(value) + " +- 0";
  if (std::abs(value) < 1e-3 || error < 1e-9 || std::abs(value) >= 1e6) {  // a common power of ten
    const double power = std::pow(10, std::floor(std::log10(std::max(std::abs(value), error))));
    if (power != 1) return "(" + with_error(value / power, error / power) + ") x " + number(power);
  }
  const int last = decimals_of(error), shown = std::max(0, last);
  const double digit = std::pow(10, -last);
  const double rounded = std::ceil(error / digit * (1 - 1e-12)) * digit;
  return decimals(value, shown) + " +- " + decimals(rounded, shown);
}

std::vector<std::string> sentences(const std::vector<ErrorBar>& bars) {
  std::vector<std::string> all;
  for (const ErrorBar& bar : bars) {
    if (!bar.quantity.principal || !bar.error) continue;
    const bool angle = is_angle(bar.quantity);
    const double factor = angle ? 180 / std::numbers::pi : 1;
    std::string name = bar.quantity.name;
    if (angle) name.replace(name.size() - 4, 4, "");
    std::replace(name.begin(), name.end(), '_', ' ');
    all.push_back(name + " " + with_error(factor * bar.quantity.value, factor * *bar.error) + (angle ? " deg" : ""));
  }
  return all;
}

std::optional<Worst> worst(const std::vector<ErrorBar>& bars) {
  std::optional<Worst> found;
  const auto counts = [](const ErrorBar& bar) {
    return bar.quantity.principal && bar.error && bar.quantity.value != 0;
  };
  const bool moments =
      std::any_of(bars.begin(), bars.end(), [&](const ErrorBar& bar) { return counts(bar) && bar.quantity.moment; });
  for (const ErrorBar& bar : bars) {
    if (!counts(bar) || bar.quantity.moment != moments) continue;
    const Quantity& q = bar.quantity;
    const double whole = is_angle(q) ? 1 : std::max(std::abs(q.value), q.least_whole), error = bar.estimate / whole;
    const auto& [lattice, start, inertia] = bar.shares;
    if (!found || error > found->error) {
      found = {error,
               bar.quantity.name,
               {lattice / whole, start / whole, inertia / whole},
               bar.quantity.uncertainty / whole};
    }
  }
  return found;
}

}  // namespace rouleau::accuracy
