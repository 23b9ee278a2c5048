#include "unit_grammar.hpp"

#include <algorithm>

#include "base/text.hpp"

namespace rouleau::units {
namespace {

constexpr std::string_view superscript_digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
constexpr std::string_view middle_dot = "·";
constexpr std::string_view unknown_to_udunits[] = {"⁺", "⁻", "\u00A0"};  // in places where they would have a meaning

class Reader {
 public:
  explicit Reader(std::string_view unit) : rest_(unit) {}

  bool unit() {
    spaces();
    if (rest_.starts_with('1')) {
      rest_.remove_prefix(1);
      spaces();
      if (rest_.empty()) return true;
      if (!take("/")) return false;
    }
    return product() && rest_.empty();
  }
  std::vector<std::string_view> symbols;

 private:
  bool take(std::string_view word) {
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  bool take_superscript() {
    return std::any_of(std::begin(superscript_digits), std::end(superscript_digits),
                       [this](std::string_view digit) { return take(digit); });
  }
  bool take_digit() {
    if (rest_.empty() || !is_digit(rest_.front())) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool spaces() {
    const auto before = rest_.size();
    while (take(" ") || take("\t")) continue;
    return rest_.size() != before;
  }

  bool product() {
    if (!factor()) return false;
    for (;;) {
      const bool apart = spaces();
      if (rest_.empty() || rest_.front() == ')') return true;
      take_operator(apart);
      if (!factor()) return false;
    }
  }
  /// Whether there is one.
  bool take_operator(bool apart) {
    if (apart && (take("per ") || take("PER "))) return true;
    return take("/") || take("*") || take(".") || take(middle_dot) || take("-");
  }
  bool factor() {
    spaces();
    if (take("(")) return product() && take(")") && power();
    return symbol() && power();
  }
  /// Bytes above 0x7F belong to letters such as the mu of "µm".
  [[nodiscard]] bool at_letter(std::size_t at) const {
    const char c = rest_[at];
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '%' || c == '\'' || c == '"') return true;
    if ((static_cast<unsigned char>(c) & 0x80U) == 0) return false;
    const auto here = rest_.substr(at);
    const auto begins = [&](std::string_view word) { return here.starts_with(word); };
    return !std::any_of(std::begin(superscript_digits), std::end(superscript_digits), begins) &&
           !std::any_of(std::begin(unknown_to_udunits), std::end(unknown_to_udunits), begins) && !begins(middle_dot);
  }
  /// From a letter to a letter, with digits between them as in "cmH2O".
  bool symbol() {
    std::size_t end = 0;
    for (std::size_t at = 0; at < rest_.size() && (at_letter(at) || (end > 0 && is_digit(rest_[at]))); ++at) {
      if (at_letter(at)) end = at + 1;
    }
    if (end == 0) return false;
    symbols.push_back(rest_.substr(0, end));
    rest_.remove_prefix(end);
    return true;
  }
  /// There may be none.
  bool power() {
    if (take_superscript()) return !take_superscript() || !take_superscript();
    const bool wanted = take("^") || take("**");
    const bool has_sign = rest_.size() > 1 && (rest_[0] == '-' || rest_[0] == '+') && is_digit(rest_[1]);
    if (has_sign) rest_.remove_prefix(1);
    if (!take_digit()) return !wanted;
    take_digit();
    return rest_.empty() || !is_digit(rest_.front());
  }

  std::string_view rest_;
};

}  // namespace

std::optional<std::vector<std::string_view>> symbols_of(std::string_view unit) {
  Reader reader(unit);
  if (!reader.unit()) return std::nullopt;
  return std::move(reader.symbols);
}

}  // namespace rouleau::units
