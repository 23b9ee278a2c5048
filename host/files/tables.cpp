#include "tables.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace rouleau::files {

namespace {

constexpr std::array names{"cells.csv", "aggregates.csv", "series.csv", "aggregate_sizes.csv"};
/// First lines, in the same order.
constexpr std::array<std::string_view, 4> headers{
    "step,time_s,strain,cell,type,x_m,y_m,angle_rad,deformation,area_m2,perimeter_m,min_gap_m,aggregate,"
    "tank_treading_angle_rad,through_image,stretch_min,stretch_max\n",
    "step,time_s,strain,aggregate_count,aggregate,members,through_image,rotation_rad,cell_a,cell_b,image_x,image_y,"
    "gap_m,contact_length_m\n",
    "step,time_s,strain,stage,stage_name,aggregate_count,rotation_rad,relative_viscosity,particle_stress_Pa,mach_max,"
    "area_drift_max,mass_drift,area_leakage_max,flow_rate_m2_per_s,cell_free_layer_lower_m,cell_free_layer_upper_m,"
    "aggregate_size_number_mean,aggregate_size_weight_mean,kinetic_energy_J_per_m,elastic_energy_J_per_m,"
    "bending_energy_J_per_m,interaction_energy_J_per_m,total_energy_J_per_m,viscous_dissipation_W_per_m,"
    "membrane_dissipation_W_per_m,wall_power_W_per_m,body_force_power_W_per_m\n",
    "step,time_s,strain,cells,aggregates\n"};

/// One line of a table.
class Row {
 public:
  Row& add(double value) { return raw(to_text(value)); }
  Row& add(int value) { return raw(std::to_string(value)); }
  Row& add(long value) { return raw(std::to_string(value)); }
  Row& add(bool value) { return raw(value ? "1" : "0"); }
  Row& add(const std::string& text) { return raw(csv_text(text)); }
  Row& skip(int columns) {
    for (int i = 0; i < columns; ++i) raw("");
    return *this;
  }
  [[nodiscard]] std::string line() const { return text_ + "\n"; }

 private:
  Row& raw(std::string_view text) {
    if (!first_) text_ += ',';
    first_ = false;
    text_ += text;
    return *this;
  }
  std::string text_;
  bool first_ = true;
};

Row begin_row(const observe::Snapshot& snapshot) {
  Row row;
  row.add(snapshot.step).add(snapshot.time).add(snapshot.strain);
  return row;
}

std::string joined(const std::vector<int>& members) {
  std::string text;
  for (const int member : members) text += (text.empty() ? "" : "+") + std::to_string(member);
  return text;
}

/// Rotation of the aggregate with the most cells (of equal ones the first); NaN when it has none.
double largest_rotation(const observe::Snapshot& snapshot) {
  std::map<int, int> sizes;
  for (const auto& cell : snapshot.cells) ++sizes[cell.aggregate];
  int most = 0;
  double rotation = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [label, size] : sizes) {
    if (size <= most) continue;
    most = size;
    const auto found = snapshot.rotation.find(label);
    rotation = found != snapshot.rotation.end() ? found->second : std::numeric_limits<double>::quiet_NaN();
  }
  return rotation;
}

}  // namespace

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string to_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

std::vector<std::string> column_names(const std::string& table) {
  const auto found = std::find(names.begin(), names.end(), table);
  std::vector<std::string> columns;
  if (found == names.end()) return columns;
  columns.emplace_back();
  for (const char c : headers[static_cast<std::size_t>(found - names.begin())]) {
    if (c == ',')
      columns.emplace_back();
    else if (c != '\n')
      columns.back() += c;
  }
  return columns;
}

void Tables::require(const std::filesystem::path& directory, const Mark& mark) {
  for (std::size_t k = 0; k < mark.size(); ++k) files::require(directory / names[k], mark[k]);
}

Tables::Tables(const std::filesystem::path& directory)
    : cells_(directory / names[0]),
      aggregates_(directory / names[1]),
      series_(directory / names[2]),
      sizes_(directory / names[3]) {
  for (std::size_t k = 0; k < headers.size(); ++k) {
    files()[k]->clear();
    files()[k]->write(headers[k]);
  }
}

