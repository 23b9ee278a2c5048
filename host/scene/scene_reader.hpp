// Reads single values of a document that fits the scene's schema: quantities in SI within their range, names, faults.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "json/document.hpp"
#include "json/json.hpp"
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
  bool within_box = true;        ///< whether a length of this kind has to fit into the box
};

namespace range {
inline constexpr AllowedRange length{1e-12, 1.0, 1e-9, 1e-2, "um"};                 ///< m
inline constexpr AllowedRange unit_of_length{1e-12, 1.0, 1e-9, 1e-2, "um", false};  ///< m; a factor
inline constexpr AllowedRange area{1e-24, 1.0, 1e-18, 1e-4, "um^2"};                ///< m2
inline constexpr AllowedRange volume{1e-36, 1.0, 1e-27, 1e-6, "um^3"};              ///< m3
inline constexpr AllowedRange place{-1.0, 1.0, -1e-2, 1e-2, "um"};                  ///< m
inline constexpr AllowedRange time{1e-12, 1e9, 1e-9, 1e6, "s"};                     ///< s
inline constexpr AllowedRange density{1e-3, 1e6, 10.0, 1e5, "g/cm3"};               ///< kg/m3
inline constexpr AllowedRange viscosity{1e-9, 1e6, 1e-5, 0.5, "cP"};                ///< Pa s
inline constexpr AllowedRange shear_rate{-1e9, 1e9, -1e7, 1e7, "1/s"};              ///< 1/s
inline constexpr AllowedRange rate{1e-12, 1e9, 1e-12, 1e7, "1/s"};                  ///< 1/s
inline constexpr AllowedRange velocity{-1e6, 1e6, -0.5, 0.5, "mm/s"};               ///< m/s
inline constexpr AllowedRange pressure{-1e9, 1e9, -1e6, 1e6, "Pa"};                 ///< Pa
inline constexpr AllowedRange force_density{-1e15, 1e15, -1e12, 1e12, "N/m3"};      ///< N/m3
inline constexpr AllowedRange acceleration{-1e9, 1e9, -1e6, 1e6, "m/s2"};           ///< m/s2
inline constexpr AllowedRange force{-1.0, 1.0, -1e-3, 1e-3, "pN"};                  ///< N; N/m in two dimensions
inline constexpr AllowedRange component{-1e9, 1e9};                                 ///< of a direction
inline constexpr AllowedRange frequency{1e-9, 1e9, 1e-6, 1e6, "Hz"};                ///< Hz
inline constexpr AllowedRange angle{-1e3, 1e3, -7.0, 7.0, "deg"};                   ///< rad; 7: just above a turn
}  // namespace range

/// Thrown for a value that is wrong by the schema, or not there because of that: its fault has been found.
struct Misread {};

/// Every member throws Error(bad_input) for the value it is asked for; within attempt() of a reader that collects
/// faults that ends the attempt alone.
class SceneFields {
 public:
  explicit SceneFields(const json::Document& document) : document_(document) {}

  /// Collects faults. Those that are there already are the schema's: the document need not fit it then, and what
  /// follows from them is not said.
  SceneFields(const json::Document& document, Faults& faults)
      : document_(document), faults_(&faults), of_schema_(faults.size()) {}

  /// Reads a part that the others do not need; its fault is kept if this collects, or else thrown.
  template <class Read>
  void attempt(const Read& read) const {
    if (faults_ == nullptr) return read();
    try {
      read();
    } catch (const Error& fault) {
      faults_->add(fault);
    } catch (const Misread&) {
    } catch (const nlohmann::json::exception&) {  // there is no such value, or not of that type
      if (of_schema_ == 0) throw;
    }
  }

  /// Has no fault been found in the value at `pointer` or, if there is none, in the keys beside which it would stand?
  /// Only then something can be said that depends on it.
  [[nodiscard]] bool settled(const std::string& pointer) const;

  /// From here no length may be longer than the box, whose size in m this is.
  void bound_lengths(const Vector& box) { box_ = box; }

  [[nodiscard]] const nlohmann::json& at(const std::string& pointer) const;
  [[nodiscard]] bool has(const std::string& pointer) const;

  /// SI value of a quantity, or of a plain number; `unit` is what is wanted. A fault where it is outside the range:
  /// then NaN, if this collects.
  [[nodiscard]] double quantity(const std::string& pointer, std::string_view unit, AllowedRange range) const;
  [[nodiscard]] double quantity_or(const std::string& pointer, std::string_view unit, AllowedRange range,
                                   double otherwise) const;
  /// As many of them as the array has, but no more than `dimension`; along other axes 0.
  [[nodiscard]] Vector quantities(const std::string& pointer, std::string_view unit, AllowedRange range,
                                  int dimension) const;
  /// The same of something that has one along each axis of the domain; refused where it has not.
  [[nodiscard]] Vector vector(const std::string& pointer, std::string_view unit, AllowedRange range,
                              int dimension) const;
  /// A place in the domain; refused where it has not a length along each axis. `what` is called so: "place".
  [[nodiscard]] Vector place(const std::string& pointer, const Domain& domain, const char* what = "place") const;

