#include "units.hpp"

#include <udunits2.h>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <vector>

#include "base/error.hpp"
#include "base/installation.hpp"
#include "base/text.hpp"
#include "dimension_names.hpp"

namespace rouleau::units {

namespace {

using Unit = std::unique_ptr<ut_unit, decltype(&ut_free)>;

/// A unit taken apart: one of it is `scale` coherent SI units of `dimension`, and its zero lies at `offset` of them.
struct Parts {
  Dimension dimension;
  double scale = 1.0;
  double offset = 0.0;
  std::string refused;  ///< why a unit that UDUNITS knows cannot be used here; empty when it can
};

ut_status refuse(Parts& parts, const char* reason) {
  parts.refused = reason;
  return UT_SUCCESS;
}

void add_base(Parts& parts, const ut_unit* base, int power) {
  constexpr std::array<std::string_view, 6> known{"kg", "m", "s", "K", "mol", "A"};
  const char* found = ut_get_symbol(base, UT_ASCII);
  const std::string_view symbol = found == nullptr ? "" : found;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (symbol == known[i]) {
      parts.dimension.exponent[i] += power;
      return;
    }
  }
  if (symbol != "rad") parts.refused = "only kg, m, s, K, mol, A and angles can be used";
}

/// Walks down the structure that UDUNITS keeps; `arg` is the Parts to fill.
ut_status visit_basic(const ut_unit* unit, void* arg) {
  add_base(*static_cast<Parts*>(arg), unit, 1);
  return UT_SUCCESS;
}
ut_status visit_product(const ut_unit*, int count, const ut_unit* const* units, const int* powers, void* arg) {
  for (int i = 0; i < count; ++i) add_base(*static_cast<Parts*>(arg), units[i], powers[i]);
  return UT_SUCCESS;
}
ut_status visit_galilean(const ut_unit*, double scale, const ut_unit* under, double offset, void* arg);
ut_status visit_timestamp(const ut_unit*, const ut_unit*, double, void* arg) {
  return refuse(*static_cast<Parts*>(arg), "dates cannot be used");
}
ut_status visit_logarithmic(const ut_unit*, double, const ut_unit*, void* arg) {
  return refuse(*static_cast<Parts*>(arg), "logarithmic units cannot be used");
}

constexpr ut_visitor visitor{visit_basic, visit_product, visit_galilean, visit_timestamp, visit_logarithmic};

ut_status visit_galilean(const ut_unit*, double scale, const ut_unit* under, double offset, void* arg) {
  auto& parts = *static_cast<Parts*>(arg);
  const double outer = parts.scale;
  parts.scale = outer * scale;
  parts.offset += offset * parts.scale;
  return ut_accept_visitor(under, &visitor, arg);
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// What a call of UDUNITS-2 returns, which takes a unit for unknown where it was refused memory: that is an exception
/// here.
template <class Call>
auto with_memory(Call&& call) {
  errno = 0;
  auto result = call();
  if (errno == ENOMEM) throw std::bad_alloc();
  return result;
}

using UnitSystem = std::unique_ptr<ut_system, decltype(&ut_free_system)>;

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
    for (std::size_t at = 0; at < rest_.size() && (at_letter(at) || (end > 0 && is_digit(rest_[at]))); ++at)
      if (at_letter(at)) end = at + 1;
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

struct Units::System {
  UnitSystem system{nullptr, &ut_free_system};

  static std::shared_ptr<const System> read();

  [[nodiscard]] Unit parse(const std::string& text) const {
    return with_memory([&] { return Unit(ut_parse(system.get(), text.c_str(), UT_UTF8), &ut_free); });
  }

  /// Gives a symbol the meaning of `definition`, unless the database has the symbol already.
  void define(const char* symbol, const char* definition) const {
    if (parse(symbol)) return;
    const auto unit = parse(definition);
    if (unit) with_memory([&] { return ut_map_symbol_to_unit(symbol, UT_ASCII, unit.get()); });
  }

  static Parts parts_of(const Unit& unit) {
    Parts parts;
    const auto status = with_memory([&] { return ut_accept_visitor(unit.get(), &visitor, &parts); });
    if (status != UT_SUCCESS) parts.refused = "its meaning is unknown";
    return parts;
  }

  /// Throws where the symbol cannot be used in `unit`. `wanted`: see take_apart.
  void require_usable(const std::string& symbol, std::string_view unit, const Dimension* wanted) const {
    const auto parsed = parse(symbol);
    Parts parts;
    if (parsed)
      parts = parts_of(parsed);
    else if (symbol == "lg" || symbol == "ln" || symbol == "lb")
      visit_logarithmic(nullptr, 0, nullptr, &parts);
    else
      throw UnitError(unknown_unit(unit, symbol, wanted));
    if (!parts.refused.empty()) throw UnitError(in_quotes(unit) + " is not possible: " + parts.refused);
  }

  /// Usual units of a dimension.
  [[nodiscard]] std::vector<std::string> units_of(const Dimension& dimension) const {
    std::vector<std::string> found;
    for (const auto& list : {usual_units(), usual_compounds()}) {
      for (const auto unit : list) {
        const auto parsed = parse(std::string(unit));
        if (!parsed) continue;
        const Parts parts = parts_of(parsed);
        if (parts.refused.empty() && parts.dimension == dimension) found.emplace_back(unit);
      }
    }
    return found;
  }

  /// Words for a unit that holds an unknown symbol: what is nearest among the units of the wanted dimension, if that is
  /// known, before what the symbol alone looks like.
  [[nodiscard]] std::string unknown_unit(std::string_view unit, const std::string& symbol,
                                         const Dimension* wanted) const {
    const auto suggested = [](std::string_view found, const std::string& near) {
      return "unknown unit " + in_quotes(found) + (near.empty() ? "" : " (did you mean " + in_quotes(near) + "?)");
    };
    const auto of_dimension = wanted != nullptr ? nearest(unit, units_of(*wanted)) : "";
    if (!of_dimension.empty()) return suggested(unit, of_dimension);
    return suggested(symbol, nearest(symbol, {usual_units().begin(), usual_units().end()}));
  }

  /// `wanted`: the dimension that the unit should have, where that is known.
  [[nodiscard]] Parts take_apart(std::string_view unit, const Dimension* wanted = nullptr) const {
    constexpr std::size_t longest_unit = 100;
    unit = trimmed(unit);
    if (unit.empty()) throw UnitError("a unit is missing");
    if (unit.size() > longest_unit) throw UnitError(in_quotes(unit) + " is no unit");
    const auto symbols = printable(unit) == unit ? symbols_of(unit) : std::nullopt;
    if (!symbols) {
      throw UnitError(in_quotes(unit) +
                      " is no unit; write units like N/m, 1/um or dyn cm, with one number in front of them");
    }
    for (const auto symbol : *symbols) require_usable(std::string(symbol), unit, wanted);
    const auto parsed = parse(std::string(unit));
    if (!parsed) throw UnitError(in_quotes(unit) + " is no unit; write units like N/m, 1/um or dyn cm");
    Parts parts = parts_of(parsed);
    if (!parts.refused.empty()) throw UnitError(in_quotes(unit) + " is not possible: " + parts.refused);
    if (!std::isfinite(parts.scale) || !(parts.scale > 0))
      throw UnitError(in_quotes(unit) + " is too large or too small a unit");
    return parts;
  }
};

/// The database that an installation which brings its libraries along has with it. Empty without one; UDUNITS then
/// looks where it was built to, as where the variable is set.
std::string installed_database() {
  if (secure_getenv("UDUNITS2_XML_PATH") != nullptr) return {};
  std::error_code error;
  const std::filesystem::path database = installation().data / "rouleau" / "udunits" / "udunits2.xml";
  return std::filesystem::exists(database, error) ? database.string() : std::string();
}

std::shared_ptr<const Units::System> Units::System::read() {
  auto read = std::make_shared<System>();
  ut_set_error_message_handler(ut_ignore);
  const std::string database = installed_database();
  read->system = with_memory(
      [&] { return UnitSystem(ut_read_xml(database.empty() ? nullptr : database.c_str()), &ut_free_system); });
  if (!read->system) {
    throw Error(
        Cause::input_output,
        "the database of units of UDUNITS-2 cannot be read (Debian: package libudunits2-data; see UDUNITS2_XML_PATH)");
  }
  read->define("dyn", "dyne");
  read->define("P", "poise");
  read->define("cP", "0.01 poise");
  read->define("deg", "degree");
  read->define("Da", "1.66053906660e-27 kg");  // CODATA 2018
  read->define("kDa", "1.66053906660e-24 kg");
  return read;
}

// Reading the database anew for each of its users was a sixth of all the instructions of `rouleau plan`.
Units::Units() {
  static const auto database = System::read();
  system_ = database;
}

Dimension Units::dimension(std::string_view unit) const { return system_->take_apart(unit).dimension; }

double Units::scale(std::string_view unit) const {
  const auto parts = system_->take_apart(unit);
  if (parts.offset != 0.0)
    throw UnitError(in_quotes(unit) + " is not a plain multiple of an SI unit, its zero is shifted; use K instead");
  return parts.scale;
}

double Units::to_si(std::string_view quantity, std::string_view wanted, std::string_view name) const {
  const auto dimension = this->dimension(wanted);
  const auto wants = "; " + std::string(name) + " wants " + wanted_unit(wanted, dimension);
  const auto text = trimmed(quantity);
  const auto unsigned_text = text.starts_with('+') ? text.substr(1) : text;
  double value = 0.0;
  const auto [end, failure] = std::from_chars(unsigned_text.data(), unsigned_text.data() + unsigned_text.size(), value);
  if (failure == std::errc::result_out_of_range)
    throw UnitError(in_quotes(quantity) + " is beyond the range of numbers" + wants);
  if (failure != std::errc{}) throw UnitError(in_quotes(quantity) + " does not begin with a number" + wants);
  if (!std::isfinite(value)) throw UnitError(in_quotes(quantity) + " is not finite" + wants);

  const auto unit = trimmed(unsigned_text.substr(static_cast<std::size_t>(end - unsigned_text.data())));
  if (unit.empty()) {
    if (dimension == Dimension{}) return value;
    throw UnitError(in_quotes(quantity) + " has no unit" + wants + "; a number without quotes is taken in SI units");
  }
  if (unit.front() == ',') throw UnitError(in_quotes(quantity) + " has a comma; write the number with a point" + wants);
  Parts parts;
  try {
    parts = system_->take_apart(unit, &dimension);
  } catch (const UnitError& error) {
    throw UnitError("in " + in_quotes(quantity) + ": " + error.what() + wants);
  }
  if (parts.dimension != dimension) throw UnitError(in_quotes(quantity) + " is " + kind_of(parts.dimension) + wants);
  if (parts.offset != 0.0 && trimmed(wanted) != "K")
    throw UnitError(in_quotes(quantity) + " is a temperature with a shifted zero" + wants);
  const double si = value * parts.scale + parts.offset;
  if (!std::isfinite(si)) throw UnitError(in_quotes(quantity) + " is beyond the range of numbers" + wants);
  return si;
}

std::optional<std::vector<std::string_view>> symbols_of(std::string_view unit) {
  Reader reader(unit);
  if (!reader.unit()) return std::nullopt;
  return std::move(reader.symbols);
}

}  // namespace rouleau::units
