#include "dimension_names.hpp"

#include <array>

namespace rouleau::units {
namespace {

struct Named {
  Dimension dimension;  // kg, m, s, K, mol, A
  std::string_view unit;
  std::string_view kind;
  std::string_view example;
  std::string_view other_example;
};

// Where several units share a dimension, the first names what is found; examples go by the unit that is wanted.
constexpr std::array<Named, 31> named{{
    {{{0, 0, 0, 0, 0, 0}}, "1", "a plain number or an angle", "0.5", ""},
    {{{0, 0, 0, 0, 0, 0}}, "rad", "a plain number or an angle", "90 deg", "1.57 rad"},
    {{{0, 0, 0, 0, 0, 0}}, "deg", "a plain number or an angle", "90 deg", "1.57 rad"},
    {{{0, 1, 0, 0, 0, 0}}, "m", "a length", "3.91 um", "3.91e-6 m"},
    {{{0, 2, 0, 0, 0, 0}}, "m2", "an area", "13.6 um2", "1.36e-11 m2"},
    {{{0, 3, 0, 0, 0, 0}}, "m3", "a volume", "90 um3", "9e-17 m3"},
    {{{0, -1, 0, 0, 0, 0}}, "1/m", "an inverse length", "3.84 1/um", "3.84e6 1/m"},
    {{{0, 0, 1, 0, 0, 0}}, "s", "a time", "7 s", "5 ms"},
    {{{0, 0, -1, 0, 0, 0}}, "1/s", "a rate", "20 1/s", "0.02 1/ms"},
    {{{0, 1, -1, 0, 0, 0}}, "m/s", "a velocity", "1 mm/s", "1e-3 m/s"},
    {{{0, 1, -2, 0, 0, 0}}, "m/s2", "an acceleration", "9.81 m/s2", ""},
    {{{0, 2, -1, 0, 0, 0}}, "m2/s", "a kinematic viscosity or a diffusivity", "1.2e-6 m2/s", "1.2 mm2/s"},
    {{{1, 0, 0, 0, 0, 0}}, "kg", "a mass", "1 pg", "70 kDa"},
    {{{1, -3, 0, 0, 0, 0}}, "kg/m3", "a density", "1 g/cm3", "1000 kg/m3"},
    {{{1, 1, -2, 0, 0, 0}}, "N", "a force", "10 pN", "1e-11 N"},
    {{{1, 0, -2, 0, 0, 0}}, "N/m", "a surface tension or an energy per area", "6e-6 N/m", "6e-3 dyn/cm"},
    {{{1, 0, -2, 0, 0, 0}}, "J/m2", "a surface tension or an energy per area", "5.2e-8 J/m2", "0.052 uJ/m2"},
    {{{1, -1, -2, 0, 0, 0}}, "Pa", "a pressure", "6 Pa", "60 dyn/cm2"},
    {{{1, -2, -2, 0, 0, 0}}, "Pa/m", "a pressure gradient or a force per volume", "1000 Pa/m", "0.1 dyn/cm3"},
    {{{1, -2, -2, 0, 0, 0}}, "N/m3", "a pressure gradient or a force per volume", "1000 N/m3", "0.1 dyn/cm3"},
    {{{1, 2, -2, 0, 0, 0}}, "J", "an energy", "3.6e-19 J", "3.6e-12 dyn cm"},
    {{{1, -1, -1, 0, 0, 0}}, "Pa s", "a viscosity", "1.2 cP", "1.2e-3 Pa s"},
    {{{1, 0, -1, 0, 0, 0}}, "N s/m", "a surface viscosity", "1e-9 N s/m", "1e-6 dyn s/cm"},
    {{{0, 0, 0, 1, 0, 0}}, "K", "a temperature", "298 K", ""},
    {{{0, 0, 0, 0, 1, 0}}, "mol", "an amount of substance", "1 mmol", ""},
    {{{0, -3, 0, 0, 1, 0}}, "mol/m3", "a molar concentration", "1 mol/m3", "1e-3 mol/L"},
    {{{1, 0, 0, 0, -1, 0}}, "kg/mol", "a molar mass", "70 kg/mol", "70e3 g/mol"},
    {{{-2, 3, 0, 0, 1, 0}}, "m3 mol/kg2", "a second virial coefficient", "6.6e-3 cm3 mol/g2", ""},
    {{{0, 0, 0, 0, 0, 1}}, "A", "an electric current", "1 A", ""},
    {{{0, 0, 1, 0, 0, 1}}, "C", "an electric charge", "1.6e-19 C", ""},
    {{{0, -2, 1, 0, 0, 1}}, "C/m2", "a charge per area", "0.036 C/m2", ""},
}};

constexpr std::array<std::string_view, 64> usual_symbols{
    "m",  "cm",  "mm",  "um",  "nm", "pm",  "s",   "ms", "us",  "ns",  "min",  "h",    "kg", "g",    "mg",   "ug",
    "pg", "N",   "mN",  "uN",  "nN", "pN",  "dyn", "Pa", "mPa", "kPa", "MPa",  "bar",  "J",  "mJ",   "uJ",   "nJ",
    "pJ", "fJ",  "aJ",  "erg", "eV", "P",   "cP",  "mP", "K",   "mol", "mmol", "umol", "A",  "V",    "mV",   "C",
    "Hz", "kHz", "deg", "rad", "Da", "kDa", "MDa", "L",  "dL",  "mL",  "uL",   "fL",   "W",  "degC", "mmHg", "nmol"};

constexpr std::array<std::string_view, 32> compounds{
    "Pa s", "mPa s", "N/m",   "mN/m", "uN/m",   "dyn/cm", "J/m2",  "uJ/m2",  "1/s",  "1/ms",      "1/m",
    "1/um", "kg/m3", "g/cm3", "Pa/m", "kPa/m",  "N/m3",   "N s/m", "dyn cm", "m/s",  "mm/s",      "um/s",
    "m2/s", "m2",    "um2",   "um3",  "mol/m3", "mol/L",  "g/mol", "kg/mol", "C/m2", "cm3 mol/g2"};

}  // namespace

std::string kind_of(const Dimension& dimension) {
  for (const auto& entry : named)
    if (entry.dimension == dimension) return std::string(entry.kind);
  constexpr std::array<const char*, 6> base{"kg", "m", "s", "K", "mol", "A"};
  std::string text;
  for (std::size_t i = 0; i < base.size(); ++i) {
    const int exponent = dimension.exponent[i];
    if (exponent != 0) text += std::string(" ") + base[i] + (exponent == 1 ? "" : std::to_string(exponent));
  }
  return "of the dimension" + text;
}

std::string wanted_unit(std::string_view unit, const Dimension& dimension) {
  const Named* best = nullptr;
  for (const auto& entry : named)
    if (entry.dimension == dimension && (best == nullptr || entry.unit == unit)) best = &entry;
  std::string wanted = unit == "1" ? "a plain number" : std::string(unit);
  if (best == nullptr || best->example.empty()) return wanted;
  const auto other = best->other_example.empty() ? "" : " or \"" + std::string(best->other_example) + '"';
  return wanted + " (for example \"" + std::string(best->example) + '"' + other + ')';
}

std::span<const std::string_view> usual_units() { return usual_symbols; }

std::span<const std::string_view> usual_compounds() { return compounds; }

}  // namespace rouleau::units
