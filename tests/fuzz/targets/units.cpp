// Units and quantities, as scenes and manifests write them.
#include "units/units.hpp"

#include <cmath>

#include "target.hpp"

using namespace rouleau;

namespace {

template <class Work>
void may_be_no_unit(Work work) {
  try {
    work();
  } catch (const units::UnitError& error) {
    if (std::string_view(error.what()).empty()) fuzz::broken_promise("a unit is refused without words", "");
    fuzz::require_printable(error.what());
  }
}

}  // namespace

void fuzz_target(std::string_view bytes) {
  static const units::Units units;
  for (const char* wanted : {"m", "1", "rad", "Pa s", "K", "J/m2", "cm3 mol/g2"}) {
    may_be_no_unit([&] {
      if (!std::isfinite(units.to_si(bytes, wanted, "this"))) fuzz::broken_promise("not finite", std::string(bytes));
    });
  }
  may_be_no_unit([&] { static_cast<void>(units.dimension(bytes)); });
  may_be_no_unit([&] {
    const double scale = units.scale(bytes);
    if (!std::isfinite(scale) || !(scale > 0)) fuzz::broken_promise("a unit without a size", std::string(bytes));
    // What is a unit by itself must be one behind a number, too.
    const double two = units.to_si("2 " + std::string(bytes), bytes, "this");
    if (two != 2 * scale && std::isfinite(2 * scale)) fuzz::broken_promise("twice a unit", std::string(bytes));
  });
}

fuzz::Form fuzz_form() { return {}; }
