// "numerics": "auto": resolution, relaxation time, relaxed density and coupling chosen for a target error.
#pragma once

#include <optional>

#include "base/error.hpp"
#include "json/document.hpp"
#include "numerics_choice.hpp"
#include "scene/scene.hpp"

namespace rouleau::plan {

/// A scene as it was written, which may leave its numerics open ("numerics": "auto", or an object with "auto"). It is
/// kept in memory, so that values can be chosen again and again.
class OpenScene {
 public:
  /// A scene with faults gets values with which it can be read, and nothing will be chosen. Adds a fault where no
  /// lattice fits the domain.
  OpenScene(json::Document document, Faults& faults);
  /// The document with values for what it leaves open: the cheapest that keep the target error by what was measured
  /// (docs/auto.md) and the bounds. What the scene says of its numerics stays, so that it can be read again. No
  /// choice for a scene that pins its numerics, or has faults.
  [[nodiscard]] json::Document filled_in(const NumericsBounds& bounds, std::optional<NumericsChoice>& choice) const;
  /// Makes the region of a scene that was read from it; once for all lattices, where one is chosen.
  void build_walls(scene::Scene& scene, Faults& faults) const;

 private:
  json::Document document_;
  std::optional<scene::Scene> draft_;  ///< with values that mean nothing; none where nothing is to be chosen
};

}  // namespace rouleau::plan
