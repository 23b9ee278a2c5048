#include "source.hpp"

#define rouleau_open_v1 open_central_moment
#include "collision/central-moment/central-moment.cpp"

rouleau::test::OperatorSource rouleau::test::central_moment() {
  return {"central-moment",
          open_central_moment,
          with_loops<CentralMoment>,
          {{"bulk_rate", 0.8}, {"third_order_rate", 0}, {"fourth_order_rate", 1.1}, {"magic", 0.1875}}};
}
