#include "run/load_balance.hpp"

#include <catch2/catch.hpp>

using rouleau::run::LoadBalance;

TEST_CASE("ranks get other blocks when the slowest is 15 % above the mean, and waiting has cost ten times a cut") {
  LoadBalance balance;
  CHECK_FALSE(balance.due());
  balance.look(1.1, 1.0, 0.001);
  CHECK_FALSE(balance.due());  // nobody waits for long
  balance.look(1.2, 1.0, 0.1);
  CHECK_FALSE(balance.due());  // 0.3 s lost, a cut wants 1 s
  for (int i = 0; i < 3; ++i) balance.look(1.2, 1.0, 0.1);
  CHECK_FALSE(balance.due());
  balance.look(1.2, 1.0, 0.1);
  CHECK(balance.due());
  CHECK(balance.slowest_over_mean() == Approx(1.2));
  balance.begin_again();
  balance.look(1.2, 1.0, 0.1);
  CHECK_FALSE(balance.due());  // what was lost counts since the last cut
}
