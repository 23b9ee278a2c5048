#include "observables.hpp"

#include <map>
#include <stdexcept>

#include "columns.hpp"

namespace rouleau::observe {

namespace {

void for_output(const Snapshot& output, const std::function<void(const Row&)>& visit) { visit({.output = output}); }

void for_each_cell(const Snapshot& output, const std::function<void(const Row&)>& visit) {
  for (const CellSnapshot& cell : output.cells) visit({.output = output, .cell = &cell});
}

void for_each_contact(const Snapshot& output, const std::function<void(const Row&)>& visit) {
  std::map<int, AggregateMembers> aggregates;
  std::map<int, int> label_of;
  for (const CellSnapshot& cell : output.cells) {
    AggregateMembers& aggregate = aggregates.try_emplace(cell.aggregate).first->second;
    aggregate.label = cell.aggregate;
    ++aggregate.count;
    aggregate.members += (aggregate.members.empty() ? "" : "+") + std::to_string(cell.cell);
    aggregate.through_image = aggregate.through_image || cell.through_image;
    label_of[cell.cell] = cell.aggregate;
  }
  for (const ContactSnapshot& contact : output.contacts)
    aggregates.at(label_of.at(contact.cell_a)).contacts.push_back(&contact);
  for (const auto& [label, aggregate] : aggregates) {
    if (aggregate.contacts.empty()) visit({.output = output, .aggregate = &aggregate});
    for (const ContactSnapshot* contact : aggregate.contacts)
      visit({.output = output, .aggregate = &aggregate, .contact = contact});
  }
}

void for_each_size(const Snapshot& output, const std::function<void(const Row&)>& visit) {
  std::map<int, std::array<int, 2>> counts;
  for (const auto& [size, count] : output.aggregate_sizes) counts[size][0] = count;
  for (const auto& [size, count] : output.bonded_sizes) counts[size][1] = count;
  for (const auto& [size, count] : counts)
    visit({.output = output, .size = size, .aggregates_of_size = count[0], .bonded_of_size = count[1]});
}

}  // namespace

std::vector<const Observable*> Table::of(const RunKind& run) const {
  std::vector<const Observable*> chosen;
  for (const Observable& observable : observables)
    if (observable.is_in(run)) chosen.push_back(&observable);
  return chosen;
}

std::vector<std::string> Table::columns(const RunKind& run) const {
  std::vector<std::string> names;
  for (const Observable* observable : of(run)) names.push_back(observable->column());
  return names;
}

const std::array<Table, 4>& tables() {
  static const std::array<Table, 4> all{Table{"cells", columns_of_cells(), for_each_cell},
                                        Table{"aggregates", columns_of_aggregates(), for_each_contact},
                                        Table{"series", columns_of_series(), for_output},
                                        Table{"aggregate_sizes", columns_of_aggregate_sizes(), for_each_size}};
  return all;
}

const Table& table(std::string_view name) {
  for (const Table& table : tables())
    if (table.name == name) return table;
  throw std::out_of_range("there is no table " + std::string(name));
}

nlohmann::json columns_json() {
  auto list = nlohmann::json::array();
  for (const Table& table : tables()) {
    auto columns = nlohmann::json::array();
    for (const Observable& o : table.observables)
      if (o.number == 0)
        columns.push_back({{"column", o.column()},
                           {"unit", o.unit},
                           {"doc", o.doc},
                           {"has_means", o.has_means},
                           {"in_space", o.in_space},
                           {"in_plane", o.in_plane},
                           {"at_openings", o.at_openings},
                           {"of_traffic", o.of_traffic},
                           {"of_forces", o.of_forces},
                           {"of_interactions", o.of_interactions},
                           {"of_several_openings", o.end >= 0}});
    list.push_back({{"name", table.name}, {"columns", std::move(columns)}});
  }
  return list;
}

}  // namespace rouleau::observe
