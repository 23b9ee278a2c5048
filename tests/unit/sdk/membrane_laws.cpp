// The shipped membrane laws one by one: moduli, rest states, and the two-dimensional materials they come from.
#include <catch2/catch.hpp>
#include <functional>

#include "shipped_models.hpp"

using namespace rouleau::test;

namespace {

Shipped neo_hookean(double modulus, bool clamped) {
  return {*open_neo_hookean(0), {{{"shear_modulus", modulus}, {"transverse", clamped ? 1.0 : 0.0}}}};
}
Shipped skalak(double modulus, double area, bool clamped) {
  return {*open_skalak(0),
          {{{"shear_modulus", modulus}, {"area_dilation", area}, {"transverse", clamped ? 1.0 : 0.0}}}};
}

/// Strain energy per rest area of a membrane stretched by a and b along two directions, over its shear modulus.
using Material = std::function<long double(long double a, long double b)>;

long double neo_hookean_material(long double a, long double b) { return (a * a + b * b + 1 / (a * a * b * b) - 3) / 2; }
Material skalak_material(long double area) {
  return [=](long double a, long double b) {
    const long double first = a * a + b * b - 2, second = a * a * b * b - 1;
    return (first * first + 2 * first - 2 * second + area * second * second) / 4;
  };
}

// In long double the differences below are exact to 1e-10: h^2 from truncation, epsilon/h from rounding.
constexpr long double h = 1e-6L;

/// Stretch across at which there is no tension across: where the energy is least.
long double free_width(const Material& material, long double stretch) {
  long double low = 0.02L, high = 10;
  for (int i = 0; i < 80; ++i) {
    const long double middle = (low + high) / 2;
    (material(stretch, middle + h) < material(stretch, middle - h) ? low : high) = middle;
  }
  return low;
}

/// Tension along, per stretched width.
double tension(const Material& material, long double stretch, long double width) {
  return static_cast<double>((material(stretch + h, width) - material(stretch - h, width)) / (2 * h * width));
}

struct CellValues {
  double energy, pressure, perimeter_tension;
};
CellValues cell(const rouleau_plugin& plugin, const Setup& setup, double area, double perimeter) {
  const Self self = make(*plugin.models[0], setup);
  const double rest_area = 80, rest_perimeter = 40;
  CellValues values{};
  rouleau_membrane_block block{};
  block.struct_size = sizeof block;
  block.count = 1;
  block.time_step = 1;
  block.area = &area;
  block.rest_area = &rest_area;
  block.perimeter = &perimeter;
  block.rest_perimeter = &rest_perimeter;
  block.energy = &values.energy;
  block.pressure = &values.pressure;
  block.perimeter_tension = &values.perimeter_tension;
  plugin.models[0]->membrane->compute(self.get(), &block);
  return values;
}

}  // namespace

TEST_CASE("tensions are those of the two-dimensional material, held across or left free to find its least energy") {
  struct Case {
    std::string name;
    Material material;
    Shipped clamped, free;
  };
  std::vector<Case> cases;
  cases.push_back({"neo-hookean", neo_hookean_material, neo_hookean(1.7, true), neo_hookean(1.7, false)});
  for (const double area : {0.0, 0.3, 1.0, 10.0, 400.0}) {
    cases.push_back({"skalak, C " + std::to_string(area), skalak_material(area), skalak(1.7, area, true),
                     skalak(1.7, area, false)});
  }
  for (const Case& c : cases) {
    for (const double e : {0.4, 0.8, 1.1, 1.7, 3.0}) {
      CAPTURE(c.name, e);
      const double size = std::abs(c.clamped.derivative(e)) + c.free.derivative(1);
      CHECK(std::abs(c.clamped.slope(e) - 1.7 * tension(c.material, e, 1)) < 1e-8 * size);
      CHECK(std::abs(c.free.slope(e) - 1.7 * tension(c.material, e, free_width(c.material, e))) < 1e-8 * size);
    }
  }
}

TEST_CASE("at rest a membrane carries no tension and no energy, and resists stretch with its declared modulus") {
  const auto check = [](const Shipped& law, double modulus) {
    const Values rest = law({1.0});
    CHECK(std::abs(rest.energy[0]) < 1e-15 * modulus);
    CHECK(std::abs(rest.slope[0]) < 1e-15 * modulus);
    CHECK(rest.slope_by_argument[0] == Approx(modulus).epsilon(1e-14));
  };
  check(neo_hookean(1.7, false), 3 * 1.7);
  check(neo_hookean(1.7, true), 4 * 1.7);
  for (const double C : {0.0, 1.0, 50.0}) {
    check(skalak(1.7, C, false), 2 * 1.7 * (1 + 2 * C) / (1 + C));
    check(skalak(1.7, C, true), 2 * 1.7 * (1 + C));
  }
  check({*open_hooke(0), {{{"stretching_modulus", 1.7}, {"poisson_ratio", 0.3}}}}, 1.7);
  check({*open_inextensible(0), {{{"stretching_modulus", 1.7}}}}, 1.7);
}

