#include "bisection.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/text.hpp"

namespace rouleau::stability {

namespace {

struct NotKnown {};

class Search {
 public:
  Search(const SearchRange& range, const Judge& judge) : range_(range), judge_(judge) {}

  EdgeSearch run() {
    try {
      find();
      look_beyond();
    } catch (const NotKnown&) {
      found_.complete = false;
    }
    return std::move(found_);
  }

 private:
  using Direction = StabilityEdge::Direction;

  [[nodiscard]] double between(double a, double b, double part) const {
    const double value = range_.scale == Scale::linear ? a + part * (b - a) : a * std::pow(b / a, part);
    return rounded_value(value, range_.whole);
  }
  [[nodiscard]] bool narrow(double a, double b) const {
    const double low = std::min(a, b), high = std::max(a, b);
    if (range_.whole && high - low <= 1) return true;
    return range_.scale == Scale::linear ? high - low <= range_.precision : high <= low * range_.precision;
  }

  bool stable(double value) {
    const auto known = known_.find(value);
    if (known != known_.end()) return known->second;
    const std::optional<bool> judged = judge_(value);
    if (!judged) throw NotKnown();
    found_.tried.push_back(value);
    return known_[value] = *judged;
  }

  void find() {
    const double from = rounded_value(range_.from, range_.whole), to = rounded_value(range_.to, range_.whole);
    const bool low = stable(from), high = stable(to);
    if (low && high) {
      found_.edges.push_back({Direction::above, to, {}});
    } else if (low) {
      bisect(from, to);
    } else if (high) {
      bisect(to, from);
    } else {
      for (const double part : {0.5, 0.25, 0.75}) {
        const double middle = between(from, to, part);
        if (!stable(middle)) continue;
        bisect(middle, from);
        bisect(middle, to);
        return;
      }
      found_.edges.push_back({Direction::above, {}, from});
    }
  }

  void bisect(double good, double bad) {
    while (!narrow(good, bad)) {
      const double middle = between(good, bad, 0.5);
      if (middle == good || middle == bad) break;
      (stable(middle) ? good : bad) = middle;
    }
    found_.edges.push_back({good < bad ? Direction::above : Direction::below, good, bad});
  }

  /// The middle of each part of the range that the edges leave, which bisection may have jumped over.
  void look_beyond() {
    std::vector<double> borders{rounded_value(range_.from, range_.whole), rounded_value(range_.to, range_.whole)};
    for (const StabilityEdge& edge : found_.edges) {
      for (const auto& border : {edge.stable_up_to, edge.unstable_from})
        if (border) borders.push_back(*border);
    }
    std::sort(borders.begin(), borders.end());
    for (std::size_t i = 1; i < borders.size(); ++i)
      if (!narrow(borders[i - 1], borders[i])) (void)stable(between(borders[i - 1], borders[i], 0.5));
    for (const auto& [value, is_stable] : known_)
      if (is_stable != expected(value)) found_.out_of_order.push_back(value);
  }

  /// What the edges say of a value.
  [[nodiscard]] bool expected(double value) const {
    return std::all_of(found_.edges.begin(), found_.edges.end(), [value](const StabilityEdge& edge) {
      if (!edge.stable_up_to) return false;
      if (!edge.unstable_from) return true;
      return edge.direction == Direction::above ? value <= *edge.stable_up_to : value >= *edge.stable_up_to;
    });
  }

  const SearchRange& range_;
  const Judge& judge_;
  std::map<double, bool> known_;
  EdgeSearch found_;
};

}  // namespace

double rounded_value(double value, bool whole) {
  if (whole) return std::round(value);
  return std::stod(number(value));
}

EdgeSearch find_edges(const SearchRange& range, const Judge& judge) { return Search(range, judge).run(); }

}  // namespace rouleau::stability
