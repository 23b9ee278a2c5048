#include "differences.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.hpp"
#include "conform/call.hpp"

namespace rouleau::conform {

namespace {

// Every slope is taken with steps that shrink by fours, each by central differences of eighth, sixth and fourth order:
// how far these are from each other bounds the error of the first where the function is smooth across the step. Where
// it has a kink or a jump within the step that bound is large or, close by, wrong; a step that is small enough not to
// reach it is right again. Hence a claim fails only when the two steps with the smallest bounds both contradict it.
constexpr int step_sizes = 7, reach = 4, probes = 16;
constexpr int points = step_sizes * 2 * reach + probes;

/// The largest step: 2 % of a quantity, which all the singularities of usual laws are further away than. No host asks
/// for anything beyond a cutoff.
double largest_step(const Trial& trial, const std::string& variable, double value) {
  if (variable == "distance") {
    const double left = trial.instance.interaction().cutoff(trial.instance.self()) - value;
    return std::clamp(left / reach, 1e-9 * value, 0.02 * value);
  }
  if (variable == "stretch_rate") return 2e-5;
  if (variable == "curvature") return 0.02 * std::max(std::abs(value), 0.05);
  if (variable == "invariant_1") return 0.02 * (value + 2);  // stretches are positive
  if (variable == "invariant_2") return 0.02 * (value + 1);
  return 0.02 * std::abs(value);
}

/// Offset of a point from the element: first all differences, then the probes of rounding noise.
double offset(int point, double largest) {
  if (point >= step_sizes * 2 * reach) {
    // So near that the function is a straight line but for rounding, its own and that of the abscissa; not evenly
    // spaced, for along an even row what is cut off may be the same everywhere.
    const double golden = 0.6180339887498949 * (point - step_sizes * 2 * reach);
    return (golden - std::floor(golden)) * largest * std::ldexp(1.0, -24);
  }
  const int step = point / (2 * reach), side = point % (2 * reach);
  const int multiple = side < reach ? -(side + 1) : side - reach + 1;
  return multiple * largest / std::pow(4.0, step);
}

/// All slopes of one element, with `f(point)`; `of_rounding`: what rounding of parameters and inputs does to f.
template <class F>
std::array<Slope, step_sizes> all_slopes(double value, double largest, double of_rounding, const F& f) {
  // The first two probes lie wide apart: the line through them.
  const int first = step_sizes * 2 * reach;
  const double x0 = offset(first, largest), rise = (f(first + 1) - f(first)) / (offset(first + 1, largest) - x0);
  // Numbers below the smallest normal one have fewer digits.
  double noise = std::max(of_rounding, epsilon * std::abs(f(first)) + std::numeric_limits<double>::min());
  for (int p = first + 2; p < first + probes; ++p) {
    noise = std::max(noise, std::abs(f(p) - f(first) - rise * (offset(p, largest) - x0)));
  }
  // Near to rest, or to a cutoff, a function is small, but not the terms that cancel there: they are of the size that
  // its curvature has over the whole of the variable.
  const double curved = std::abs(f(reach) - 2 * f(first) + f(0)), ratio = std::abs(value) / largest;
  noise = std::max(noise, epsilon * curved * ratio * ratio);
  // What the rounding of the abscissa itself makes of a slope, where steps are small beside it.
  const double slope = std::abs(f(reach) - f(0)) / (2 * largest);
  noise = std::max(noise, epsilon / 4 * std::abs(value) * slope);
  std::array<Slope, step_sizes> result;
  for (int step = 0; step < step_sizes; ++step) {
    const double h = largest / std::pow(4.0, step);
    std::array<double, reach> difference{};
    double noise_here = noise;
    for (int j = 0; j < reach; ++j) {
      const double below = f(step * 2 * reach + j), above = f(step * 2 * reach + reach + j);
      difference[j] = above - below;
      noise_here = std::max({noise_here, epsilon * std::abs(above), epsilon * std::abs(below)});
    }
    const auto& [a, b, c, d] = difference;
    const double fourth = (2.0 / 3 * a - 1.0 / 12 * b) / h;
    const double sixth = (3.0 / 4 * a - 3.0 / 20 * b + 1.0 / 60 * c) / h;
    const double eighth = (4.0 / 5 * a - 1.0 / 5 * b + 4.0 / 105 * c - 1.0 / 280 * d) / h;
    // Eight and four times also cover a kink in the slope that lies in the middle of the step. The noise was seen at
    // some points of many, and the sizes of the eighth order's coefficients add up to 2.1.
    const double error = 8 * std::abs(eighth - sixth) + 4 * std::abs(eighth - fourth) + 16 * noise_here / h;
    result[step] = {eighth, error, false};
  }
  return result;
}

/// What rounding does to outputs where terms cancel: probes so close that they all round alike do not show it, but
/// other roundings of the parameters do, which change each term on its own.
Values roundings(const Subject& subject, const Trial& trial, const Values& inputs) {
  Random random = subject.random();
  Call call;
  call.time_step = subject.manifest().state.empty() ? 1 : 0;
  return sensitivity(subject, trial, inputs, random, 1, false,
                     [&](const auto& instance, const Values& near) { return compute(subject, instance, near, call); });
}

/// A bound beyond a ten-thousandth of the slope itself is no evidence.
bool tells(double error, double size) { return error <= 1e-4 * size; }

std::vector<std::array<Slope, step_sizes>> ladder(const Subject& subject, const Trial& trial, const Values& inputs,
                                                  const std::string& function, const std::string& variable) {
  const std::size_t count = inputs.at(variable).size();
  Values many;
  for (const auto& [name, values] : inputs) {
    auto& array = many[name];
    array.reserve(count * points);
    for (std::size_t i = 0; i < count; ++i) {
      const double largest = name == variable ? largest_step(trial, variable, values[i]) : 0;
      for (int p = 0; p < points; ++p) array.push_back(values[i] + offset(p, largest));
    }
  }
  Call call;
  call.time_step = subject.manifest().state.empty() ? 1 : 0;
  const auto results = compute(subject, trial.instance, many, call).at(function);
  const auto of_rounding = roundings(subject, trial, inputs).at(function);
  std::vector<std::array<Slope, step_sizes>> all;
  for (std::size_t i = 0; i < count; ++i) {
    all.push_back(all_slopes(inputs.at(variable)[i], largest_step(trial, variable, inputs.at(variable)[i]),
                             of_rounding[i], [&](int p) { return results[i * points + static_cast<std::size_t>(p)]; }));
  }
  return all;
}

}  // namespace

void compare_derivative(Worst& worst, Decided& decided, const Subject& subject, const Trial& trial,
                        const Values& inputs, const DerivativeClaim& claim) {
  Call call;
  call.time_step = subject.manifest().state.empty() ? 1 : 0;
  const auto claimed = compute(subject, trial.instance, inputs, call).at(claim.derivative);
  const auto all = ladder(subject, trial, inputs, claim.function, claim.variable);
  const auto of_rounding = roundings(subject, trial, inputs).at(claim.derivative);
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<Slope> telling;
    for (Slope slope : all[i]) {
      slope.value *= claim.sign;
      slope.error += 16 * (of_rounding[i] + epsilon * std::abs(claimed[i]));
      // Where no cell comes to, series and quadratures may end.
      const double stretch = claim.variable == "stretch" ? inputs.at("stretch")[i] : 1;
      if (stretch < 0.25 || stretch > 4) slope.error += 1e-6 * std::abs(claimed[i]);
      const bool of_use = tells(slope.error, std::max(std::abs(slope.value), std::abs(claimed[i])));
      // Outputs that are no numbers always tell something.
      if (of_use || !std::isfinite(slope.value) || !std::isfinite(claimed[i])) telling.push_back(slope);
    }
    if (telling.size() < 2) {
      if (claimed[i] != 0) ++decided.no;  // a derivative of 0, out of which no slope stands, is what is claimed
      continue;
    }
    ++decided.yes;
    std::partial_sort(telling.begin(), telling.begin() + 2, telling.end(),
                      [](const Slope& a, const Slope& b) { return a.error < b.error; });
    const auto ratio = [&](const Slope& slope) { return std::abs(claimed[i] - slope.value) / slope.error; };
    const Slope& kinder = ratio(telling[1]) < ratio(telling[0]) ? telling[1] : telling[0];
    worst.add(std::abs(claimed[i] - kinder.value), kinder.error, [&, i] {
      return claim.derivative + ' ' + in_si(subject, trial.setting, claim.derivative, claimed[i], 17) + " where " +
             (claim.sign < 0 ? "-" : "") + 'd' + claim.function + "/d" + claim.variable + " is " +
             in_si(subject, trial.setting, claim.derivative, kinder.value, 17) + ", at " +
             place(subject, trial.setting, inputs, i) + trial.words + "; in lattice units they differ by";
    });
  }
}

