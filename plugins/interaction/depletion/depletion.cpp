// Attraction of red cells by depletion of a dissolved polymer, against the repulsion of their surface charges. Neu and
// Meiselman (Biophys. J. 83, 2002). Energy per area at the distance d: w = w_D + w_E,
//   w_D = -2 Pi (Delta - d/2 + delta - p) where the bracket is positive, else 0: polymer is missing between the cells
//   Pi = R T c/M + A2 R T c^2, Delta = -Pi/(2D) + 1/2 sqrt((Pi/D)^2 + 4 Delta0^2), D = 2 kB T/Delta0^2 (c NA/M)^(2/3),
//   Delta0 = 1.4 Rg, Rg = a (M/Da)^b, and p = delta (1 - exp(-c/cp)) is how far it gets into the glycocalyx
//   w_E = sigma^2/(delta^2 eps eps0 k^3) times
//     d >= 2 delta: sinh(k delta) (e^(k delta - k d) - e^(-k d))
//     d <  2 delta: 2 k delta - k d - e^(-k delta) sinh(k delta - k d) - sinh(k delta) e^(-k d)
// The second line holds down to d = delta, where a cell's surface would reach the other's glycocalyx, and turns into
// attraction below. There the force goes on growing instead, by itself with every Debye length: F(delta)(1 + k (delta -
// d)). The physical form is that; its well is a few to some tens of nanometres wide. The regularised form is a Morse
// potential of the same depth with a place and width that a lattice can resolve.
#include <algorithm>
#include <rouleau/interaction.hpp>

struct Depletion {
  bool regular;
  double osmotic, reach;    // Pi, 2 (Delta + delta - p)
  double charge, k, delta;  // of w_E: its factor; 1/k is the Debye length
  double sinh_k_delta, exp_minus_k_delta;
  double energy_at_delta, force_at_delta;  // of w_E
  double De = 0, beta = 0, r0 = 0, rc;     // the regularised well

  explicit Depletion(const rouleau::Parameters& p) : regular{p["form"] == 1} {
    constexpr double boltzmann = 1.380649e-23, avogadro = 6.02214076e23, dalton = 1.66053906660e-27;
    constexpr double vacuum_permittivity = 8.8541878128e-12;
    // All in SI first: the parameters with K, mol or A arrive so.
    const double metre = p.setup().length_unit, kilogram = p.setup().mass_unit, second = p.setup().time_unit;
    const double density = kilogram / (metre * metre * metre), thermal = boltzmann * p["temperature"];
    const double mass = p["molar_mass"] * kilogram, c = p["concentration"] * density;
    const double number = c / mass, moles = c / (mass * avogadro);  // molecules and moles per volume
    const double radius = p["gyration_factor"] * metre * std::pow(mass / dalton, p["gyration_exponent"]);
    const double Pi = avogadro * thermal * (moles + p["second_virial_coefficient"] * c * c), layer0 = 1.4 * radius;
    const double D = 2 * thermal / (layer0 * layer0) * std::cbrt(number * number);
    const double layer = std::sqrt(Pi * Pi / (4 * D * D) + layer0 * layer0) - Pi / (2 * D);
    const double sigma = p["surface_charge"], permittivity = p["relative_permittivity"] * vacuum_permittivity;
    // Energies per area, pressures and lengths of the lattice.
    const double surface = kilogram / (second * second), pressure = surface / metre;
    delta = p["glycocalyx_thickness"];
    k = 1 / p["debye_length"];
    sinh_k_delta = std::sinh(k * delta);
    exp_minus_k_delta = std::exp(-k * delta);
    const double k_si = k / metre, delta_si = delta * metre;
    charge = sigma * sigma / (delta_si * delta_si * permittivity * k_si * k_si * k_si) / surface;
    osmotic = Pi / pressure;
    const double penetration = delta * -std::expm1(-p["concentration"] / p["penetration_concentration"]);
    reach = 2 * (layer / metre + delta - penetration);
    const rouleau::Pair<double> innermost = overlapping(delta);
    energy_at_delta = innermost.energy;
    force_at_delta = innermost.force;
    // Inward from here the repulsion only grows; outward to the well it stays above its value at delta.
    const double weakest = force_at_delta * (1 + k * std::max(delta - reach, 0.0));
    if (weakest <= osmotic) {
      throw std::invalid_argument("the osmotic pressure of the polymer, " + std::to_string(Pi) +
                                  " Pa, is larger than the repulsion of the glycocalyces, " +
                                  std::to_string(weakest * pressure) +
                                  " Pa: the cells would collapse onto each other; lower the concentration or raise "
                                  "surface_charge");
    }
    rc = std::max(reach, 2 * delta) + 40 / k;  // e^-40 of the repulsion is less than rounding
    if (!regular) return;
    De = depth();
    beta = p["decay"];
    r0 = p["zero_force_distance"];
    rc = p["cutoff"];
    if (!(De > 0)) {
      throw std::invalid_argument(
          "at this concentration the cells repel each other at every distance, so there is no well to regularise; take "
          "the model \"repulsion\"");
    }
  }
  double cutoff() const { return rc; }

  template <class S>
  rouleau::Pair<S> operator()(const S& d) const {
    return regular ? placed_well(d) : physical_pair(d);
  }

 private:
  template <class S>
  rouleau::Pair<S> placed_well(const S& d) const {
    const S s = exp(beta * (r0 - d));
    return {De * s * (s - 2.0), 2.0 * De * beta * s * (s - 1.0), 2.0 * De * beta * beta * s * (1.0 - 2.0 * s)};
  }

  template <class S>
  rouleau::Pair<S> physical_pair(const S& d) const {
    using rouleau::max, rouleau::select;
    const rouleau::Pair<S> near = overlapping(d);
    const S tail = charge * sinh_k_delta * (1.0 - exp_minus_k_delta) * exp(k * (delta - d)), inside = delta - d;
    const S missing = max(0.5 * (reach - d), S(0.0));
    const auto apart = d >= S(2 * delta), pressed = d < S(delta), depleted = d < S(reach);
    const S pressed_energy = energy_at_delta + force_at_delta * inside * (1.0 + 0.5 * k * inside);
    const S pressed_force = force_at_delta * (1.0 + k * inside);
    return {select(pressed, pressed_energy, select(apart, tail, near.energy)) - 2.0 * osmotic * missing,
            select(pressed, pressed_force, select(apart, k * tail, near.force)) - select(depleted, S(osmotic), S(0.0)),
            select(pressed, S(-k * force_at_delta), select(apart, -k * k * tail, near.force_by_distance))};
  }

  /// w_E where the two glycocalyces overlap.
  template <class S>
  rouleau::Pair<S> overlapping(const S& d) const {
    const S x = k * (delta - d), grown = exp(x), shrunk = 1.0 / grown;
    const S screened = sinh_k_delta * exp_minus_k_delta * grown;
    const S odd = 0.5 * exp_minus_k_delta * (grown - shrunk), even = 0.5 * exp_minus_k_delta * (grown + shrunk);
    return {charge * (k * delta + x - odd - screened), charge * k * (1.0 - even - screened),
            charge * k * k * (odd + screened)};
  }

  /// Depth of the physical well; negative where there is none.
  double depth() const {
    // From delta outward the repulsion rises to one maximum and falls: it passes the osmotic pressure once at most.
    double low = delta, high = reach;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      (physical_pair(middle).force > 0 ? low : high) = middle;
    }
    return -physical_pair(low).energy;
  }
};
ROULEAU_INTERACTION(Depletion, "depletion", "1.0.0")
