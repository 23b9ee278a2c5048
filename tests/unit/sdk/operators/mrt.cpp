#include "source.hpp"

#define rouleau_open_v1 open_mrt
#include "collision/mrt/mrt.cpp"

rouleau::test::OperatorSource rouleau::test::mrt() {
  return {"mrt",
          open_mrt,
          with_loops<Mrt>,
          {{"energy_rate", 1.64}, {"energy_square_rate", 1.54}, {"heat_flux_rate", 0}, {"magic", 0.1875}}};
}
