// Level "physics" for collision operators: what a collision conserves, where it leads and how fast, its symmetries.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>

#include "base/text.hpp"
#include "collision_nodes.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "trials.hpp"
#include "worst.hpp"

namespace rouleau::conform {

namespace {

/// Rounding of a sum of some fifty products and sums of a node's numbers, in units of epsilon times their sizes.
constexpr double rounding = 64 * epsilon;

/// How many nodes each trial has.
constexpr std::size_t nodes = 203;

/// Calls a function with every node of every trial, before and after.
void for_each_collision(const Subject& subject,
                        const std::function<void(const Trial&, const CollisionNode&, const CollisionNode&)>& see) {
  Random random = subject.random();
  for (const Trial& trial : collision_trials(subject, random)) {
    const Values inputs = subject.random_inputs(trial.instance, nodes, random);
    const Values outputs = compute(subject, trial.instance, inputs);
    const CollisionNodes before(inputs, trial), after(outputs, trial);
    for (std::size_t i = 0; i < nodes; ++i) see(trial, before[i], after[i]);
  }
}

Finding mass(const Subject& subject) {
  if (!subject.manifest().claims.value("conservative", true))
    return Finding::skipped("says that it is not conservative");
  Worst worst;
  for_each_collision(subject, [&](const Trial& trial, const CollisionNode& before, const CollisionNode& after) {
    worst.add(std::abs(after.density() - before.density()), rounding * (before.size() + after.size()),
              [&] { return "a collision changes the density of a node by" + trial.words; });
  });
  return worst.finding("not at all");
}

Finding momentum(const Subject& subject) {
  if (!subject.manifest().claims.value("conservative", true))
    return Finding::skipped("says that it is not conservative");
  Worst worst;
  for_each_collision(subject, [&](const Trial& trial, const CollisionNode& before, const CollisionNode& after) {
    for (std::size_t k = 0; k < before.set->dimension; ++k) {
      worst.add(std::abs(after.momentum(k) - before.momentum(k) - before.force[k]),
                rounding * (before.size() + after.size()), [&] {
                  return std::string(1, "xyz"[k]) + "-momentum changes by " +
                         number(after.momentum(k) - before.momentum(k)) + " where the force is " +
                         number(before.force[k]) + trial.words;
                });
    }
  });
  return worst.finding("by the force alone");
}

Finding velocity(const Subject& subject) {
  if (!subject.manifest().gives_output("velocity")) return Finding::skipped("gives no velocity");
  Worst worst;
  for_each_collision(subject, [&](const Trial& trial, const CollisionNode& before, const CollisionNode& after) {
    for (std::size_t k = 0; k < before.set->dimension; ++k) {
      const double expected = before.momentum(k) + 0.5 * before.force[k];
      worst.add(std::abs(after.velocity[k] - expected), rounding * before.size(), [&] {
        return "velocity." + std::to_string(k) + " is " + number(after.velocity[k], 17) + ", sum f c + F/2 is " +
               number(expected, 17) + trial.words;
      });
    }
  });
  return worst.finding("the same bits");
}

/// Equilibria of random densities and velocities of the given size.
Values equilibria(const Subject& subject, const Trial& trial, double size) {
  Random random = subject.random();
  Values inputs = subject.random_inputs(trial.instance, nodes, random);
  for (std::size_t i = 0; i < nodes; ++i) {
    CollisionNode node(VelocitySet::of(trial.setting.dimension));
    const double density = size * uniform(random, -1, 1);
    CollisionNode::Vector u{};
    for (std::size_t k = 0; k < node.set->dimension; ++k) u[k] = size * uniform(random, -1, 1);
    node.set_equilibrium(density, u, trial.setting.inertia);
    node.store(inputs, i);
  }
  return inputs;
}

/// How far a collision moves them, at the most, relative to `size`.
double change_of_equilibria(const Subject& subject, const Trial& trial, double size) {
  const Values inputs = equilibria(subject, trial, size);
  Call call;
  call.absent = {"force"};
  const Values outputs = compute(subject, trial.instance, inputs, call);
  const CollisionNodes all_before(inputs, trial), all_after(outputs, trial);
  double most = 0;
  for (std::size_t i = 0; i < nodes; ++i) {
    const CollisionNode before = all_before[i], after = all_after[i];
    for (std::size_t q = 0; q < before.set->count(); ++q) {
      const double change = std::abs(after.f[q] - before.f[q]);
      if (!(change <= most)) most = change;
    }
  }
  return most;
}

/// Without inertia the equilibrium is known: it is linear in density and momentum. With inertia operators agree on the
/// terms of second order; what they add is of third order or higher, and halving density and velocity must make it
/// eight times smaller at least.
Finding equilibrium(const Subject& subject) {
  Random random = subject.random();
  Worst worst;
  for (const Trial& trial : collision_trials(subject, random)) {
    const double size = 0.1, whole = change_of_equilibria(subject, trial, size),
                 half = change_of_equilibria(subject, trial, size / 2);
    if (!trial.setting.inertia) {
      worst.add(whole, rounding * size,
                [&] { return "a collision changes populations in equilibrium by" + trial.words; });
      continue;
    }
    // A Maxwellian has (uuv + uvv)/4 in a diagonal population of D2Q9, and (uvv + uww)/2 in one along an axis of D3Q19,
    // which a rate of 2 doubles; twice that for what else an operator may have. At 0.1 terms of fourth order are a
    // tenth of those of third order: hence 7, not 8.
    const double third_order = (trial.setting.dimension == 2 ? 2 : 4) * size * size * size;
    worst.add(whole, third_order + rounding * size,
              [&] { return "a collision changes populations in equilibrium by" + trial.words; });
    worst.add(half, whole / 7 + rounding * size, [&] {
      return "a collision changes populations in equilibrium by " + number(whole, 3) +
             " and, with density and velocity halved, by" + trial.words;
    });
  }
  return worst.finding("they stay");
}

/// n = f - f_eq + S/2 with Guo's source S (Phys. Rev. E 65, 2002, eq. 20; its stress is uF + Fu) keeps the share 1 -
/// 1/tau of its shear stress. Equilibrium and source have the stresses uu and uF + Fu, without inertia none.
Finding stress_relaxation(const Subject& subject) {
  if (!subject.manifest().needs_input("relaxation_rate")) return Finding::skipped("takes no relaxation rate");
  Random random = subject.random();
  Worst worst;
  for (const Trial& trial : collision_trials(subject, random)) {
    for (const std::set<std::string>& absent :
         {std::set<std::string>{}, {"force"}, {"relaxation_rate"}, {"force", "relaxation_rate"}}) {
      const Values inputs = subject.random_inputs(trial.instance, nodes, random);
      Call call;
      call.absent = absent;
      const Values outputs = compute(subject, trial.instance, inputs, call);
      const CollisionNodes all_before(inputs, trial), all_after(outputs, trial);
      for (std::size_t i = 0; i < nodes; ++i) {
        CollisionNode before = all_before[i];
        if (absent.contains("force")) before.force = {};
        if (absent.contains("relaxation_rate")) before.relaxation_rate = trial.setting.relaxation_rate;
        const CollisionNode after = all_after[i];
        const auto is = after.shear_stress(), was = before.shear_stress();
        const auto equilibrium = before.equilibrium_stress(), source = before.source_stress();
        const auto names = before.stress_names();
        for (std::size_t k = 0; k < names.size(); ++k) {
          const double left = is[k] - equilibrium[k] - source[k] / 2;
          const double expected = (1 - before.relaxation_rate) * (was[k] - equilibrium[k] + source[k] / 2);
          worst.add(std::abs(left - expected), rounding * (before.size() + after.size()), [&] {
            return "of the stress " + names[k] + " beyond equilibrium " + number(left, 17) + " is left, expected " +
                   number(expected, 17) + ", at tau " + number(1 / before.relaxation_rate, 4) +
                   (absent.contains("force") ? " without force" : " with a force") + trial.words + "; they differ by";
          });
        }
      }
    }
  }
  return worst.finding("exactly so");
}

/// A symmetry of the square or the cube: axes change places, and then some are reversed.
struct LatticeSymmetry {
  std::array<std::size_t, 3> from;  ///< axis that component k comes from
  std::array<bool, 3> reversed;

