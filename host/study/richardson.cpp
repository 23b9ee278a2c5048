#include "richardson.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/text.hpp"

namespace rouleau::study {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr double least_order = 0.5, most_order = 4;
/// Formal order of the lattice Boltzmann and the corrected membranes. A higher one that is observed may be chance, and
/// the uncertainty does not count on it.
constexpr double formal_order = 2;
constexpr double trusted_factor = 1.25, doubted_factor = 3;
constexpr double round_off = 1e-13;  ///< a few hundred epsilon, relative

using Triple = std::array<GridValue, 3>;

/// (f3 - f2)/(f2 - f1) of a series of order p; grows with p.
double difference_ratio(const Triple& t, double order) {
  const double middle = std::log(t[1].spacing / t[0].spacing), coarse = std::log(t[2].spacing / t[0].spacing);
  if (order == 0) return (coarse - middle) / middle;
  return (std::expm1(order * coarse) - std::expm1(order * middle)) / std::expm1(order * middle);
}

/// Limit of the finest two if the order is known.
double limit_with_order(const GridValue& fine, const GridValue& next, double order) {
  return fine.value - (next.value - fine.value) / std::expm1(order * std::log(next.spacing / fine.spacing));
}

/// Limit f0 of f0 + A h^m + B h^(m + 1) through three values.
double limit_with_two_terms(const Triple& t, double order) {
  // Elimination of f0: with x = h/h1, the two differences are A (x^m - 1) + B (x^(m+1) - 1).
  std::array<double, 2> first{}, second{}, difference{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double x = t[i + 1].spacing / t[0].spacing;
    first[i] = std::pow(x, order) - 1;
    second[i] = std::pow(x, order + 1) - 1;
    difference[i] = t[i + 1].value - t[0].value;
  }
  const double determinant = first[0] * second[1] - first[1] * second[0];
  const double a = (difference[0] * second[1] - difference[1] * second[0]) / determinant;
  const double b = (first[0] * difference[1] - first[1] * difference[0]) / determinant;
  return t[0].value - a - b;
}

struct Fit {
  double order, limit, coefficient, residual;
};

/// Weighted least squares of f0 + C (h/h1)^p with a given p; C is for h/h1.
Fit fit_with_order(const std::vector<GridValue>& grids, double order) {
  double w = 0, wx = 0, wf = 0, wxx = 0, wxf = 0;
  const auto each = [&](auto&& visit) {
    for (const GridValue& grid : grids) {
      const double ratio = grid.spacing / grids.front().spacing;
      visit(1 / (ratio * ratio), std::pow(ratio, order), grid.value - grids.front().value);
    }
  };
  each([&](double weight, double x, double f) {
    w += weight;
    wx += weight * x;
    wf += weight * f;
    wxx += weight * x * x;
    wxf += weight * x * f;
  });
  const double c = (w * wxf - wx * wf) / (w * wxx - wx * wx), limit = (wf - c * wx) / w;
  double residual = 0;
  each([&](double weight, double x, double f) { residual += weight * (f - limit - c * x) * (f - limit - c * x); });
  return {order, limit + grids.front().value, c, residual};
}

/// The order with the least residual: scanned, then narrowed down by thirds.
Fit fit(const std::vector<GridValue>& grids) {
  constexpr double step = 0.05;
  Fit best = fit_with_order(grids, least_order);
  for (double order = least_order; order < most_order + step / 2; order += step) {
    const Fit next = fit_with_order(grids, order);
    if (next.residual < best.residual) best = next;
  }
  double low = std::max(least_order, best.order - step), high = std::min(most_order, best.order + step);
  while (high - low > 1e-9) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (fit_with_order(grids, a).residual < fit_with_order(grids, b).residual ? high : low) =
        fit_with_order(grids, a).residual < fit_with_order(grids, b).residual ? b : a;
  }
  return fit_with_order(grids, (low + high) / 2);
}

