// Who is aggregated with whom: contacts between membranes over all periodic images, and the clusters they make.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/domain/images.hpp"
#include "core/membrane/membranes.hpp"
#include "core/solver/surroundings.hpp"
#include "core/surface/surfaces.hpp"
#include "json/json.hpp"

namespace rouleau::observe {

struct AggregateEvent {
  double strain, time;
  int count;
  std::vector<std::vector<int>> members;  ///< empty: not kept
  bool through_image;
  std::vector<std::vector<int>> joined = {};        ///< by bonds; empty: as members, or nothing attracts
  std::vector<std::array<int, 2>> met_images = {};  ///< attracting pairs that left each other and met by another image
  [[nodiscard]] const std::vector<std::vector<int>>& together() const { return joined.empty() ? members : joined; }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(AggregateEvent, strain, time, count, members, through_image, joined, met_images)
};

/// "rouleaux of 3 and 2 cells and 1 single cell", the largest first; of more than four rouleaux the number and range;
/// "4 single cells" where there is none. sizes: number of cells of each aggregate, in any order, single cells included.
std::string aggregates_in_words(std::vector<std::size_t> sizes);

struct CellContact {
  int cell_a, cell_b;      ///< cell_a < cell_b, or equal for a cell and its own image
  core::ImageShift image;  ///< of b
  double gap;              ///< smallest distance between the two polygons or surfaces, lattice units
  double contact_length;   ///< rest length of a's nodes nearer to b than `reach`; of surfaces, their rest area
};

/// All pairs nearer than `reach` (lattice units) whose first cell is this rank's, if it knows all that are so near. In
/// the order of the first cells.
std::vector<CellContact> find_touching_cells(const core::Membranes& membranes, const core::Domain<2>& domain,
                                             double reach);

/// The same of surfaces: the distance between the nodes of either and the triangles of the other.
std::vector<CellContact> find_touching_cells(const core::Surfaces& surfaces, const core::Domain<3>& domain,
                                             double reach);

/// Of each of this rank's cells the smallest gap to any other or to an image (spacings), looked for in growing
/// neighbourhoods up to the size of the box; infinite when there is none. All ranks together.
std::vector<double> smallest_gaps(core::Surroundings<2>& around, const core::Domain<2>& domain);
/// The same of surfaces, up to half of the shortest period, if there is one.
std::vector<double> smallest_gaps(core::Surroundings<3>& around, const core::Domain<3>& domain);

struct Aggregates {
  int count = 0;
  std::vector<int> cells;           ///< those that there are, ascending
  std::vector<int> label;           ///< of each of them: the smallest one of its aggregate
  std::vector<bool> through_image;  ///< of each of them: its aggregate has a contact across the periodic border
};

/// Where a number stands in a list of ascending ones that has it.
std::size_t place_of(int number, const std::vector<int>& ascending);

/// Connected components of the contacts between these cells, whose numbers ascend.
Aggregates find_aggregates(std::vector<int> cells, const std::vector<CellContact>& contacts);
/// Of so many cells, all of which are there.
Aggregates find_aggregates(int cells, const std::vector<CellContact>& contacts);

}  // namespace rouleau::observe
