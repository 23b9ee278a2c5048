// Cells that come in through the openings of a domain, and cells that leave.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "json/json.hpp"
#include "observable.hpp"
#include "snapshot.hpp"

namespace rouleau::scene {
struct Scene;
}

namespace rouleau::observe {

/// Whether cells of a scene may come or leave: then series.csv has the columns of cells' traffic.
bool has_traffic(const scene::Scene& scene);
/// What a run of a scene has.
RunKind kind_of(const scene::Scene& scene);

/// Counts cells that come and leave, and how much volume they and all that flows carry through the open ends, in m3, in
/// two dimensions in m2. Each cell comes and leaves once.
class CellTraffic {
 public:
  static constexpr int no_opening = -1;

  void begin_stage(const std::string& name);
  /// A cell of so much volume is there from now on. `end`: 0, through the lower end, or 1; `no_opening`: it was placed.
  /// `opening`: which of those at the end (core::parts_of_section).
  void came(int cell, double volume, double time, int end, int opening = 0);
  /// It leaves through an end. Throws std::out_of_range for a cell that is not there.
  void left(int cell, double time, int end, int opening = 0);
  /// What all steps of the stage so far have brought in through each opening of both ends, less what left there, cells
  /// included (core::AnyFluid::passed).
  void flowed(const std::array<std::vector<double>, 2>& in_stage);

  /// What has flowed in through the lower end, less what flowed out there, since the run began.
  [[nodiscard]] double come_in() const;
  [[nodiscard]] long in() const { return in_; }  ///< through openings, without those that were placed
  [[nodiscard]] long inside() const { return static_cast<long>(inside_.size()); }
  /// The cells that are there, ascending.
  [[nodiscard]] std::vector<int> there() const;
  [[nodiscard]] long out() const { return out_; }
  void tell(Snapshot& snapshot) const;
  /// summary.json's "cell_traffic": {cells_in, cells_inside, cells_out, residence_time_s: {mean, least, most, cells} of
  /// those that came in and left (null: none did), stages: [{stage, ends: [lower, upper]}]}, each end {cells_in,
  /// cells_out, volume_in, volume_out (of cells), flow_in (all that came in less all that left), unit,
  /// discharge_hematocrit}: the net volume of cells over that of all, null where nothing flowed; and where an end has
  /// several, openings: the same of each. `unit`: of volumes, "m3" or "m2".
  [[nodiscard]] nlohmann::json summary(const std::string& unit) const;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(CellTraffic, inside_, in_, out_, stayed_, residence_, stages_, before_, through_)

 private:
  struct StageTraffic;
  StageTraffic& stage();
  struct Visit {
    double since, volume;
    bool placed;
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Visit, since, volume, placed)
  };
  struct Residence {
    double sum = 0, least = 0, most = 0;  ///< s
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Residence, sum, least, most)
  };
  /// Of an opening, or an end: volume of cells, and of all into the domain.
  struct Passed {
    double in = 0, out = 0, flow = 0;
    long cells_in = 0, cells_out = 0;
    Passed& operator+=(const Passed& more);
    [[nodiscard]] nlohmann::json summary(const std::string& unit) const;
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Passed, in, out, flow, cells_in, cells_out)
  };
  struct StageTraffic {
    std::string name;
    std::array<std::vector<Passed>, 2> ends{};  ///< by opening
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(StageTraffic, name, ends)
  };

  std::map<int, Visit> inside_;
  long in_ = 0, out_ = 0, stayed_ = 0;  ///< stayed: of those that left, the ones that had come in
  Residence residence_;
  std::vector<StageTraffic> stages_;
  std::array<std::vector<double>, 2> before_{};  ///< flow in this stage that is not counted; empty: 0
  std::array<std::vector<long>, 2> through_{};   ///< cells that came in, less those that left, by opening
};

}  // namespace rouleau::observe
