// Cells from text, in the dialects that spreadsheets and programs write.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/text.hpp"
#include "cell_rows.hpp"

namespace rouleau::scene {
namespace {

/// UTF-8 of UTF-16, which begins with a byte order mark; `?` for what two units stand for.
std::string from_utf16(std::string_view bytes) {
  const std::size_t low = bytes[0] == '\xFF' ? 0 : 1;
  std::string text;
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
    const auto unit = static_cast<unsigned>(static_cast<unsigned char>(bytes[i + low])) |
                      static_cast<unsigned>(static_cast<unsigned char>(bytes[i + 1 - low])) << 8U;
    const auto put = [&](unsigned byte) { text += static_cast<char>(byte); };
    if (unit < 0x80U)
      put(unit);
    else if (unit < 0x800U)
      put(0xC0U | unit >> 6U), put(0x80U | (unit & 0x3FU));
    else if (unit < 0xD800U || unit > 0xDFFFU)
      put(0xE0U | unit >> 12U), put(0x80U | (unit >> 6U & 0x3FU)), put(0x80U | (unit & 0x3FU));
    else
      put('?');
  }
  return text;
}

bool is_blank(char c) { return c == ' ' || c == '\t'; }

class CsvTable {
 public:
  explicit CsvTable(const CellTableSource& source)
      : source_(source),
        text_(read_input(source.file, largest_input)),
        rows_(source.types, source.pointer, source.type) {
    if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF")) text_ = from_utf16(text_);
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    if (text_.find('\0') != std::string::npos)
      refuse_file("this file is no text: it holds a NUL byte; save it as CSV in UTF-8");
  }

  std::vector<CellPlacement> read() {
    if (text_.size() == at_)
      refuse_file("this file of cells is empty; its first line names the columns: type,x_um,y_um,angle_deg");
    read_header();
    while (next_line()) {
      split();
      if (!std::all_of(entries_.begin(), entries_.end(), [](const Entry& e) { return e.text.empty(); })) read_row();
    }
    if (rows_.cells.empty()) refuse_file("this file has no cells: there is no row below the header");
    return std::move(rows_.cells);
  }

 private:
  struct Entry {
    std::string text;
    std::size_t column;  ///< from 1
  };

  /// The next line that is neither blank nor a comment. Lines end with LF, CR LF or CR.
  bool next_line() {
    while (at_ < text_.size()) {
      const std::size_t begin = at_, end = std::min(text_.find_first_of("\r\n", at_), text_.size());
      at_ = end + (text_.compare(end, 2, "\r\n") == 0 ? 2 : 1);
      ++line_;
      present_ = std::string_view(text_).substr(begin, end - begin);
      const auto first = std::find_if_not(present_.begin(), present_.end(), is_blank);
      if (first == present_.end()) continue;
      if (*first != '#') return true;
      comment_ = present_;
      comment_line_ = line_;
    }
    return false;
  }

  /// An entry in double quotes ends with them; two of them are one.
  void split() {
    entries_.clear();
    std::size_t i = 0;
    for (;;) {
      while (i < present_.size() && is_blank(present_[i]) && present_[i] != separator_) ++i;
      Entry& entry = entries_.emplace_back(Entry{{}, i + 1});
      if (i < present_.size() && present_[i] == '"') {
        for (++i;; ++i) {
          if (i >= present_.size()) refuse(entry.column, "the quotation mark here is not closed in this line");
          if (present_[i] == '"' && (i + 1 == present_.size() || present_[++i] != '"')) break;
          entry.text += present_[i];
        }
        if (i < present_.size() && present_[i] == '"') ++i;
        while (i < present_.size() && is_blank(present_[i]) && present_[i] != separator_) ++i;
        if (i < present_.size() && present_[i] != separator_)
          refuse(i + 1, "something follows the quotation mark before the next separator");
      } else {
        const std::size_t end = std::min(present_.find(separator_, i), present_.size());
        entry.text = present_.substr(i, end - i);
        i = end;
      }
      while (!entry.text.empty() && is_blank(entry.text.back())) entry.text.pop_back();
      if (i >= present_.size()) return;
      ++i;
    }
  }

  /// As the line `sep=;` says, or by the header: semicolons, else commas, else tabs.
  void find_separator() {
    const auto has = [&](char c) { return present_.find(c) != std::string_view::npos; };
    separator_ = has(';') ? ';' : has(',') ? ',' : '\t';
  }

