#include "csv_reader.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "base/error.hpp"
#include "base/text.hpp"
#include "file.hpp"

namespace rouleau::files {

StoredTable::StoredTable(const std::filesystem::path& file) : file_(file) {
  const std::string text = read_text(file);
  std::vector<std::string> row;
  std::string entry;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c != '"')
        entry += c;
      else if (i + 1 < text.size() && text[i + 1] == '"')
        entry += text[++i];
      else
        quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',' || c == '\n') {
      row.push_back(std::exchange(entry, {}));
      if (c == ',') continue;
      if (header_.empty())
        header_ = std::move(row);
      else if (row.size() == header_.size())
        rows_.push_back(std::move(row));
      row.clear();
    } else if (c != '\r') {
      entry += c;
    }
  }
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
  values.reserve(rows_.size());
  for (const auto& row : rows_) {
    double value = std::numeric_limits<double>::quiet_NaN();
    std::from_chars(row[at].data(), row[at].data() + row[at].size(), value);  // reads "inf" and "nan" too
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
                  "row " + std::to_string(row + 1) + " has " + in_quotes(rows_[row][index(column)]) +
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
  values.reserve(rows_.size());
  for (const auto& row : rows_) values.push_back(row[at]);
  return values;
}

}  // namespace rouleau::files
