// The table of observables: one entry makes a column of a file, and all that is said about it.
#include "observe/observables.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "observe/rheology_history.hpp"
#include "units/units.hpp"

using namespace rouleau;
using namespace rouleau::observe;

namespace {

Snapshot two_cells() {
  Snapshot snapshot;
  snapshot.cells.resize(2);
  snapshot.cells[1].cell = 1;
  snapshot.contacts.push_back({0, 1, {0, 0}, 1e-7, 1e-6});
  snapshot.aggregate_sizes = {{2, 1}};
  return snapshot;
}

}  // namespace

TEST_CASE("every column has a name of its own, a unit that is known, and a sentence that says what it is") {
  const units::Units units;
  for (const Table& table : tables()) {
    CAPTURE(table.name);
    std::set<std::string> names;
    for (const Observable& observable : table.observables) {
      CAPTURE(observable.name);
      CHECK(names.insert(observable.column()).second);
      CHECK(observable.column().find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") ==
            std::string::npos);
      CHECK_FALSE(observable.doc.empty());
      CHECK(observable.doc.find_first_of("|\n") == std::string_view::npos);  // it stands in a table of Markdown
      if (!observable.unit.empty()) CHECK(units.scale(observable.unit) == 1.0);
    }
  }
}

TEST_CASE("a column's name ends with its unit") {
  CHECK(Observable{.name = "a", .unit = "", .doc = "", .value = nullptr}.column() == "a");
  CHECK(Observable{.name = "a", .unit = "Pa", .doc = "", .value = nullptr}.column() == "a_Pa");
  CHECK(Observable{.name = "a", .unit = "m2/s", .doc = "", .value = nullptr}.column() == "a_m2_per_s");
  CHECK(Observable{.name = "a", .unit = "Pa s", .doc = "", .value = nullptr}.column() == "a_Pa_s");
}

TEST_CASE("every column has a value in every row, of a kind that does not change between rows") {
  const Snapshot snapshot = two_cells();
  for (const Table& table : tables()) {
    CAPTURE(table.name);
    std::vector<std::size_t> kinds;
    table.for_each_row(snapshot, [&](const Row& row) {
      std::vector<std::size_t> here;
      for (const Observable& observable : table.observables) here.push_back(observable.value(row).index());
      if (kinds.empty()) kinds = here;
      CHECK(here == kinds);
    });
    CHECK(kinds.size() == table.observables.size());
  }
}

TEST_CASE("what is drawn or averaged is a number") {
  const Snapshot snapshot = two_cells();
  for (const Table& table : tables()) {
    for (const Observable& observable : table.observables) {
      CAPTURE(table.name, observable.name);
      if (!observable.chart.empty()) CHECK((table.name == "series" || table.name == "cells"));
      if (observable.has_means) CHECK(table.name == "series");
      if (observable.chart.empty() && !observable.has_means) continue;
      table.for_each_row(snapshot, [&](const Row& row) {
        const Value value = observable.value(row);
        CHECK(
            (std::holds_alternative<double>(value) || (!observable.has_means && std::holds_alternative<long>(value))));
      });
    }
  }
}

TEST_CASE("lines of one chart have one unit, and a chart of cells has one line") {
  for (const char* name : {"cells", "series"}) {
    std::map<std::string_view, std::vector<const Observable*>> charts;
    for (const Observable& observable : table(name).observables)
      if (!observable.chart.empty()) charts[observable.chart].push_back(&observable);
    for (const auto& [title, lines] : charts) {
      CAPTURE(title);
      std::set<std::string_view> units, labels;
      for (const Observable* line : lines) {
        units.insert(line->unit);
        labels.insert(line->line);
      }
      CHECK(units.size() == 1);
      CHECK(labels.size() == lines.size());
      if (std::string_view(name) == "cells") CHECK(lines.size() == 1);
    }
  }
}

TEST_CASE("the means of a stage are those of the columns that have means, by the columns' names") {
  RheologyHistory history;
  history.follow(two_cells());
  const nlohmann::json means = history.stages().at(0).at("means");
  std::set<std::string> expected{"from_s", "outputs"}, found;
  for (const Observable& observable : table("series").observables)
    if (observable.has_means && !observable.at_openings && !observable.of_interactions && !observable.in_space)
      expected.insert(observable.column());
  for (const auto& [name, mean] : means.items()) found.insert(name);
  CHECK(found == expected);
  CHECK(expected.contains("flow_rate_m2_per_s"));
}

TEST_CASE("a history that was kept without one of the means does not fit") {
  RheologyHistory history;
  CHECK(history.fits());
  history.follow(two_cells());
  CHECK(history.fits());
  nlohmann::json kept = history;
  CHECK(kept.get<RheologyHistory>().fits());
  auto& values = kept.at("stages_").at(0).at("instants").at(0).at("values");
  values.erase(values.begin());
  CHECK_FALSE(kept.get<RheologyHistory>().fits());
}

TEST_CASE(
    "the members of a large aggregate stand in its first row alone, so that the file does not grow with their square") {
  for (const int cells : {16, 17}) {
    Snapshot chain;
    for (int k = 0; k < cells; ++k) {
      chain.cells.emplace_back();
      chain.cells.back().cell = k;
      if (k > 0) chain.contacts.push_back({k - 1, k, {0, 0}, 1e-7, 1e-6});
    }
    const Table& aggregates = table("aggregates");
    const auto members = std::find_if(aggregates.observables.begin(), aggregates.observables.end(),
                                      [](const Observable& observable) { return observable.name == "members"; });
    int rows = 0;
    aggregates.for_each_row(chain, [&](const Row& row) {
      const std::string text = std::get<std::string>(members->value(row));
      CHECK(text.empty() == (cells > 16 && rows > 0));
      if (!text.empty()) CHECK(text.starts_with("0+1+2+"));
      ++rows;
    });
    CHECK(rows == cells - 1);
  }
}