  void read_header() {
    if (!next_line()) refuse_file("this file has no line that names the columns: type,x_um,y_um,angle_deg");
    if (present_.starts_with("sep=") && present_.size() == 5) {
      separator_ = present_[4];
      if (!next_line()) refuse_file("this file has no cells: there is no header");
    } else {
      find_separator();
    }
    split();
    // Some programs make a comment of the header.
    const int row = line_;
    const bool has_names = std::any_of(entries_.begin(), entries_.end(), [](const Entry& e) {
      return e.text.find_first_not_of("0123456789.,+-eE") != std::string::npos;
    });
    if (!has_names && !comment_.empty()) {
      at_ = static_cast<std::size_t>(present_.data() - text_.data());
      line_ = comment_line_;
      present_ = comment_.substr(comment_.find('#') + 1);
      split();
    }
    if (entries_.size() == 1) {
      refuse(1, "this line has one column, " + in_quotes(entries_[0].text) +
                    "\nseparate the columns by commas, semicolons or tabs: type,x_um,y_um,angle_deg");
    }
    header_ = entries_.size();
    std::vector<std::string> names;
    for (const Entry& entry : entries_) names.emplace_back(entry.text);
    rows_.find_columns(names, source_.units, refuse_);
    if (line_ != row) line_ = row - 1;
  }

  void read_row() {
    if (entries_.size() != header_) {
      refuse(entries_.back().column, "this line has " + std::to_string(entries_.size()) + " entries, and the header " +
                                         std::to_string(header_) + "; give one for each column");
    }
    rows_.take_step(value_, text_of_, refuse_);
    const auto& type = rows_.columns.type;
    rows_.add(type ? std::optional(rows_.type_of(entries_[*type].text, refuse_)) : std::nullopt, line_, value_,
              text_of_, refuse_);
  }

  /// A decimal mark, a point or, in a file whose columns commas do not separate, a comma: the same in all of it.
  void take_mark(const Entry& entry, char mark) {
    const std::size_t at = entry.text.find(mark);
    if (at == std::string::npos) return;
    if (decimal_mark_ != '\0' && decimal_mark_ != mark) {
      refuse(entry.column, in_quotes(entry.text) + " has a '" + mark + "', and numbers of this file have a '" +
                               decimal_mark_ + "'\nwrite all numbers alike, without marks between thousands");
    }
    if (mark == ',' && separator_ != ';' && decimal_mark_ == '\0' && entry.text.size() - at == 4)
      refuse(entry.column, in_quotes(entry.text) + " may mean thousands or thousandths\nwrite it with a decimal point");
    decimal_mark_ = mark;
  }

  [[nodiscard]] double value(std::size_t column, const std::string& name) {
    const Entry& entry = entries_[column];
    std::string text = entry.text;
    take_mark(entry, '.');
    if (separator_ != ',') {
      take_mark(entry, ',');
      if (const std::size_t comma = text.find(','); comma != std::string::npos) text[comma] = '.';
    }
    double result = 0;
    const char* const begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(begin, end, result);
    if (error != std::errc{} || stopped != end || text.empty() || !std::isfinite(result))
      refuse(entry.column, in_quotes(entry.text) + " is no number; the column " + name + " has one in each row");
    return result;
  }

  /// Of the file as a whole.
  [[noreturn]] void refuse_file(const std::string& problem) const {
    throw Error(Cause::bad_input, Place{source_.file.string()}, indented(problem));
  }
  [[noreturn]] void refuse(std::size_t column, const std::string& problem) const {
    throw Error(Cause::bad_input, Place{source_.file.string(), {}, line_, static_cast<int>(column)}, indented(problem));
  }

  const CellTableSource& source_;
  std::string text_;
  std::size_t at_ = 0;  ///< where the next line begins
  int line_ = 0, comment_line_ = 0;
  std::string_view present_, comment_;  ///< the present line, the last comment
  char separator_ = ',', decimal_mark_ = '\0';
  std::vector<Entry> entries_;  ///< of the present line
  std::size_t header_ = 0;      ///< columns
  CellRows rows_;
  const RefuseColumn refuse_ = [this](std::optional<std::size_t> column, const std::string& problem) {
    refuse(column ? entries_[*column].column : 1, problem);
  };
  const CellRows::Text text_of_ = [this](std::size_t column) { return entries_[column].text; };
  const CellRows::Value value_ = [this](std::size_t column, const std::string& name) { return value(column, name); };
};

}  // namespace

std::vector<CellPlacement> read_csv_cells(const CellTableSource& source) { return CsvTable(source).read(); }

}  // namespace rouleau::scene
