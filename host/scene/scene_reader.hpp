// Reads single values of a document that fits the scene's schema: quantities in SI within their range, names, faults.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "json/document.hpp"
#include "scene.hpp"
#include "units/units.hpp"

namespace rouleau::scene {

/// Where a quantity may lie, in SI: from `least` to `most`, both included. The ranges are far wider than any sensible
/// scene; they are there so that no later product overflows and no quotient divides by nothing. A plain number has a
/// range of its own: beyond it the likeliest reason is a unit that was forgotten.
struct AllowedRange {
  double least;
  double most;
  double plain_least = least;
  double plain_most = most;
  const char* common_unit = "";  ///< in which such a quantity is mostly given
};

namespace range {
inline constexpr AllowedRange length{1e-12, 1.0, 1e-9, 1e-2, "um"};             ///< m
inline constexpr AllowedRange place{-1.0, 1.0, -1e-2, 1e-2, "um"};              ///< m
inline constexpr AllowedRange time{1e-12, 1e9, 1e-9, 1e6, "s"};                 ///< s
inline constexpr AllowedRange density{1e-3, 1e6, 10.0, 1e5, "g/cm3"};           ///< kg/m3
inline constexpr AllowedRange viscosity{1e-9, 1e6, 1e-5, 0.5, "cP"};            ///< Pa s
inline constexpr AllowedRange shear_rate{0.0, 1e9, 0.0, 1e7, "1/s"};            ///< 1/s
inline constexpr AllowedRange force_density{-1e15, 1e15, -1e12, 1e12, "N/m3"};  ///< N/m3
inline constexpr AllowedRange angle{-1e3, 1e3, -7.0, 7.0, "deg"};               ///< rad; 7: just above a turn
}  // namespace range

class SceneFields {
 public:
  explicit SceneFields(const json::Document& document) : document_(document) {}

  /// From here no length may be longer than the box, whose size in m this is.
  void bound_lengths(const Eigen::Vector2d& box) { box_ = box; }

  [[nodiscard]] const nlohmann::json& at(const std::string& pointer) const;
  [[nodiscard]] bool has(const std::string& pointer) const;

  /// SI value of a quantity, or of a plain number; `unit` is what is wanted. Throws when it is outside the range.
  [[nodiscard]] double quantity(const std::string& pointer, std::string_view unit, AllowedRange range) const;
  [[nodiscard]] double quantity_or(const std::string& pointer, std::string_view unit, AllowedRange range,
                                   double otherwise) const;
  [[nodiscard]] Eigen::Vector2d quantities(const std::string& pointer, std::string_view unit, AllowedRange range) const;

  template <class T>
  [[nodiscard]] T value_or(const std::string& pointer, const T& otherwise) const {
    return has(pointer) ? at(pointer).get<T>() : otherwise;
  }

  /// One line of text that will be printed; throws where it holds a control character.
  [[nodiscard]] std::string line(const std::string& pointer) const;

  /// A model's id and parameters; the object at `pointer` has "model".
  [[nodiscard]] ModelChoice model(const std::string& pointer) const;

  /// Index of the cell type that the text at `pointer` names. `others`: what else might have been meant.
  [[nodiscard]] int cell_type(const std::string& pointer, const std::vector<CellType>& types,
                              const std::vector<std::string>& others = {}) const;

  /// Throws when the object at `pointer` lacks a key that only some scenes may leave out; `otherwise` says what the
  /// others do.
  void require(const std::string& pointer, const std::string& key, const std::string& otherwise) const;

  /// Refuses `more` cells beside `cells` where there would be more than can be computed.
  void require_room(std::size_t cells, std::size_t more, const std::string& pointer) const;

  /// Ends with Error(bad_input) at a value, or at a key. Lines of the problem after the first are indented here.
  [[noreturn]] void refuse(const std::string& pointer, const std::string& problem) const;
  [[noreturn]] void refuse_key(const std::string& pointer, const std::string& problem) const;

 private:
  const json::Document& document_;
  units::Units units_;
  std::optional<Eigen::Vector2d> box_;
};

/// More cannot be computed.
inline constexpr long most_cells = 1'000'000;

/// The parts of a scene, each in a file of its own.
std::vector<CellType> read_cell_types(const SceneFields& fields, double fluid_viscosity);
/// Cells as placed by hand. What is wanted at random goes into `packings`.
std::vector<CellPlacement> read_cells(const SceneFields& fields, const std::vector<CellType>& types,
                                      const Domain& domain, std::vector<RandomPacking>& packings);
/// What the entry asks for; with a hematocrit it has no count yet.
RandomPacking read_packing(const SceneFields& fields, const std::string& entry, int type, const Domain& domain);
std::vector<Stage> read_stages(const SceneFields& fields, const Scene& scene);
Output read_output(const SceneFields& fields, const std::vector<Stage>& stages);
FieldStorage read_field_storage(const SceneFields& fields, const Domain& domain);
/// Refuses cells with more membrane nodes than can be computed.
void check_membrane_nodes(const Scene& scene);

}  // namespace rouleau::scene