  /// All that leave the lattice as it is, but for the one that does nothing.
  static std::vector<LatticeSymmetry> all(std::size_t dimension) {
    std::vector<LatticeSymmetry> symmetries;
    LatticeSymmetry next{{0, 1, 2}, {}};
    do {
      for (unsigned signs = 0; signs < 1U << dimension; ++signs) {
        for (std::size_t k = 0; k < dimension; ++k) next.reversed[k] = (signs >> k & 1) != 0;
        symmetries.push_back(next);
      }
    } while (std::next_permutation(next.from.begin(), next.from.begin() + static_cast<std::ptrdiff_t>(dimension)));
    symmetries.erase(symmetries.begin());
    return symmetries;
  }
  [[nodiscard]] std::array<double, 3> moved(const std::array<double, 3>& v) const {
    std::array<double, 3> image;
    for (std::size_t k = 0; k < 3; ++k) image[k] = reversed[k] ? -v[from[k]] : v[from[k]];
    return image;
  }
  [[nodiscard]] CollisionNode operator()(const CollisionNode& node) const {
    CollisionNode image = node;
    const auto& velocities = node.set->velocity;
    for (std::size_t q = 0; q < velocities.size(); ++q) {
      const auto to = std::find(velocities.begin(), velocities.end(), moved(velocities[q]));
      image.f[static_cast<std::size_t>(to - velocities.begin())] = node.f[q];
    }
    image.force = moved(node.force);
    image.velocity = moved(node.velocity);
    return image;
  }
  [[nodiscard]] std::string words(std::size_t dimension) const {
    std::string axes;
    for (std::size_t k = 0; k < dimension; ++k)
      axes += std::string(k == 0 ? "" : ", ") + (reversed[k] ? "-" : "") + "xyz"[from[k]];
    return "the axes become " + axes;
  }
};

Finding symmetry(const Subject& subject) {
  Random random = subject.random();
  Worst worst;
  const auto dimension = static_cast<std::size_t>(subject.dimension());
  const std::vector<LatticeSymmetry> symmetries = LatticeSymmetry::all(dimension);
  for (const Trial& trial : collision_trials(subject, random)) {
    const Values inputs = subject.random_inputs(trial.instance, nodes, random);
    const Values outputs = compute(subject, trial.instance, inputs);
    const CollisionNodes before(inputs, trial), after(outputs, trial);
    for (const LatticeSymmetry& image : symmetries) {
      Values turned = inputs;
      for (std::size_t i = 0; i < nodes; ++i) image(before[i]).store(turned, i);
      const Values results = compute(subject, trial.instance, turned);
      const CollisionNodes after_turned(results, trial);
      for (std::size_t i = 0; i < nodes; ++i) {
        const CollisionNode expected = image(after[i]), found = after_turned[i];
        const double limit = rounding * (expected.size() + before[i].size());
        worst.add(found.distance(expected), limit,
                  [&] { return "where " + image.words(dimension) + " a node's result differs by" + trial.words; });
      }
    }
  }
  return worst.finding("the same bits");
}

/// The same nodes computed in two ways that must agree to rounding.
void compare(Worst& worst, const Trial& trial, const Values& inputs, const Values& a, const Values& b, double limit,
             const std::string& words) {
  const CollisionNodes before(inputs, trial), ones(a, trial), others(b, trial);
  for (std::size_t i = 0; i < a.begin()->second.size(); ++i) {
    const CollisionNode one = ones[i];
    worst.add(one.distance(others[i]), limit * (before[i].size() + one.size()),
              [&] { return words + ", a result differs by" + trial.words; });
  }
}

Finding reductions(const Subject& subject) {
  Random random = subject.random();
  Worst worst;
  for (const Trial& trial : collision_trials(subject, random)) {
    Values inputs = subject.random_inputs(trial.instance, nodes, random);
    if (subject.manifest().needs_input("relaxation_rate")) {
      Values even = inputs;
      even["relaxation_rate"].assign(nodes, trial.setting.relaxation_rate);
      Call call;
      call.absent = {"relaxation_rate"};
      compare(worst, trial, inputs, compute(subject, trial.instance, inputs, call),
              compute(subject, trial.instance, even), rounding,
              "without relaxation rates and with that of the setup everywhere");
    }
    if (subject.manifest().needs_input("force")) {
      for (const std::string& name : arrays_of(subject, "force")) inputs[name].assign(nodes, 0);
      Call call;
      call.absent = {"force"};
      compare(worst, trial, inputs, compute(subject, trial.instance, inputs, call),
              compute(subject, trial.instance, inputs), rounding, "without force and with the force 0");
    }
    if (!trial.setting.inertia) continue;
    // The momentum is taken away: what is left of the velocity is rounding.
    const CollisionNodes before(inputs, trial);
    for (std::size_t i = 0; i < nodes; ++i) {
      CollisionNode node = before[i];
      node.remove_momentum();
      node.store(inputs, i);
    }
    plugin::ModelSetting still = trial.setting;
    still.inertia = false;
    Call call;
    call.absent = {"force"};
    compare(worst, trial, inputs, compute(subject, trial.instance, inputs, call),
            compute(subject, subject.make(trial.parameters, still), inputs, call), rounding,
            "with and without inertia at velocity 0");
  }
  return worst.finding("the same bits");
}

Finding precision(const Subject& subject) {
  // As `rounding`, for numbers of 24 bits.
  constexpr double limit = 64 * double{std::numeric_limits<float>::epsilon()};
  Random random = subject.random();
  Worst worst;
  for (const Trial& trial : collision_trials(subject, random)) {
    Values inputs = subject.random_inputs(trial.instance, nodes, random);
    for (auto& [name, values] : inputs) {
      for (double& value : values) value = static_cast<float>(value);
    }
    Call single;
    single.single = true;
    compare(worst, trial, inputs, compute(subject, trial.instance, inputs, single),
            compute(subject, trial.instance, inputs), limit, "in single and in double precision");
  }
  return worst.finding("the same");
}

}  // namespace

std::vector<Check> collision_checks() {
  constexpr auto kind = plugin::ModelKind::collision;
  constexpr auto level = Level::physics;
  return {
      {"mass", level, "conserves mass", {"compute"}, mass, kind},
      {"momentum", level, "changes momentum by the force only", {"mass"}, momentum, kind},
      {"velocity", level, "reports the velocity sum f c + F/2", {"compute"}, velocity, kind},
      {"equilibrium", level, "does not change populations in equilibrium", {"momentum"}, equilibrium, kind},
      {"stress-relaxation",
       level,
       "reduces the shear stress to 1 - 1/tau of it",
       {"equilibrium"},
       stress_relaxation,
       kind},
      {"symmetry",
       level,
       "has the symmetries of the square, and of the cube",
       {"stress-relaxation", "velocity"},
       symmetry,
       kind},
      {"reductions",
       level,
       "treats missing inputs and zero velocity as the interface says",
       {"symmetry"},
       reductions,
       kind},
      {"precision", level, "gives in single precision what it gives in double", {"compute"}, precision, kind},
  };
}

}  // namespace rouleau::conform