void compare_work(Worst& worst, const Subject& subject, const Trial& trial, const Values& element,
                  const DerivativeClaim& claim, double low, double high) {
  // Five points to an interval: its ends, its quarters and its middle.
  constexpr std::size_t intervals = 800;
  Values many;
  for (const auto& [name, values] : element) many[name].assign(4 * intervals + 1, values[0]);
  auto& x = many[claim.variable];
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k] = low + (high - low) * static_cast<double>(k) / static_cast<double>(4 * intervals);
  }
  const Values outputs = compute(subject, trial.instance, many);
  const Values of_rounding = roundings(subject, trial, many);
  const auto &f = outputs.at(claim.derivative), &energy = outputs.at(claim.function);
  const auto &of_f = of_rounding.at(claim.derivative), &of_energy = of_rounding.at(claim.function);
  for (std::size_t i = 0; i < intervals; ++i) {
    const std::size_t k = 4 * i;
    const double step = x[k + 4] - x[k];
    const double boole = step / 90 * (7 * f[k] + 32 * f[k + 1] + 12 * f[k + 2] + 32 * f[k + 3] + 7 * f[k + 4]);
    const double simpson = step / 6 * (f[k] + 4 * f[k + 2] + f[k + 4]), trapezoid = step / 2 * (f[k] + f[k + 4]);
    const double work = claim.sign * boole, gained = energy[k + 4] - energy[k];
    // Terms that cancel at rest or at the cutoff are of the size that the force's slope has over the whole of x.
    const double far = std::max(std::abs(x[k]), std::abs(x[k + 4]));
    const double size = std::abs(energy[k]) + std::abs(energy[k + 4]) + far * (std::abs(f[k]) + std::abs(f[k + 4])) +
                        far * far * std::abs(f[k + 4] - f[k]) / step;
    const double limit = 8 * std::abs(boole - simpson) + 8 * std::abs(simpson - trapezoid) + 4096 * epsilon * size +
                         1e-8 * std::abs(work) + 16 * (of_energy[k] + of_energy[k + 4]) +
                         16 * step * (of_f[k] + of_f[k + 2] + of_f[k + 4]) +
                         (1 + far) * std::numeric_limits<double>::min();  // numbers below have fewer digits
    worst.add(std::abs(gained - work), limit, [&] {
      return claim.function + " changes by " + number(gained, 17) + " where the work of " + claim.derivative + " is " +
             number(work, 17) + ", in lattice units, between " + claim.variable + ' ' +
             in_si(subject, trial.setting, claim.variable, x[k], 8) + " and " +
             in_si(subject, trial.setting, claim.variable, x[k + 4], 8) + trial.words + "; they differ by";
    });
  }
}

std::vector<Slope> slopes(const Subject& subject, const Trial& trial, const Values& inputs, const std::string& function,
                          const std::string& variable) {
  std::vector<Slope> best;
  for (const auto& all : ladder(subject, trial, inputs, function, variable)) {
    Slope slope =
        *std::min_element(all.begin(), all.end(), [](const Slope& a, const Slope& b) { return a.error < b.error; });
    slope.decided = tells(slope.error, std::abs(slope.value)) || slope.error == 0;
    best.push_back(slope);
  }
  return best;
}

}  // namespace rouleau::conform
