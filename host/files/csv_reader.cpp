#include "csv_reader.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "base/error.hpp"
#include "base/text.hpp"
#include "file.hpp"

namespace rouleau::files {

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
