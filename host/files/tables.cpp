#include "tables.hpp"

#include <charconv>
#include <cmath>
#include <variant>

#include "observe/observables.hpp"

namespace rouleau::files {

namespace {

std::filesystem::path file_of(const observe::Table& table) { return std::string(table.name) + ".csv"; }

/// One line of a table, without the end.
std::string line_of(const std::vector<std::string>& entries) {
  std::string text;
  for (const std::string& entry : entries) (text += entry) += ',';
  text.back() = '\n';
  return text;
}

/// An entry of a row.
struct Entry {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(double value) const { return to_text(value); }
  std::string operator()(long value) const { return std::to_string(value); }
  std::string operator()(bool value) const { return value ? "1" : "0"; }
  std::string operator()(const std::string& text) const { return csv_text(text); }
};

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

void Tables::require(const std::filesystem::path& directory, const Mark& mark) {
  for (std::size_t k = 0; k < mark.size(); ++k) files::require(directory / file_of(observe::tables()[k]), mark[k]);
}

Tables::Tables(const std::filesystem::path& directory, const observe::RunKind& run, Kept kept) : run_(run) {
  for (const observe::Table& table : observe::tables()) {
    files_.emplace_back(directory / file_of(table), kept);
    files_.back().clear();
    files_.back().write(line_of(table.columns(run)));
  }
}

Tables::Tables(const std::filesystem::path& directory, const observe::RunKind& run, const Mark& mark) : run_(run) {
  for (std::size_t k = 0; k < mark.size(); ++k) {
    files_.emplace_back(directory / file_of(observe::tables()[k]));
    files_.back().go_back(mark[k]);
  }
}

void Tables::write(const observe::Snapshot& snapshot) {
  std::vector<std::string> entries;
  for (std::size_t k = 0; k < files_.size(); ++k) {
    const observe::Table& table = observe::tables()[k];
    const std::vector<const observe::Observable*> observables = table.of(run_);
    table.for_each_row(snapshot, [&](const observe::Row& row) {
      entries.clear();
      for (const observe::Observable* observable : observables)
        entries.push_back(std::visit(Entry(), observable->value(row)));
      files_[k].write(line_of(entries));
    });
    files_[k].flush();
  }
}

Tables::Mark Tables::mark() {
  Mark mark;
  for (std::size_t k = 0; k < mark.size(); ++k) mark[k] = files_[k].mark();
  return mark;
}

void Tables::close() {
  for (AppendFile& file : files_) file.close();
}

}  // namespace rouleau::files
