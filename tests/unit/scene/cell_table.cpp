// Cells from a CSV file.
#include "scene/cell_table.hpp"

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "scratch_folder.hpp"

using namespace rouleau;
using namespace rouleau::scene;
using Catch::Matchers::Contains;

namespace {

std::vector<CellType> types(const std::vector<std::string>& names) {
  std::vector<CellType> result;
  for (const std::string& name : names) result.push_back({name, Circle{4e-6}, 40, 1e-3, {}});
  return result;
}

std::vector<CellPlacement> read(const std::string& text, const std::vector<std::string>& names = {"rbc", "capsule"}) {
  const test::ScratchFolder folder;
  return read_cell_table(folder.write("cells.csv", text), types(names), units::Units(), "/cells");
}

/// What an error says of the file: "line:column", and its words.
std::pair<std::string, std::string> fault(const std::string& text,
                                          const std::vector<std::string>& names = {"rbc", "capsule"}) {
  try {
    (void)read(text, names);
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    return {std::to_string(error.place().line) + ':' + std::to_string(error.place().column), error.what()};
  }
  return {};
}

}  // namespace

TEST_CASE("cells of a table have the units of its header, and know their lines") {
  const auto cells = read("type,x_um,y_m,angle_deg\nrbc,1.5,2e-6,90\r\n\ncapsule, -3 ,0,0");
  REQUIRE(cells.size() == 2);
  CHECK(cells[0].type == 0);
  CHECK(cells[0].center.x() == Approx(1.5e-6));
  CHECK(cells[0].center.y() == 2e-6);
  CHECK(cells[0].angle == Approx(std::acos(0.0)));
  CHECK(cells[0].line == 2);
  CHECK(cells[1].type == 1);
  CHECK(cells[1].center.x() == Approx(-3e-6));
  CHECK(cells[1].line == 4);
  CHECK(cells[1].pointer == "/cells");
}

TEST_CASE("a table needs neither a type where there is one only, nor angles, and columns stand in any order") {
  const auto cells = read("colour,y_nm,x_m\nred,500,1e-6\n", {"rbc"});
  REQUIRE(cells.size() == 1);
  CHECK(cells[0].type == 0);
  CHECK(cells[0].angle == 0);
  CHECK(cells[0].center.x() == 1e-6);
  CHECK(cells[0].center.y() == Approx(5e-7));
}

TEST_CASE("a table without types takes the one that is given, and one with types takes none") {
  const test::ScratchFolder folder;
  const auto all = types({"rbc", "capsule"});
  const auto file = folder.write("cells.csv", "x_um,y_um\n1,2\n");
  CHECK(read_cell_table(file, all, units::Units(), "/cells", 1).at(0).type == 1);
  const auto typed = folder.write("typed.csv", "x_um,y_um,type\n1,2,rbc\n");
  CHECK_THROWS_WITH(read_cell_table(typed, all, units::Units(), "/cells", 1),
                    Contains("typed.csv:1:11") && Contains("leave one of them out"));
}

TEST_CASE("of the table of a run the last step counts") {
  const auto cells = read(
      "step,time_s,strain,cell,type,x_m,y_m,angle_rad\n0,0,0,0,rbc,1e-6,1e-6,0\n0,0,0,1,rbc,9e-6,1e-6,0\n"
      "70,1,0,0,rbc,2e-6,1e-6,0.5\n70,1,0,1,capsule,8e-6,1e-6,0\n");
  REQUIRE(cells.size() == 2);
  CHECK(cells[0].center.x() == 2e-6);
  CHECK(cells[0].angle == 0.5);
  CHECK(cells[1].type == 1);
}

TEST_CASE("a fault of a table names line, column, value and remedy") {
  using Says = std::pair<std::string, std::string>;
  const auto is = [](const Says& found, const std::string& place, const std::string& a, const std::string& b) {
    CAPTURE(found.second);
    CHECK(found.first == place);
    CHECK_THAT(found.second, Contains(a) && Contains(b));
  };
  is(fault("type,x_um,y_um\nrbc,1,2\nrbc,1,two\n"), "3:7", "\"two\" is no number", "y_um");
  is(fault("type,x_um,y_um\nrbc,1e\n"), "2:5", "2 entries", "3");
  is(fault("type,x_um,y_um\nrbc,1,2,\n"), "2:9", "4 entries", "3");
  is(fault("type,x_um,y_um\nrcb,1,2\n"), "2:1", "did you mean \"rbc\"?", "cell_types has: rbc, capsule");
  is(fault("type,x_um,y_um\nrbc,1,2e7\n"), "2:7", "\"2e7\" um is out of range", "1e+06");
  is(fault("type,x_um,y_um\nrbc,nan,2\n"), "2:5", "\"nan\" is no number", "x_um");
  is(fault("type,x,y_um\nrbc,1,2\n"), "1:6", "has no unit", "x_um");
  is(fault("type,x_s,y_um\nrbc,1,2\n"), "1:6", "a time", "m");
  is(fault("type,x_um,x_m,y_um\nrbc,1,2,3\n"), "1:11", "both x", "leave one");
  is(fault("type,type,x_um,y_um\nrbc,rbc,2,3\n"), "1:6", "there twice", "leave one");
  is(fault("type,x_um\nrbc,1\n"), "1:1", "no column y", "y_um");
  is(fault("x_um,y_um\n1,2\n"), "1:1", "no column \"type\"", "rbc, capsule");
  is(fault("step,type,x_um,y_um\n7,rbc,1,2\n3,rbc,1,2\n"), "3:1", "comes after step 7", "sort");
  is(fault("type,x_um,y_um\n"), "0:0", "no cells", "header");
  is(fault(""), "0:0", "empty", "type,x_um,y_um,angle_deg");
  CHECK_THROWS_AS(read_cell_table("/nowhere/cells.csv", types({"rbc"}), units::Units(), "/cells"), Error);
}
