#include "run/load_balance.hpp"

#include <catch2/catch.hpp>

using rouleau::run::LoadBalance;

TEST_CASE("ranks get other blocks when the slowest is 15 % above the mean, and waiting has cost ten times a cut") {
  LoadBalance balance;
  CHECK_FALSE(balance.due());
  balance.look(1.1, 1.0, 0.001);
  CHECK_FALSE(balance.due());  // nobody waits for long
  balance.look(2.4, 2.0, 0.1);
  CHECK_FALSE(balance.due());  // 0.4 s lost, a cut wants 1 s
  balance.look(4.9, 4.0, 0.1);
  CHECK_FALSE(balance.due());
  balance.look(6.1, 5.0, 0.1);
  CHECK(balance.due());
  CHECK(balance.slowest_over_mean() == Approx(1.22));
  balance.begin();
  CHECK_FALSE(balance.due());
}

TEST_CASE("a period in which nobody waits for long is forgotten, one in which somebody does is not") {
  LoadBalance balance;
  for (int i = 1; i < LoadBalance::period; ++i) {
    balance.look(1.01 * i, i, 0.1);
    CHECK_FALSE(balance.over());
  }
  balance.look(1.01 * LoadBalance::period, LoadBalance::period, 0.1);
  CHECK(balance.over());
  balance.begin();
  for (int i = 1; i <= 3 * LoadBalance::period; ++i) balance.look(1.3 * i, i, 100);
  CHECK_FALSE(balance.over());
}
