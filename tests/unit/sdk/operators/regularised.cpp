#include "source.hpp"

#define rouleau_open_v1 open_regularised
#include "collision/regularised/regularised.cpp"

rouleau::test::OperatorSource rouleau::test::regularised() {
  return {"regularised", open_regularised, with_loops<Regularised>, {}};
}
