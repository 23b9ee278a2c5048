// A setup as the host makes it, and instances made with it.
#pragma once

#include <rouleau/plugin.h>

#include <catch2/catch.hpp>
#include <memory>
#include <rouleau/d2q9.hpp>
#include <string>
#include <utility>
#include <vector>

namespace rouleau::test {

struct Setup {
  std::vector<std::pair<std::string, double>> parameters;
  double relaxation_rate = 1;
  bool inertia = false;
  std::uint32_t dimension = 2;
  double length_unit = 1, time_unit = 1, mass_unit = 1;
};

/// Calls create; returns its code, with the error's text.
inline std::pair<int, std::string> create(const rouleau_model& model, const Setup& from, void** self) {
  std::vector<const char*> names;
  std::vector<double> values;
  for (const auto& [name, value] : from.parameters) {
    names.push_back(name.c_str());
    values.push_back(value);
  }
  rouleau_setup setup{};
  setup.struct_size = sizeof setup;
  setup.parameter_count = static_cast<std::uint32_t>(names.size());
  setup.parameter_names = names.data();
  setup.parameter_values = values.data();
  setup.length_unit = from.length_unit;
  setup.time_unit = from.time_unit;
  setup.mass_unit = from.mass_unit;
  setup.dimension = from.dimension;
  setup.velocity_count = d2q9::velocity_count;
  setup.weights = d2q9::weight;
  setup.sound_speed_squared = d2q9::sound_speed_squared;
  setup.relaxation_rate = from.relaxation_rate;
  setup.inertia = from.inertia;
  char error[256] = "";
  const int code = model.create(&setup, self, error, sizeof error);
  return {code, error};
}

using Self = std::unique_ptr<void, void (*)(void*)>;

inline Self make(const rouleau_model& model, const Setup& setup) {
  void* self = nullptr;
  const auto [code, error] = create(model, setup, &self);
  INFO(error);
  REQUIRE(code == 0);
  return {self, model.destroy};
}

}  // namespace rouleau::test
