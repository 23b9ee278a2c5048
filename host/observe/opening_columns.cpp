#include "opening_columns.hpp"

namespace rouleau::observe {

namespace {

template <auto member>
Value of_output(const Row& row) {
  return row.output.*member;
}

template <auto member>
constexpr Observable at_opening(const char* name, const char* unit, const char* doc) {
  return {.name = name, .unit = unit, .doc = doc, .value = of_output<member>, .has_means = true, .at_openings = true};
}

/// Of the inlet or the outlet, per depth in the plane.
template <auto member>
constexpr Observable opening_flow(const char* name, bool space, const char* doc) {
  Observable made = at_opening<member>(name, space ? "m3/s" : "m2/s", doc);
  made.in_space = space, made.in_plane = !space;
  return made;
}

constexpr const char* through_inlet = "flow through all of the inlet, along +x, at the first nodes behind it";
constexpr const char* through_outlet = "likewise, of the outlet, at the last nodes before it";

}  // namespace

std::vector<Observable> columns_at_openings() {
  return {opening_flow<&Snapshot::inlet_flow>("inlet_flow", false, through_inlet),
          opening_flow<&Snapshot::inlet_flow>("inlet_flow", true, through_inlet),
          opening_flow<&Snapshot::outlet_flow>("outlet_flow", false, through_outlet),
          opening_flow<&Snapshot::outlet_flow>("outlet_flow", true, through_outlet),
          at_opening<&Snapshot::inlet_pressure>("inlet_pressure", "Pa",
                                                "mean of the fluid's nodes at the inlet, half a spacing behind it"),
          at_opening<&Snapshot::outlet_pressure>("outlet_pressure", "Pa", "likewise, before the outlet")};
}

}  // namespace rouleau::observe