Tables::Tables(const std::filesystem::path& directory, const Mark& mark)
    : cells_(directory / names[0]),
      aggregates_(directory / names[1]),
      series_(directory / names[2]),
      sizes_(directory / names[3]) {
  for (std::size_t k = 0; k < mark.size(); ++k) files()[k]->go_back(mark[k]);
}

void Tables::write(const observe::Snapshot& snapshot) {
  write_cells(snapshot);
  write_aggregates(snapshot);
  write_series(snapshot);
  for (AppendFile* file : files()) file->flush();
}

Tables::Mark Tables::mark() {
  Mark mark;
  for (std::size_t k = 0; k < mark.size(); ++k) mark[k] = files()[k]->mark();
  return mark;
}

void Tables::close() {
  for (AppendFile* file : files()) file->close();
}

void Tables::write_cells(const observe::Snapshot& snapshot) {
  for (const auto& cell : snapshot.cells) {
    Row row = begin_row(snapshot);
    row.add(cell.cell).add(cell.type).add(cell.x).add(cell.y).add(cell.angle).add(cell.deformation);
    row.add(cell.area).add(cell.perimeter).add(cell.min_gap).add(cell.aggregate);
    row.add(cell.tank_treading_angle).add(cell.through_image);
    row.add(cell.stretch_min).add(cell.stretch_max);
    cells_.write(row.line());
  }
}

void Tables::write_aggregates(const observe::Snapshot& snapshot) {
  struct Aggregate {
    std::vector<int> members;
    std::vector<const observe::ContactSnapshot*> contacts;
    bool through_image = false;
  };
  std::map<int, Aggregate> aggregates;
  std::map<int, int> label_of;
  for (const auto& cell : snapshot.cells) {
    auto& aggregate = aggregates[cell.aggregate];
    aggregate.members.push_back(cell.cell);
    aggregate.through_image = aggregate.through_image || cell.through_image;
    label_of[cell.cell] = cell.aggregate;
  }
  for (const auto& contact : snapshot.contacts) aggregates[label_of[contact.cell_a]].contacts.push_back(&contact);

  for (const auto& [label, aggregate] : aggregates) {
    Row start = begin_row(snapshot);
    start.add(snapshot.aggregate_count).add(label).add(joined(aggregate.members)).add(aggregate.through_image);
    const auto rotation = snapshot.rotation.find(label);
    if (rotation != snapshot.rotation.end())
      start.add(rotation->second);
    else
      start.skip(1);
    if (aggregate.contacts.empty()) aggregates_.write(Row(start).skip(6).line());
    for (const auto* contact : aggregate.contacts) {
      Row row(start);
      row.add(contact->cell_a).add(contact->cell_b).add(contact->image[0]).add(contact->image[1]);
      row.add(contact->gap).add(contact->contact_length);
      aggregates_.write(row.line());
    }
  }
}

void Tables::write_series(const observe::Snapshot& snapshot) {
  Row row = begin_row(snapshot);
  row.add(snapshot.stage).add(snapshot.stage_name).add(snapshot.aggregate_count).add(largest_rotation(snapshot));
  row.add(snapshot.relative_viscosity).add(snapshot.particle_stress).add(snapshot.mach_max);
  row.add(snapshot.area_drift_max).add(snapshot.mass_drift).add(snapshot.area_leakage_max);
  row.add(snapshot.flow_rate).add(snapshot.cell_free_layer_lower).add(snapshot.cell_free_layer_upper);
  row.add(snapshot.aggregate_size_number_mean).add(snapshot.aggregate_size_weight_mean);
  const observe::EnergySnapshot& energy = snapshot.energy;
  row.add(energy.kinetic).add(energy.elastic).add(energy.bending).add(energy.interaction).add(energy.total);
  row.add(energy.viscous_dissipation).add(energy.membrane_dissipation);
  row.add(energy.wall_power).add(energy.body_force_power);
  series_.write(row.line());
  for (const auto& [cells, aggregates] : snapshot.aggregate_sizes) {
    sizes_.write(begin_row(snapshot).add(cells).add(aggregates).line());
  }
}

}  // namespace rouleau::files
