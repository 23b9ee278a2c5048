// Membrane laws of both dimensions, as surfaces in three.
#include <cmath>

#include "base/text.hpp"
#include "conform/call.hpp"
#include "membrane_work.hpp"
#include "worst.hpp"

namespace rouleau::conform {

namespace {

/// Whether the trial has chosen that the membrane keeps its width across the plane.
bool is_clamped(const Subject& subject, const Trial& trial) {
  for (std::size_t k = 0; k < trial.parameters.size(); ++k) {
    const auto& words = subject.manifest().parameters[k].choices;
    if (!words.empty() && words[static_cast<std::size_t>(trial.parameters[k])] == "clamped") return true;
  }
  return false;
}

/// A sheet that is stretched along one direction and keeps its width is the same in both dimensions: T(l) = 2 l (w1 + w2) at
/// I1 = I2 = l^2 - 1.
void compare_clamped(Worst& worst, const Subject& outline, const Subject& surface) {
  Random random = outline.random();
  constexpr std::size_t count = 64;
  for (const Trial& trial : trials(outline, random, Subject::typical_setting())) {
    if (!is_clamped(outline, trial)) continue;
    Values segments = outline.random_inputs(trial.instance, count, random), triangles;
    if (!segments.contains("stretch")) return;
    for (const char* name : {"invariant_1", "invariant_2"}) {
      for (const double l : segments.at("stretch")) triangles[name].push_back((l - 1) * (l + 1));
    }
    const Trial same{surface.make(trial.parameters, trial.setting), trial.parameters, trial.setting, trial.words};
    const Values one = compute(outline, trial.instance, segments), two = compute(surface, same.instance, triangles);
    for (std::size_t i = 0; i < count; ++i) {
      const double l = segments.at("stretch")[i], w1 = two.at("stress_1")[i], w2 = two.at("stress_2")[i];
      const double tension = one.at("tension")[i];
      worst.add(std::abs(2 * l * (w1 + w2) - tension), 64 * epsilon * 2 * l * (std::abs(w1) + std::abs(w2)), [&] {
        return "clamped at the stretch " + number(l, 6) + " a triangle's tension 2 l (stress_1 + stress_2) is " +
               in_si(outline, trial.setting, "tension", 2 * l * (w1 + w2)) + ", a segment's " +
               in_si(outline, trial.setting, "tension", tension) + trial.words + "; in lattice units they differ by";
      });
    }
  }
}

}  // namespace

Finding check_three_dimensions(const Subject& subject) {
  const plugin::Manifest& manifest = subject.manifest();
  if (!manifest.works_in(3)) return Finding::skipped("works in two dimensions");
  if (!manifest.works_in(2)) return Finding::skipped("works in three dimensions only, where all checks have been run");
  const Subject surface = subject.in(3);
  std::string warnings;
  for (const char* name : {"compute", "hidden-state", "blocks", "contained", "bounds", "declared-inputs",
                           "needs-matter", "outputs-optional", "gradient", "derivatives", "rest-state", "rigid-motion",
                           "moduli", "closed-loop", "degenerate", "reference"}) {
    const Finding finding = run(*find_check(name, plugin::ModelKind::membrane), surface);
    const std::string words = std::string(name) + ": " + finding.what;
    if (finding.verdict != Verdict::pass && finding.verdict != Verdict::warn && finding.verdict != Verdict::skip) {
      return {finding.verdict, words, finding.measured, finding.limit};
    }
    if (finding.verdict == Verdict::warn) warnings += (warnings.empty() ? "" : "; ") + words;
  }
  Worst worst;
  if (surface.manifest().gives_output("stress_1") && surface.manifest().gives_output("stress_2")) {
    compare_clamped(worst, subject, surface);
  }
  Finding finding = worst.finding("the checks of two dimensions hold, and a clamped membrane is the same in both");
  if (finding.verdict == Verdict::pass && !warnings.empty()) return Finding::warned(warnings);
  return finding;
}

}  // namespace rouleau::conform
