// What a column of a run's tables is, and the values that columns take from an output.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "snapshot.hpp"

namespace rouleau::observe {

/// Cells that hang together, and where that is so.
struct AggregateMembers {
  int label;            ///< smallest of its cells
  int count = 0;        ///< of its cells
  std::string members;  ///< these, joined by "+"
  bool through_image = false;
  std::vector<const ContactSnapshot*> contacts;
};

/// What a row of a table is about: an output, and something of it.
struct Row {
  const Snapshot& output;
  const CellSnapshot* cell = nullptr;
  const AggregateMembers* aggregate = nullptr;
  const ContactSnapshot* contact = nullptr;  ///< none: the aggregate is a cell without contacts
  int size = 0, aggregates_of_size = 0, bonded_of_size = 0;
};

/// Nothing where the column does not apply to the row.
using Value = std::variant<std::monostate, double, long, bool, std::string>;

/// What a run has that some columns are for.
struct RunKind {
  // NOLINTNEXTLINE(google-explicit-constructor): a number of dimensions says it of most
  RunKind(int dimensions, bool is_open = false, bool cells_pass = false, bool external_forces = false,
          bool cells_interact = false)
      : dimension(dimensions),
        open(is_open),
        traffic(cells_pass),
        forces(external_forces),
        interactions(cells_interact) {}
  int dimension;
  bool open;                      ///< fluid goes through openings
  bool traffic;                   ///< cells may come or leave
  bool forces;                    ///< those of stages, or gravity, act on cells
  bool interactions;              ///< cells act on each other
  std::array<int, 2> openings{};  ///< how many each end of x has beside each other; 0 where that is not known
};

/// So many of an end's openings have columns.
inline constexpr int most_openings = 8;

struct Observable {
  std::string_view name;  ///< without the unit
  std::string_view unit;  ///< coherent SI, such as "J/m"; empty: a number or a text
  std::string_view doc;   ///< what it is, for the list of columns: Markdown, signs and what `nan` means included
  Value (*value)(const Row& row);
  std::string_view chart = {};   ///< title of the report's chart that draws it; empty: none does
  std::string_view line = {};    ///< which line of that chart it is, where there are several
  bool has_means = false;        ///< summary.json has its means over the stages (RheologyHistory)
  bool in_space = false;         ///< there in three dimensions only
  bool in_plane = false;         ///< there in two dimensions only
  bool at_openings = false;      ///< there only where fluid goes through openings
  bool of_traffic = false;       ///< there where cells may come or leave (has_traffic)
  bool of_forces = false;        ///< there where stages have forces on cells, or gravity acts
  bool of_interactions = false;  ///< there where cells act on each other
  int end = -1, number = 0;      ///< there where this end of x has several openings, and this one among them

  [[nodiscard]] bool is_in(const RunKind& run) const {
    return !(run.dimension == 3 ? in_plane : in_space) && (run.open || !at_openings) && (run.traffic || !of_traffic) &&
           (run.forces || !of_forces) && (run.interactions || !of_interactions) &&
           (end < 0 || run.openings[end] > std::max(1, number));
  }
  /// The column's name: the name and the unit, "kinetic_energy_J_per_m".
  [[nodiscard]] std::string column() const;
};

inline std::string Observable::column() const {
  std::string text(name);
  if (!unit.empty()) text += '_';
  for (const char c : unit) text += c == '/' ? std::string("_per_") : std::string(1, c == ' ' ? '_' : c);
  return text;
}

}  // namespace rouleau::observe
