// What a plan says of ranks, against the bytes that they send.
#include "plan/ranks/rank_costs.hpp"
#include "plan/placed_cells.hpp"

#include <atomic>
#include <catch2/catch.hpp>

#include "core/solver/solver.hpp"
#include "plan/plan.hpp"
#include "plan/ranks/blocks.hpp"
#include "plan/solver_setup.hpp"
#include "unit/blocks_fixture.hpp"

namespace rouleau {
namespace {

/// Counts what goes through it.
class Counting final : public core::Transport {
 public:
  explicit Counting(core::Transport* to) : to_(to) {}
  [[nodiscard]] int rank() const override { return to_->rank(); }
  [[nodiscard]] int ranks() const override { return to_->ranks(); }
  void send(int to, core::Message message) override {
    bytes += static_cast<double>(message.size());
    to_->send(to, std::move(message));
  }
  [[nodiscard]] core::Message receive(int from) override { return to_->receive(from); }
  void abandon() noexcept override { to_->abandon(); }
  double bytes = 0;

 private:
  core::Transport* to_;
};

/// Bytes that each rank sends in a step, the mean of four.
template <class T, class Set>
std::vector<double> count_bytes(const plan::Plan& plan, const core::Decomposition<Set::dimension>& blocks) {
  constexpr int steps = 4, dimension = Set::dimension;
  std::vector<double> counted(static_cast<std::size_t>(blocks.ranks()));
  test::on_all_ranks(blocks, [&](const core::Ranks<dimension>& all) {
    Counting transport(all.transport);
    const core::Ranks<dimension> own{&blocks, &transport};
    auto cells = plan.has_cells ? plan::make_cells<dimension>(*plan.scene) : core::Cells<dimension>{};
    auto setup = plan::make_solver_setup<dimension>(plan, 0);
    setup.domain = blocks.domain(transport.rank());
    core::Solver<T, Set> solver(std::move(setup), cells, own);
    solver.start();
    transport.bytes = 0;
    solver.step(steps);
    counted[transport.rank()] = transport.bytes / steps;
  });
  return counted;
}

template <class Set>
void compare_bytes(const test::Case& changed, int ranks) {
  CAPTURE(changed.what, ranks);
  const scene::Scene read = plan::read_scene(changed.file, changed.overrides);
  const plan::Plan plan = plan::make_plan(read, test::catalog());
  const auto blocks = std::get<core::Decomposition<Set::dimension>>(plan::make_blocks(plan, ranks));
  const std::vector<plan::RankCost> planned = plan::rank_costs(plan, blocks);
  const std::vector<double> counted = read.numerics.precision == scene::Precision::f64
                                          ? count_bytes<double, Set>(plan, blocks)
                                          : count_bytes<float, Set>(plan, blocks);
  double sent = 0, expected = 0;
  for (int rank = 0; rank < ranks; ++rank) {
    sent += counted[rank];
    expected += planned[rank].sent_bytes();
    CHECK(planned[rank].sent_bytes() == Approx(counted[rank]).epsilon(0.1));
  }
  CHECK(expected == Approx(sent).epsilon(0.1));
}

}  // namespace

TEST_CASE("ranks send as many bytes in a step as the plan says, within a tenth") {
  const std::string rows = R"(/cells=[{"type": "rbc", "row": {"count": 4, "spacing": "3.2 um", "axis": "y",
      "center": ["25 um", "12.5 um"]}}, {"type": "rbc", "row": {"count": 4, "spacing": "3.2 um", "axis": "y",
      "center": ["75 um", "37 um"]}}, {"type": "rbc", "row": {"count": 4, "spacing": "3.2 um", "axis": "y",
      "center": ["50 um", "24 um"]}}])";
  for (const int ranks : {2, 6, 16}) {
    compare_bytes<core::D2Q9>({"four cells", test::four_cells, {test::shear, test::contrast}}, ranks);
    compare_bytes<core::D2Q9>(
        {"over x, f32", test::four_cells, {test::shear, test::middle("0.4", "12.544"), "/numerics/precision=\"f32\""}},
        ranks);
    compare_bytes<core::D2Q9>({"no cells", test::four_cells, {test::shear, "/cells=[]", "/interactions=[]"}}, ranks);
  }
  compare_bytes<core::D2Q9>(
      {"twelve cells",
       test::four_cells,
       {test::shear, rows, R"(/domain/size=["100.352 um", "50.176 um"])", "/domain/nodes=[512, 256]"}},
      64);
  for (const int ranks : {2, 8}) compare_bytes<core::D3Q19>({"doublet", ROULEAU_SCENES "/doublet-3d.json"}, ranks);
}

}  // namespace rouleau
