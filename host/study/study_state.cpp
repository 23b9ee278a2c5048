#include "study_state.hpp"

#include <algorithm>
#include <cmath>

#include "trial/median_range.hpp"

namespace rouleau::study {

namespace {

StudyAxis axis_data(const trial::Axis& axis) {
  StudyAxis data{axis.name, {}, {}, true};
  for (const trial::Setting& setting : axis.settings) {
    data.labels.push_back(setting.label);
    data.ordered = data.ordered && std::isfinite(setting.position);
    // Radii or heights in spacings: only ratios matter.
    if (axis.refines) data.spacing.push_back(1 / setting.position);
  }
  return data;
}

}  // namespace

bool StudyState::complete() const {
  return std::all_of(points.begin(), points.end(), [](const MatrixPoint& point) { return point.left_out.empty(); });
}

void measure_point(const Study& study, MatrixPoint& point, const std::filesystem::path& directory) {
  point.results.clear();
  for (const Quantity& quantity : study.quantities) {
    if (point.record->end == trial::TrialEnd::completed) {
      point.results.push_back(measure(quantity, directory));
    } else {
      point.results.push_back({NAN, 0, "the run did not complete: " + trial::to_string(point.record->end)});
    }
  }
}

StudyData study_data(const StudyState& state) {
  const Study& study = *state.study;
  StudyData data;
  for (const trial::Axis& axis : study.axes) data.axes.push_back(axis_data(axis));
  data.line = study.line;
  data.default_setting = study.default_point.setting;
  data.quantities = study.quantities;
  for (const MatrixPoint& point : state.points) {
    std::vector<double> times;
    if (point.record && point.record->end == trial::TrialEnd::completed) {
      for (const trial::TimedRun& run : point.record->runs) times.push_back(run.wall_s);
    }
    const trial::MedianRange wall = trial::median_range(times);
    data.points.push_back({point.point.setting, wall.median, point.results, {wall.least, wall.most}});
  }
  return data;
}

}  // namespace rouleau::study