TEST_CASE("the free Skalak membrane keeps its width without area resistance, and its area with much of it") {
  for (const double e : {0.5, 1.5, 3.0}) {
    CHECK(skalak(1.7, 0, false).slope(e) == Approx(skalak(1.7, 0, true).slope(e)).epsilon(1e-14));
    // With the width 1/e the energy Gs/4 (I^2 + 2 I), I = e^2 + e^-2 - 2, depends on e alone.
    // (e^4-1)(1-e^-2)/...
    const double width = 1 / e, kept = 1.7 * (e * e - width * width) * (e * e + width * width - 1);
    CHECK(skalak(1.7, 1e7, false).slope(e) == Approx(kept).epsilon(1e-5));
  }
}

TEST_CASE("the energy of the free Skalak membrane is the integral of its tension") {
  const double C = GENERATE(0.0, 0.05, 1.0, 10.0, 1000.0);
  const Shipped law = skalak(1.7, C, false);
  for (const double e : {0.25, 0.5, 2.0, 4.0}) {
    CAPTURE(C, e);
    // Simpson's rule on 4000 intervals: fourth order, 1e-12 and better for tensions this smooth.
    constexpr int n = 4000;
    std::vector<double> at;
    for (int i = 0; i <= n; ++i) at.push_back(1 + (e - 1) * i / n);
    const std::vector<double> tension = law(at).slope;
    double sum = tension.front() + tension.back();
    for (std::size_t i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4 : 2) * tension[i];
    CHECK(law.energy(e) == Approx(sum * (e - 1) / n / 3).epsilon(1e-11));
  }
}

TEST_CASE("the inextensible law resists without bound as a segment shrinks to nothing") {
  const Shipped law(*open_inextensible(0), {{{"stretching_modulus", 1.0}}});
  CHECK(law.slope(1e-3) < -1e5);
  CHECK(law.energy(1e-3) > 100);
}

TEST_CASE("bending has no moment at its rest curvature, be it the initial one, zero or a given value") {
  const double curvature[3] = {0.3, 0, 0.7}, initial[3] = {0.3, 0.3, 0.3};
  for (int choice = 0; choice < 3; ++choice) {
    const Self self =
        make(*open_bending(0)->models[0],
             {{{"modulus", 2.0}, {"rest_curvature", choice}, {"rest_curvature_value", choice == 2 ? 0.7 : 0}}});
    double moment[3], energy[3];
    rouleau_membrane_block block{};
    block.struct_size = sizeof block;
    block.count = 3;
    block.curvature = curvature;
    block.rest_curvature = initial;
    block.moment = moment;
    block.energy = energy;
    open_bending(0)->models[0]->membrane->compute(self.get(), &block);
    for (int i = 0; i < 3; ++i) {
      CAPTURE(choice, i);
      const double change = curvature[i] - curvature[choice];
      CHECK(moment[i] == 2 * change);
      CHECK(energy[i] == change * change);
    }
  }
}

TEST_CASE("bending refuses a rest curvature that its choice does not use") {
  void* self = nullptr;
  const auto [code, error] = create(*open_bending(0)->models[0],
                                    {{{"modulus", 2.0}, {"rest_curvature", 1}, {"rest_curvature_value", 0.7}}}, &self);
  CHECK(code != 0);
  CHECK(error.find("rest_curvature_value") != std::string::npos);
}

TEST_CASE("area and perimeter laws push back to their preferred values as their energies say") {
  const Setup setup{{{"modulus", 1.7}, {"ratio", 0.9}}};
  // The energies are quadratic: central differences are exact but for rounding.
  for (const double share : {0.7, 0.9, 1.2}) {
    const double area = 80 * share, perimeter = 40 * share, step = 0.01;
    const CellValues a = cell(*open_area(0), setup, area, 40), p = cell(*open_perimeter(0), setup, 80, perimeter);
    const double by_area =
        (cell(*open_area(0), setup, area + step, 40).energy - cell(*open_area(0), setup, area - step, 40).energy) /
        (2 * step);
    const double by_perimeter = (cell(*open_perimeter(0), setup, 80, perimeter + step).energy -
                                 cell(*open_perimeter(0), setup, 80, perimeter - step).energy) /
                                (2 * step);
    CHECK(a.pressure == Approx(-by_area).margin(1e-12));
    CHECK(a.pressure == Approx(-1.7 * (share - 0.9) / 0.9).margin(1e-14));
    CHECK(a.perimeter_tension == 0);
    CHECK(p.perimeter_tension == Approx(by_perimeter).margin(1e-12));
    CHECK(p.perimeter_tension == Approx(1.7 * (share - 0.9) / 0.9).margin(1e-14));
    CHECK(p.pressure == 0);
  }
}