Convergence convergence_of(const Triple& t, double order) {
  const double fine = t[1].value - t[0].value, coarse = t[2].value - t[1].value;
  const double scale = std::max({std::abs(t[0].value), std::abs(t[1].value), std::abs(t[2].value)});
  const auto equal = [&](double difference, std::size_t a, std::size_t b) {
    return std::abs(difference) <= std::max(round_off * scale, t[a].uncertainty + t[b].uncertainty);
  };
  if (equal(fine, 0, 1) && equal(coarse, 1, 2)) return Convergence::unchanging;
  if (fine * coarse < 0) return Convergence::oscillating;
  if (std::isnan(order)) return Convergence::diverging;
  if (order < least_order) return Convergence::slow;
  return order > most_order ? Convergence::fast : Convergence::asymptotic;
}

std::string remark_of(Convergence convergence, const Triple& t, double order) {
  switch (convergence) {
    case Convergence::asymptotic:
      return "";
    case Convergence::unchanging:
      return "the finest three grids give the same value: no order can be seen";
    case Convergence::slow:
      return "the observed order " + number(order, 2) + " is below 0.5: the grids are not in the asymptotic range";
    case Convergence::fast:
      return (std::isinf(order) ? "the finest two grids give the same value and the next another"
                                : "the observed order " + number(order, 2) + " is above 4") +
             std::string(": the grids are not in the asymptotic range");
    case Convergence::oscillating:
      return "the values " + number(t[2].value) + ", " + number(t[1].value) + ", " + number(t[0].value) +
             " of the finest three grids go up and down: they are not in the asymptotic range";
    case Convergence::diverging:
      return "the differences between the finest three grids do not shrink as a convergent series' do";
    case Convergence::unknown:
      break;
  }
  return "fewer than three grids have a value";
}

/// Largest distance of the limits of all triples of grids from `limit`. Each counts as much as its finest grid is to
/// be trusted against the finest of all.
double spread_of_triples(const std::vector<GridValue>& grids, double limit, double order) {
  double spread = 0;
  for (std::size_t a = 0; a < grids.size(); ++a) {
    for (std::size_t b = a + 1; b < grids.size(); ++b) {
      for (std::size_t c = b + 1; c < grids.size(); ++c) {
        const Triple t{grids[a], grids[b], grids[c]};
        const double observed = observed_order(t);
        double distance = doubted_factor * std::abs(grids.front().value - limit);
        if (convergence_of(t, observed) == Convergence::asymptotic) {
          const double trust = std::pow(grids.front().spacing / t[0].spacing, std::min(order, formal_order));
          distance = trust * std::abs(limit_with_order(t[0], t[1], observed) - limit);
        }
        spread = std::max(spread, distance);
      }
    }
  }
  return spread;
}

/// How far the limit moves when the values of the finest two move by their own uncertainty.
double carried_uncertainty(const Triple& t, double order) {
  const double gain = 1 / std::expm1(order * std::log(t[1].spacing / t[0].spacing));
  return (1 + gain) * t[0].uncertainty + gain * t[1].uncertainty;
}

}  // namespace

double observed_order(const Triple& grids) {
  const double fine = grids[1].value - grids[0].value, coarse = grids[2].value - grids[1].value;
  if (fine == 0) return coarse == 0 ? undefined : std::numeric_limits<double>::infinity();
  const double ratio = coarse / fine;
  if (!(ratio > difference_ratio(grids, 0))) return undefined;
  double low = 0, high = 1;
  while (difference_ratio(grids, high) < ratio) {
    high *= 2;
    if (high > 64) return std::numeric_limits<double>::infinity();
  }
  while (high - low > 1e-12 * high) {
    const double middle = (low + high) / 2;
    (difference_ratio(grids, middle) < ratio ? low : high) = middle;
  }
  return (low + high) / 2;
}

