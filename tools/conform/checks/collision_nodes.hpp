// One lattice node's numbers and their moments, as the checks of collision operators compare them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <rouleau/d2q9.hpp>
#include <rouleau/d3q19.hpp>
#include <string>
#include <vector>

#include "trials.hpp"

namespace rouleau::conform {

/// The velocities of a lattice, in the order that the interface promises.
struct VelocitySet {
  std::size_t dimension;
  std::vector<std::array<double, 3>> velocity;  ///< third component 0 on D2Q9
  std::vector<double> weight;

  [[nodiscard]] std::size_t count() const { return weight.size(); }
  /// Of D2Q9 or D3Q19.
  static const VelocitySet& of(int dimension) {
    static const VelocitySet plane = make<D2Q9>(), space = make<D3Q19>();
    return dimension == 2 ? plane : space;
  }

 private:
  template <class Set>
  static VelocitySet make() {
    VelocitySet set{std::size_t{Set::dimension}, {}, {}};
    for (int q = 0; q < Set::velocity_count; ++q) {
      std::array<double, 3>& c = set.velocity.emplace_back();
      for (int k = 0; k < Set::dimension; ++k) c[k] = Set::velocity[q][k];
      set.weight.push_back(Set::weight[q]);
    }
    return set;
  }
};

struct CollisionNode {
  using Vector = std::array<double, 3>;

  explicit CollisionNode(const VelocitySet& velocities) : set(&velocities) {}

  const VelocitySet* set;
  std::array<double, 19> f{};  ///< deviations from rest, f_q - w_q
  Vector force{}, velocity{};
  double relaxation_rate = 0;
  bool inertia = false;

  [[nodiscard]] double density() const {
    double sum = 0;
    for (const double value : f) sum += value;
    return sum;
  }
  [[nodiscard]] double momentum(std::size_t k) const {
    double sum = 0;
    for (std::size_t q = 0; q < set->count(); ++q) sum += f[q] * set->velocity[q][k];
    return sum;
  }
  /// Sum of the sizes of all its numbers: what rounding is relative to.
  [[nodiscard]] double size() const {
    double sum = 0;
    for (const double value : force) sum += std::abs(value);
    for (const double value : f) sum += std::abs(value);
    return sum;
  }
  /// Largest difference of populations or velocities.
  [[nodiscard]] double distance(const CollisionNode& other) const {
    double most = 0;
    const auto see = [&](double a, double b) {
      if (!(std::abs(a - b) <= most)) most = std::abs(a - b);
    };
    for (std::size_t q = 0; q < f.size(); ++q) see(f[q], other.f[q]);
    for (std::size_t k = 0; k < velocity.size(); ++k) see(velocity[k], other.velocity[k]);
    return most;
  }

  // Components of what relaxes with the shear stress, and what they are called: xy and xx - yy, and on D3Q19 yz, xz and
  // yy - zz.
  using Stress = std::vector<double>;
  [[nodiscard]] std::vector<std::string> stress_names() const {
    if (set->dimension == 2) return {"xy", "xx - yy"};
    return {"xy", "xx - yy", "yz", "xz", "yy - zz"};
  }
  [[nodiscard]] Stress shear_stress() const {
    return components([&](std::size_t i, std::size_t j) {
      double sum = 0;
      for (std::size_t q = 0; q < set->count(); ++q) sum += f[q] * set->velocity[q][i] * set->velocity[q][j];
      return sum;
    });
  }
  /// With the velocity sum f c + F/2.
  [[nodiscard]] Stress equilibrium_stress() const {
    const Vector u = forced_velocity();
    return components([&](std::size_t i, std::size_t j) { return inertia ? u[i] * u[j] : 0; });
  }
  [[nodiscard]] Stress source_stress() const {
    const Vector u = forced_velocity();
    return components([&](std::size_t i, std::size_t j) { return inertia ? u[i] * force[j] + u[j] * force[i] : 0; });
  }

  /// He and Luo's equilibrium (J. Stat. Phys. 88, 1997) with reference density 1; without inertia its linear part.
  void set_equilibrium(double density, const Vector& u, bool with_inertia) {
    const double square = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    for (std::size_t q = 0; q < set->count(); ++q) {
      const double along = project(q, u);
      f[q] = density + 3 * along;
      if (with_inertia) f[q] += 4.5 * along * along - 1.5 * square;
      f[q] *= set->weight[q];
    }
  }
  void remove_momentum() {
    const Vector all{momentum(0), momentum(1), momentum(2)};
    for (std::size_t q = 0; q < set->count(); ++q) f[q] -= 3 * set->weight[q] * project(q, all);
  }

  /// Writes populations and, where there is one, the force.
  void store(Values& values, std::size_t i) const {
    for (std::size_t q = 0; q < set->count(); ++q) values.at("populations." + std::to_string(q))[i] = f[q];
    for (std::size_t k = 0; k < set->dimension; ++k) {
      const auto found = values.find("force." + std::to_string(k));
      if (found != values.end()) found->second[i] = force[k];
    }
  }

 private:
  [[nodiscard]] double project(std::size_t q, const Vector& a) const {
    const auto& c = set->velocity[q];
    return c[0] * a[0] + c[1] * a[1] + c[2] * a[2];
  }
  [[nodiscard]] Vector forced_velocity() const {
    return {momentum(0) + force[0] / 2, momentum(1) + force[1] / 2, momentum(2) + force[2] / 2};
  }
  template <class Tensor>
  [[nodiscard]] Stress components(Tensor tensor) const {
    Stress stress{tensor(0, 1), tensor(0, 0) - tensor(1, 1)};
    if (set->dimension == 3) stress.insert(stress.end(), {tensor(1, 2), tensor(0, 2), tensor(1, 1) - tensor(2, 2)});
    return stress;
  }
};

/// The nodes of inputs or outputs, which outlive this; what they do not hold is 0, the relaxation rate that of the
/// setup.
class CollisionNodes {
 public:
  CollisionNodes(const Values& values, const Trial& trial)
      : set_(&VelocitySet::of(trial.setting.dimension)),
        setup_rate_(trial.setting.relaxation_rate),
        inertia_(trial.setting.inertia) {
    const auto array = [&](const std::string& name) {
      const auto found = values.find(name);
      return found == values.end() ? nullptr : found->second.data();
    };
    for (std::size_t q = 0; q < set_->count(); ++q) f_[q] = array("populations." + std::to_string(q));
    for (std::size_t k = 0; k < set_->dimension; ++k) {
      force_[k] = array("force." + std::to_string(k));
      velocity_[k] = array("velocity." + std::to_string(k));
    }
    relaxation_rate_ = array("relaxation_rate");
  }
  [[nodiscard]] CollisionNode operator[](std::size_t i) const {
    CollisionNode node(*set_);
    const auto get = [i](const double* array, double otherwise) { return array == nullptr ? otherwise : array[i]; };
    for (std::size_t q = 0; q < set_->count(); ++q) node.f[q] = get(f_[q], 0);
    for (std::size_t k = 0; k < set_->dimension; ++k) {
      node.force[k] = get(force_[k], 0);
      node.velocity[k] = get(velocity_[k], 0);
    }
    node.relaxation_rate = get(relaxation_rate_, setup_rate_);
    node.inertia = inertia_;
    return node;
  }

 private:
  const VelocitySet* set_;
  double setup_rate_;
  bool inertia_;
  std::array<const double*, 19> f_{};
  std::array<const double*, 3> force_{}, velocity_{};
  const double* relaxation_rate_;
};

}  // namespace rouleau::conform
