// What a plan says of ranks, against the bytes that they send.
#include "plan/rank_costs.hpp"

#include <atomic>
#include <catch2/catch.hpp>

#include "core/solver/solver.hpp"
#include "plan/blocks.hpp"
#include "plan/plan.hpp"
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

}  // namespace

TEST_CASE("ranks send as many bytes in a step as the plan says, within a tenth") {
  for (const test::Case& changed :
       {test::Case{"four cells", test::four_cells, {test::shear, test::contrast}},
        test::Case{"over x, f32",
                   test::four_cells,
                   {test::shear, test::middle("0.4", "12.544"), "/numerics/precision=\"f32\""}},
        test::Case{"no cells", test::four_cells, {test::shear, "/cells=[]", "/interactions=[]"}}}) {
    for (const int ranks : {2, 6, 16}) {
      CAPTURE(changed.what, ranks);
      const scene::Scene read = plan::read_scene(changed.file, changed.overrides);
      const plan::Plan plan = plan::make_plan(read, test::catalog());
      const auto blocks = std::get<core::Decomposition<2>>(plan::make_blocks(plan, ranks));
      const std::vector<plan::RankCost> planned = plan::rank_costs(plan, blocks);
      constexpr int steps = 4;
      std::vector<double> counted(static_cast<std::size_t>(ranks));
      const auto count = [&](auto real, const core::Ranks<2>& all) {
        Counting transport(all.transport);
        const core::Ranks<2> own{&blocks, &transport};
        core::Membranes membranes =
            plan.has_cells ? plan::make_membranes(read, plan::lattice_spacing(read)) : core::Membranes{};
        core::SolverSetup setup = plan::make_solver_setup(plan, 0);
        setup.domain = blocks.domain(transport.rank());
        core::Solver<decltype(real)> solver(std::move(setup), membranes, own);
        solver.start();
        transport.bytes = 0;
        solver.step(steps);
        counted[transport.rank()] = transport.bytes / steps;
      };
      test::on_all_ranks(blocks, [&](const core::Ranks<2>& all) {
        if (read.numerics.precision == scene::Precision::f64) {
          count(double{}, all);
        } else {
          count(float{}, all);
        }
      });
      double sent = 0, expected = 0;
      for (int rank = 0; rank < ranks; ++rank) {
        sent += counted[rank];
        expected += planned[rank].sent_bytes();
        CHECK(planned[rank].sent_bytes() == Approx(counted[rank]).epsilon(0.1));
      }
      CHECK(expected == Approx(sent).epsilon(0.1));
    }
  }
}

}  // namespace rouleau
