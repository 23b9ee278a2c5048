// Studies with values, times and limits that are made up, for tests of what is concluded from them.
#pragma once

#include <cmath>
#include <functional>
#include <limits>

#include "study/analysis.hpp"

namespace rouleau::test {

using namespace study;

/// Two axes: "resolution", the line, and "scheme". Value and time of a point by radius in spacings and scheme.
struct MadeUpStudy {
  std::vector<int> resolutions{10, 15, 20, 30, 40};
  std::vector<std::string> schemes{"plain", "corrected"};
  std::function<double(double radius, int scheme)> value = [](double, int) { return 1.0; };
  std::function<double(double radius, int scheme)> time = [](double radius, int) { return std::pow(radius / 10, 4); };
  ErrorKind error = ErrorKind::relative;
  Reference reference;

  [[nodiscard]] StudyData data() const {
    StudyData study;
    StudyAxis line{"resolution", {}, {}, true};
    for (const int radius : resolutions) {
      line.labels.push_back(std::to_string(radius));
      line.spacing.push_back(1.0 / radius);
    }
    study.axes = {line, StudyAxis{"scheme", schemes, {}, false}};
    study.line = 0;
    study.default_setting = {2, 0};
    Quantity quantity{};
    quantity.name = "deformation";
    quantity.kind = QuantityKind::deformation;
    quantity.error = error;
    quantity.target = 0.01;
    quantity.reference = reference;
    study.quantities = {quantity};
    for (int i = 0; i < static_cast<int>(resolutions.size()); ++i) {
      for (int j = 0; j < static_cast<int>(schemes.size()); ++j) {
        StudyPoint point{{i, j}, std::nan(""), {}};
        run(point);
        study.points.push_back(point);
      }
    }
    return study;
  }
  void run(StudyPoint& point) const {
    const double radius = resolutions[static_cast<std::size_t>(point.setting[0])],
                 found = value(radius, point.setting[1]);
    point.wall_s = std::isfinite(found) ? time(radius, point.setting[1]) : std::nan("");
    point.results = {Measured{found, 0, std::isfinite(found) ? "" : "the run diverged"}};
  }
};

}  // namespace rouleau::test
