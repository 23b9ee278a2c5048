#include "profiles.hpp"

#include "base/curve.hpp"
#include "observe/statistics.hpp"
#include "tables.hpp"

namespace rouleau::files {

std::string profiles_csv(const observe::ProfileHistory& history, const scene::Scene& scene) {
  using Instant = observe::ProfileHistory::Instant;
  std::string text = "stage,position_m";
  for (const std::string name : {"velocity", "hematocrit"}) {
    const std::string unit = name == "velocity" ? "_m_per_s" : "";
    text += "," + name + unit + "," + name + "_standard_error" + unit + "," + name + "_from_s," + name + "_verdict";
  }
  text += "\n";
  for (const auto& [stage, instants] : history.stages()) {
    Column time;
    for (const Instant& instant : instants) time.push_back(instant.time);
    for (int bin = 0; bin < scene.output.profiles->bins; ++bin) {
      text += csv_text(stage) + "," + to_text(observe::place_of_bin(scene, bin));
      for (const auto profile : {&Instant::velocity, &Instant::hematocrit}) {
        Column values;
        for (const Instant& instant : instants) values.push_back((instant.*profile)[static_cast<std::size_t>(bin)]);
        const observe::Statistics known = observe::statistics(time, values);
        const double late = time.size() > 1 ? mean_from(time, values, (time.front() + time.back()) / 2) : values.back();
        for (const double value : {known.steady() ? known.mean : late, known.standard_error, known.from})
          (text += ",") += to_text(value);
        (text += ",") += csv_text(known.verdict);
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace rouleau::files
