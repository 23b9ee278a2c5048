// Which cells are joined, by the energy that a pair has won.
#include "observe/bonds.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "observe/rheology_history.hpp"

using namespace rouleau;
using namespace rouleau::observe;

namespace {

/// Three cells of 20 um of membrane and one of 10 um.
Snapshot four_cells() {
  Snapshot s;
  for (int k = 0; k < 4; ++k) {
    CellSnapshot cell{};
    cell.cell = k;
    cell.type = k == 3 ? "platelet" : "rbc";
    cell.perimeter = k == 3 ? 10e-6 : 20e-6;
    s.cells.push_back(cell);
  }
  return s;
}

}  // namespace

TEST_CASE("two cells are joined by their share of the energy that a face would win, close or not") {
  const scene::Attractions attracting{{{"rbc", "rbc"}, 1e-7}};
  Snapshot s = four_cells();
  s.contacts = {{0, 1, {0, 0, 0}, 1e-7}, {1, 2, {0, 0, 0}, 1e-7}, {2, 3, {0, 0, 0}, 1e-7}};
  // A face wins 1e-12 J/m: 0 and 1 have a quarter of it, 1 and 2 a fiftieth, 0 and 2, which are not close, a tenth.
  const double unit = 1e-12;
  find_bonds(s, {{0, 1, {0, 0}, -0.15}, {1, 0, {0, 0}, -0.1}, {1, 2, {0, 0}, -0.02}, {2, 0, {1, 0}, -0.1}}, attracting,
             0.05, unit);
  CHECK(s.contacts[0].bond_share == Approx(0.25));
  CHECK(s.contacts[1].bond_share == Approx(0.02));
  CHECK(std::isnan(s.contacts[2].bond_share));
  REQUIRE(s.bonds.size() == 2);
  CHECK(s.bonds[1].cell_b == 2);
  CHECK(s.bonds[1].image == std::array{-1, 0, 0});
  CHECK(s.cells[2].bonded == 0);
  CHECK(s.cells[3].bonded == 3);
  CHECK(s.bonded_sizes == std::map<int, int>{{1, 1}, {3, 1}});
  CHECK(s.bonded_size_number_mean == Approx(2));
  CHECK(s.bonded_size_weight_mean == Approx(2.5));

  Snapshot strict = four_cells();
  find_bonds(strict, {{0, 1, {0, 0}, -0.15}, {1, 0, {0, 0}, -0.1}}, attracting, 0.26, unit);
  CHECK(strict.bonds.empty());
}

TEST_CASE("the smaller membrane of two counts, and where no depth is known close cells are joined") {
  Snapshot s = four_cells();
  s.contacts = {{0, 1, {0, 0, 0}, 1e-7}, {2, 3, {0, 0, 0}, 1e-7}};
  const scene::Attractions attracting{{{"platelet", "rbc"}, 1e-7}, {{"rbc", "rbc"}, std::nan("")}};
  find_bonds(s, {{2, 3, {0, 0}, -0.1}}, attracting, 0.05, 1e-12);
  CHECK(s.contacts[1].bond_share == Approx(0.2));
  CHECK(std::isnan(s.contacts[0].bond_share));
  CHECK(s.bonded_sizes == std::map<int, int>{{2, 2}});
}

TEST_CASE("a pair has parted once it has too little of the well's energy, near or far") {
  struct Moment {
    double gap, share;
    bool parted;
  };
  RheologyHistory history;
  for (const auto& [gap, share, parted] : std::vector<Moment>{{0.5e-6, 0.28, false},
                                                              {0.9e-6, 0.2, false},   // far, and still joined
                                                              {0.5e-6, 0.14, true},   // near: the cells slide
                                                              {0.5e-6, 0.16, false},  // and come back
                                                              {2e-6, 0, true}}) {
    Snapshot s = four_cells();
    s.stage = 0;
    if (gap < 0.75e-6) s.contacts = {{0, 1, {0, 0, 0}, gap}};
    for (CellSnapshot& cell : s.cells) {
      cell.bonded = cell.cell;
      cell.aggregate = gap < 0.75e-6 && cell.cell == 1 ? 0 : cell.cell;
    }
    find_bonds(s, {{0, 1, {0, 0}, -share}}, {{{"rbc", "rbc"}, 1e-7}}, 0.15, 1e-12);
    history.follow(s);
    CAPTURE(gap, share);
    CHECK(history.parted(0) == parted);
  }
  CHECK(history.stages()[0]["dissociation"][0]["members"] == std::vector<int>{0, 1});
}
