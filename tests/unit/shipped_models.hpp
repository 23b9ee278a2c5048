// The shipped models, compiled into the tests from their sources: in lattice units, without catalog and libraries.
#pragma once

#include <string>
#include <vector>

#include "core/model/model.hpp"

namespace rouleau::test {

/// `values`: parameters in lattice units in the manifest's order, a choice as its number. Throws std::invalid_argument
/// where no model has that name, or it has more parameters.
core::MembraneLaw law(const std::string& id, const std::vector<double>& values);
/// The same, of surfaces.
core::MembraneLaw surface_law(const std::string& id, const std::vector<double>& values);
core::Potential potential(const std::string& id, const std::vector<double>& values);
core::CollisionOperator shipped_collision(const std::string& id, const std::vector<double>& values, double tau,
                                          bool inertia, int dimension = 2);

inline core::MembraneLaw neo_hookean(double modulus) { return law("neo-hookean", {modulus, 0}); }
inline core::MembraneLaw bending(double modulus) { return law("bending", {modulus, 0, 0}); }
inline core::Potential morse(double depth, double decay, double distance, double cutoff) {
  return potential("morse", {depth, decay, distance, cutoff});
}
inline core::CollisionOperator trt(double tau, bool inertia, int dimension = 2) {
  return shipped_collision("trt", {0.1875}, tau, inertia, dimension);
}

}  // namespace rouleau::test