Extrapolation extrapolate(const std::vector<GridValue>& grids) {
  Extrapolation result{Convergence::unknown, undefined, undefined, undefined, undefined, "", {}};
  std::vector<std::size_t> order_of(grids.size());
  std::iota(order_of.begin(), order_of.end(), std::size_t{0});
  std::stable_sort(order_of.begin(), order_of.end(),
                   [&](std::size_t a, std::size_t b) { return grids[a].spacing < grids[b].spacing; });
  std::vector<GridValue> finest;
  for (const std::size_t i : order_of) {
    constexpr std::size_t most_grids = 4;
    if (!std::isfinite(grids[i].value) || !(grids[i].spacing > 0) || finest.size() == most_grids) continue;
    if (!finest.empty() && grids[i].spacing <= finest.back().spacing * (1 + 1e-9)) continue;
    finest.push_back(grids[i]);
    result.used.push_back(i);
  }
  if (finest.size() < 3) {
    result.remark = remark_of(Convergence::unknown, {}, undefined);
    return result;
  }
  const Triple t{finest[0], finest[1], finest[2]};
  const double order = observed_order(t);
  result.convergence = convergence_of(t, order);
  result.remark = remark_of(result.convergence, t, order);

  const GridValue& best = finest.front();
  const auto distance = [&](double other) { return std::abs(other - result.limit); };
  // Limits after other models of the error, which the truth may follow as well as C h^p.
  const double linear = limit_with_order(t[0], t[1], 1), quadratic = limit_with_order(t[0], t[1], formal_order);
  const double linear_quadratic = limit_with_two_terms(t, 1), quadratic_cubic = limit_with_two_terms(t, 2);
  double range = 0, own = 0;
  for (const GridValue& grid : finest) {
    range = std::max(range, std::abs(grid.value - best.value));
    own = std::max(own, grid.uncertainty);
  }

  switch (result.convergence) {
    case Convergence::asymptotic: {
      const Fit fitted = finest.size() > 3 ? fit(finest) : Fit{order, limit_with_order(t[0], t[1], order), 0, 0};
      const bool at_edge = fitted.order < least_order + 1e-6 || fitted.order > most_order - 1e-6;
      result.order = at_edge ? order : fitted.order;
      result.limit = at_edge ? limit_with_order(t[0], t[1], order) : fitted.limit;
      const double correction =
          std::max(distance(best.value), result.order > formal_order ? std::abs(quadratic - best.value) : 0);
      const double spread = std::max({distance(linear_quadratic), distance(quadratic_cubic),
                                      spread_of_triples(finest, result.limit, result.order)});
      result.uncertainty =
          std::max(trusted_factor * correction, spread) + carried_uncertainty(t, std::min(result.order, formal_order));
      break;
    }
    case Convergence::unchanging:
      result.limit = best.value;
      result.uncertainty = std::max(doubted_factor * range, own);
      break;
    case Convergence::fast:
      result.limit = quadratic;
      result.uncertainty = std::max({doubted_factor * distance(best.value), distance(linear_quadratic),
                                     distance(quadratic_cubic), range}) +
                           carried_uncertainty(t, formal_order);
      break;
    case Convergence::slow:
      result.limit = linear;
      result.uncertainty = std::max({doubted_factor * distance(best.value), distance(linear_quadratic),
                                     trusted_factor * distance(limit_with_order(t[0], t[1], order))}) +
                           carried_uncertainty(t, 1);
      break;
    case Convergence::oscillating:
      result.limit = best.value;
      result.uncertainty = std::max({doubted_factor * distance(t[1].value), distance(linear_quadratic) / 2,
                                     doubted_factor * distance(quadratic_cubic), range}) +
                           carried_uncertainty(t, 1);
      break;
    case Convergence::diverging:  // no model of a convergent series fits: there is no limit to tell
    case Convergence::unknown:
      return result;
  }
  // Not from the fit: the finest grid's whole distance from the limit, be it C h^p or not.
  const double power = std::isfinite(result.order) ? result.order : 1;
  result.coefficient = (best.value - result.limit) / std::pow(best.spacing, power);
  return result;
}

}  // namespace rouleau::study