  /// A unit vector; refused where its three numbers have no direction.
  [[nodiscard]] Eigen::Vector3d direction(const std::string& pointer) const;

  /// How many elements or members the value has.
  [[nodiscard]] std::size_t count(const std::string& pointer) const;
  template <class T>
  [[nodiscard]] T value(const std::string& pointer) const {
    if (of_schema_ > 0 && !settled(pointer)) throw Misread{};
    return at(pointer).get<T>();
  }
  template <class T>
  [[nodiscard]] T value_or(const std::string& pointer, const T& otherwise) const {
    T result = otherwise;
    attempt([&] {
      if (has(pointer)) result = value<T>(pointer);
    });
    return result;
  }

  /// The regular file that the text at `pointer` names; a relative one begins with the folder of the scene.
  [[nodiscard]] std::filesystem::path file(const std::string& pointer) const;
  [[nodiscard]] const units::Units& units() const { return units_; }

  /// One line of text that will be printed; throws where it holds a control character.
  [[nodiscard]] std::string line(const std::string& pointer) const;

  /// A model's id and parameters; the object at `pointer` has "model".
  [[nodiscard]] ModelChoice model(const std::string& pointer) const;

  /// Index of the cell type that the text at `pointer` names. `others`: what else might have been meant.
  [[nodiscard]] int cell_type(const std::string& pointer, const std::vector<CellType>& types,
                              const std::vector<std::string>& others = {}) const;

  /// Refuses the object at `pointer` where it lacks a key that only scenes with open numerics may leave out;
  /// `otherwise` says what those do.
  void require(const std::string& pointer, const std::string& key, const std::string& otherwise) const;

  /// Refuses `more` cells beside `cells` where there would be more than can be computed.
  void require_room(std::size_t cells, std::size_t more, const std::string& pointer) const;

  /// Ends with Error(bad_input) at a value, or at a key. Lines of the problem after the first are indented here.
  [[noreturn]] void refuse(const std::string& pointer, const std::string& problem) const;
  [[noreturn]] void refuse_key(const std::string& pointer, const std::string& problem) const;

 private:
  [[nodiscard]] double judged_quantity(const std::string& pointer, std::string_view unit, AllowedRange range) const;

  const json::Document& document_;
  Faults* faults_ = nullptr;          ///< null: faults are thrown
  std::size_t of_schema_ = 0;         ///< how many of them came first
  mutable bool lacks_types_ = false;  ///< it has been said that there are no cell types
  units::Units units_;
  std::optional<Vector> box_;
};

// More cannot be computed.
inline constexpr long most_cells = 10'000'000;
inline constexpr std::int64_t most_nodes = std::int64_t{1} << 38;           ///< of a lattice
inline constexpr std::int64_t most_nodes_of_block = std::int64_t{1} << 30;  ///< of the part that one rank computes
inline constexpr std::int64_t most_rows = std::int64_t{1} << 30;            ///< along x, of a lattice
inline constexpr int most_nodes_of_side = 1 << 20;

/// Could the domain be read? Only then something can be said that depends on it.
inline bool is_known(const Domain& domain) { return domain.size.is_finite() && domain.node_count() > 0; }

/// The parts of a scene, each in a file of its own.
/// Shapes that the fluid lies within and obstacles; which of the axes y and z are periodic then. The domain's size and
/// nodes are read before.
void read_wall_shapes(const SceneFields& fields, Domain& domain);
/// What the ends of the open axis are kept at, where there is one.
void read_openings(const SceneFields& fields, const std::vector<CellType>& types, Domain& domain);
/// Refuses what there is no way to have between openings.
void check_openings(const SceneFields& fields, const Scene& scene);
std::vector<CellType> read_cell_types(const SceneFields& fields, const FluidProperties& fluid, const Domain& domain);
/// Triangles with which the nodes of a surface lie about so far apart, m: 20 n^2. Not of a mesh, whose file has them.
int triangles_about(const Shape& shape, double spacing);
/// Cells as placed by hand. What is wanted at random goes into `packings`.
std::vector<CellPlacement> read_cells(const SceneFields& fields, const std::vector<CellType>& types,
                                      const Domain& domain, std::vector<RandomPacking>& packings);
/// What the entry asks for; with a hematocrit it has no count yet.
RandomPacking read_packing(const SceneFields& fields, const std::string& entry, int type, const Domain& domain);
std::vector<Stage> read_stages(const SceneFields& fields, const Scene& scene);
/// Refuses what a stage would wait for in vain. `flows`: something drives its fluid.
void check_until(const SceneFields& fields, const Stage& stage, const Scene& scene, bool flows);
Output read_output(const SceneFields& fields, const std::vector<Stage>& stages, const Domain& domain);
FieldStorage read_field_storage(const SceneFields& fields, const Domain& domain);
/// Refuses cells with more membrane nodes than can be computed.
void check_membrane_nodes(const Scene& scene);

}  // namespace rouleau::scene
