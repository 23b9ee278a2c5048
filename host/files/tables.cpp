#include "tables.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <variant>

#include "base/error.hpp"
#include "base/text.hpp"
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

StoredTable::StoredTable(const std::filesystem::path& file) : file_(file), text_((require_own(file), read_text(file))) {
  // Entries are moved together within the text that has been read.
  std::vector<std::size_t> row;  // ends of its entries
  std::size_t end = 0;
  bool quoted = false;
  const auto put = [&](char c) { text_[end++] = c; };
  for (std::size_t i = 0; i < text_.size(); ++i) {
    const char c = text_[i];
    if (quoted) {
      if (c != '"')
        put(c);
      else if (i + 1 < text_.size() && text_[i + 1] == '"')
        put(text_[++i]);
      else
        quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',' || c == '\n') {
      row.push_back(end);
      if (c == ',') continue;
      if (header_.empty()) {
        std::size_t from = 0;
        for (const std::size_t to : row) header_.push_back(text_.substr(from, to - from)), from = to;
        end = 0;
      } else if (row.size() == header_.size()) {
        begin_.insert(begin_.end(), row.begin(), row.end());
      } else {
        end = begin_.back();
      }
      row.clear();
    } else if (c != '\r') {
      put(c);
    }
  }
  text_.resize(begin_.back());
}

bool StoredTable::has(const std::string& column) const {
  return std::find(header_.begin(), header_.end(), column) != header_.end();
}

std::size_t StoredTable::index(const std::string& column) const {
  const auto found = std::find(header_.begin(), header_.end(), column);
  if (found == header_.end()) throw Error(Cause::bad_input, Place{file_.string()}, "has no column \"" + column + "\"");
  return static_cast<std::size_t>(found - header_.begin());
}

std::vector<double> StoredTable::numbers(const std::string& column) const {
  const std::size_t at = index(column);
  std::vector<double> values;
  values.reserve(rows());
  for (std::size_t row = 0; row < rows(); ++row) {
    double value = std::numeric_limits<double>::quiet_NaN();
    const std::string_view text = entry(row, at);
    std::from_chars(text.data(), text.data() + text.size(), value);  // reads "inf" and "nan" too
    values.push_back(value);
  }
  return values;
}

std::size_t StoredTable::count_of(const std::string& column) const {
  std::size_t count = 0;
  const auto values = numbers(column);
  for (std::size_t row = 0; row < values.size(); ++row) {
    // Numbered things stand in a row each, so that a number beyond the rows is a damaged one; NaN fails as well.
    if (!(values[row] >= 0 && values[row] < static_cast<double>(values.size()))) {
      throw Error(Cause::bad_input, Place{file_.string()},
                  "row " + std::to_string(row + 1) + " has " + in_quotes(std::string(entry(row, index(column)))) +
                      " in the column \"" + column + "\", which counts from 0 and has " +
                      std::to_string(values.size()) + " rows",
                  {"the file is damaged; repeat the run, or take the row out"});
    }
    count = std::max(count, static_cast<std::size_t>(values[row]) + 1);
  }
  return count;
}

std::vector<std::string> StoredTable::texts(const std::string& column) const {
  const std::size_t at = index(column);
  std::vector<std::string> values;
  values.reserve(rows());
  for (std::size_t row = 0; row < rows(); ++row) values.emplace_back(entry(row, at));
  return values;
}

}  // namespace rouleau::files
