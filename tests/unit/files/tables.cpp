#include <catch2/catch.hpp>
#include <charconv>
#include <clocale>
#include <random>
#include <sstream>

#include "files/file.hpp"
#include "files/tables.hpp"
#include "observe/observables.hpp"
#include "unit/run_fixture.hpp"

using namespace rouleau;
using namespace rouleau::files;
using namespace rouleau::observe;
using namespace rouleau::test;

TEST_CASE("a number in a table reads back as the same double") {
  const unsigned seed = std::random_device{}();
  INFO("seed " << seed);
  std::mt19937_64 random(seed);
  for (int i = 0; i < 10000; ++i) {
    double value = 0;
    const std::uint64_t bits = random();
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    const std::string text = to_text(value);
    double back = 0;
    std::from_chars(text.data(), text.data() + text.size(), back);
    REQUIRE(std::memcmp(&value, &back, sizeof value) == 0);
  }
  CHECK(to_text(std::numeric_limits<double>::infinity()) == "inf");
  CHECK(to_text(-std::numeric_limits<double>::infinity()) == "-inf");
  CHECK(to_text(std::nan("")) == "nan");
}

TEST_CASE("numbers have a decimal point in every locale") {
  // Present on few machines; the test says nothing where none of them is.
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"})
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  CHECK(to_text(0.5) == "0.5");
  std::setlocale(LC_ALL, "C");
}

TEST_CASE("the tables hold what the snapshots say") {
  const ScratchFolder folder;
  Tables tables(folder.path(), 2);
  tables.write(small_snapshot(0));
  tables.write(small_snapshot(7));
  tables.close();

  const StoredTable cells(folder.path() / "cells.csv");
  REQUIRE(cells.rows() == 4);
  for (const char* column : {"step", "time_s", "strain", "cell", "type", "x_m", "y_m", "angle_rad", "deformation",
                             "area_m2", "perimeter_m", "min_gap_m", "aggregate"})
    CHECK_NOTHROW(cells.texts(column));
  CHECK(cells.numbers("strain")[3] == 7.0 / 3);
  CHECK(cells.numbers("angle_rad")[0] == std::numbers::pi / 3);
  CHECK(cells.texts("type")[1] == "rbc, \"old\"");
  CHECK(cells.texts("min_gap_m")[1] == "inf");

  const StoredTable series(folder.path() / "series.csv");
  REQUIRE(series.rows() == 2);
  CHECK(series.texts("relative_viscosity")[0] == "nan");
  CHECK(series.numbers("relative_viscosity")[1] == 1.25);

  const StoredTable aggregates(folder.path() / "aggregates.csv");
  REQUIRE(aggregates.rows() == 2);
  CHECK(aggregates.texts("members")[0] == "0+1");
  CHECK(aggregates.numbers("image_x")[0] == -1);
  CHECK(aggregates.numbers("gap_m")[0] == 0.5e-6);
}

TEST_CASE("every table has a header with the names of its observables, and as many entries in every row") {
  const ScratchFolder folder;
  Tables tables(folder.path(), 2);
  auto snapshot = small_snapshot(0);
  for (CellSnapshot& cell : snapshot.cells) cell.type = "rbc";
  snapshot.aggregate_sizes = {{1, 2}, {3, 1}};
  tables.write(snapshot);
  snapshot.contacts.clear();
  tables.write(snapshot);
  tables.close();
  for (const Table& table : observe::tables()) {
    std::istringstream lines(read_text(folder.path() / (std::string(table.name) + ".csv")));
    std::string header, row, expected;
    std::getline(lines, header);
    for (const std::string& column : table.columns(2)) expected += (expected.empty() ? "" : ",") + column;
    CHECK(header == expected);
    int rows = 0;
    for (; std::getline(lines, row); ++rows)
      CHECK(std::count(row.begin(), row.end(), ',') == std::count(header.begin(), header.end(), ','));
    CHECK(rows >= 2);
  }
}

TEST_CASE("an aggregate without contact has a row of its own with empty contact columns") {
  const ScratchFolder folder;
  Tables tables(folder.path(), 2);
  auto snapshot = small_snapshot(0);
  snapshot.contacts.clear();
  snapshot.cells[1].aggregate = 1;
  snapshot.aggregate_count = 2;
  tables.write(snapshot);
  tables.close();
  const StoredTable aggregates(folder.path() / "aggregates.csv");
  REQUIRE(aggregates.rows() == 2);
  CHECK(aggregates.texts("members") == std::vector<std::string>{"0", "1"});
  CHECK(aggregates.texts("gap_m") == std::vector<std::string>{"", ""});
}

TEST_CASE("every aggregate has its own rotation, lone cells have none, and the series follows the largest") {
  const ScratchFolder folder;
  Tables tables(folder.path(), 2);
  Snapshot snapshot;
  snapshot.aggregate_count = 3;
  for (const int label : {0, 1, 1, 3, 3, 3}) {
    CellSnapshot cell{};
    cell.cell = static_cast<int>(snapshot.cells.size());
    cell.aggregate = label;
    snapshot.cells.push_back(cell);
  }
  snapshot.rotation = {{1, 0.25}, {3, -7.5}};
  tables.write(snapshot);
  snapshot.rotation = {{1, 0.25}};
  tables.write(snapshot);
  tables.close();
  const StoredTable aggregates(folder.path() / "aggregates.csv"), series(folder.path() / "series.csv");
  CHECK(aggregates.texts("rotation_rad") == std::vector<std::string>{"", "0.25", "-7.5", "", "0.25", ""});
  CHECK(series.texts("rotation_rad") == std::vector<std::string>{"-7.5", "nan"});
}

TEST_CASE("a last line that a killed run left unfinished is dropped") {
  const ScratchFolder folder;
  write_file(folder.path() / "t.csv", "a,b\n1,2\n3,");
  CHECK(StoredTable(folder.path() / "t.csv").numbers("b") == std::vector<double>{2});
}

TEST_CASE("a column that numbers things is counted, and a number that cannot be one is refused with its row") {
  const ScratchFolder scratch;
  const auto count = [&](const std::string& column) {
    write_file(scratch.path() / "cells.csv", "cell\n" + column);
    return StoredTable(scratch.path() / "cells.csv").count_of("cell");
  };
  CHECK(count("") == 0);
  CHECK(count("0\n1\n0\n1\n") == 2);
  for (const char* wrong : {"nan", "-1", "inf", "1e300", "2", ""}) {
    CAPTURE(wrong);
    try {
      count("0\n" + std::string(wrong) + "\n");
      FAIL("it was counted");
    } catch (const Error& error) {
      CHECK(error.cause() == Cause::bad_input);
      CHECK_THAT(error.what(), Catch::Contains("cells.csv") && Catch::Contains("row 2") && Catch::Contains(wrong));
    }
  }
}
