// Memory that is taken where something is written, and given back where nothing is known any more.
#include "core/membrane/paged_array.hpp"

#include <sys/mman.h>
#include <unistd.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>

#include "core/membrane/cell_nodes.hpp"
#include "core/membrane/displacement_watch.hpp"

using namespace rouleau;
using namespace rouleau::core;

namespace {

/// How many of the pages from a value on are in memory.
std::size_t resident_pages(const double* first, std::size_t count) {
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const std::uintptr_t begin = (reinterpret_cast<std::uintptr_t>(first) + page - 1) / page * page,
                       end = reinterpret_cast<std::uintptr_t>(first + count) / page * page;
  std::vector<unsigned char> resident((end - begin) / page);
  REQUIRE(::mincore(reinterpret_cast<void*>(begin), end - begin, resident.data()) == 0);
  return static_cast<std::size_t>(
      std::count_if(resident.begin(), resident.end(), [](unsigned char c) { return (c & 1) != 0; }));
}

constexpr int many = 1 << 20;

}  // namespace

TEST_CASE("a paged array is zero, and takes memory where it is written to") {
  for (const std::size_t count : {std::size_t{0}, std::size_t{5}, std::size_t{many}}) {
    PagedArray<double> values(count);
    REQUIRE(values.size() == count);
    if (count == many) CHECK(resident_pages(values.data(), count) == 0);
    CHECK(std::all_of(values.begin(), values.end(), [](double value) { return value == 0; }));
    std::fill(values.begin(), values.end(), 1.5);
    CHECK(std::count(values.begin(), values.end(), 1.5) == static_cast<std::ptrdiff_t>(count));
  }
}

TEST_CASE("parts of an array that are released take no memory, and the others stay") {
  std::vector<double> values(many, 2.0);
  const std::size_t before = resident_pages(values.data(), many);
  release(values, std::vector<Range>{{1000, 400'001}, {400'007, 400'008}, {900'000, many}});
  CHECK(resident_pages(values.data(), many) < before / 2);
  const auto kept = [&](int begin, int end) {
    return std::all_of(values.begin() + begin, values.begin() + end, [](double value) { return value == 2; });
  };
  CHECK((kept(0, 1000) && kept(400'001, 900'000)));
  for (const int place : {2000, 399'000, 901'000}) CHECK(values[place] == 0);
  // Where a page holds something else, too, its values may stay, and are zero or what they were.
  CHECK(std::all_of(values.begin(), values.end(), [](double value) { return value == 0 || value == 2; }));
  values[5000] = 3;
  CHECK(values[5000] == 3);
}

TEST_CASE("what lies behind an array is not released with it") {
  std::vector<double> values(many, 2.0);
  release_pages(values.data(), 1000 * sizeof(double), std::vector<Range>{{0, many}, {5000, many}}, sizeof(double));
  CHECK(std::all_of(values.begin() + 1000, values.end(), [](double value) { return value == 2; }));
}

TEST_CASE("a watch takes memory for the cells that are known") {
  constexpr int of_cell = many / 4;
  CellNodes nodes;
  for (int c = 0; c < 4; ++c) {
    nodes.cells.push_back({{.first = c * of_cell, .count = of_cell}, 0});
    nodes.part.push_back({.owned = false, .known = c == 2, .reaching = false, .inside = false});
  }
  nodes.known = {2};
  nodes.position[0].assign(many, 4.0), nodes.position[1].assign(many, 5.0);
  DisplacementWatch::Memory memory(nodes);
  CHECK(resident_pages(memory.position[0].data(), 2 * of_cell) == 0);
  CHECK(resident_pages(memory.position[0].data() + 3 * of_cell, of_cell) == 0);
  CHECK_FALSE(memory.any(nodes));
  std::fill_n(memory.position[0].data() + 2 * of_cell, of_cell, 1.0);
  CHECK(memory.any(nodes));
  memory.exchange_places(nodes);
  CHECK((nodes.position[0][2 * of_cell] == 1 && memory.position[0][2 * of_cell] == 4));
  CHECK((nodes.position[0][2 * of_cell - 1] == 4 && nodes.position[0][3 * of_cell] == 4));
}

TEST_CASE("a rank that does not know cells forgets their nodes, and what their contacts remember") {
  constexpr int cells = 100, of_cell = 5000;
  CellNodes nodes;
  for (int c = 0; c < cells; ++c) {
    nodes.cells.push_back({{.first = c * of_cell, .count = of_cell}, 0});
    const bool known = c >= 40 && c != 50;
    nodes.part.push_back({.owned = known && c < 60, .known = known, .reaching = known, .inside = false});
  }
  for (auto* values : {&nodes.position[0], &nodes.position[1], &nodes.force[0], &nodes.velocity[1]})
    values->assign(cells * of_cell, 4.0);
  nodes.state.push_back({0, 0, "law", "state", 1, std::vector<double>(cells * of_cell, 4.0)});
  nodes.contacts.of_cell.assign(cells, {{0, 1, {}, {1, 2, 3}}});

  const std::vector<Range> unknown = nodes.unknown_nodes();
  REQUIRE(unknown.size() == 2);
  CHECK((unknown[0].begin == 0 && unknown[0].end == 40 * of_cell));
  CHECK((unknown[1].begin == 50 * of_cell && unknown[1].end == 51 * of_cell));
  nodes.forget(unknown);
  for (const auto* values :
       {&nodes.position[0], &nodes.position[1], &nodes.force[0], &nodes.velocity[1], &nodes.state[0].value}) {
    CHECK(resident_pages(values->data(), 40 * of_cell) == 0);
    for (const int c : {40, 49, 51, 99}) {
      const auto first = values->begin() + c * of_cell;
      CHECK(std::count(first, first + of_cell, 4.0) == of_cell);
    }
  }
  for (int c = 0; c < cells; ++c) CHECK(nodes.contacts.of_cell[c].empty() == !nodes.knows(c));
}
