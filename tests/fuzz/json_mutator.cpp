#include "json_mutator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace rouleau::fuzz {

namespace {

using Json = nlohmann::ordered_json;
using Random = std::minstd_rand;

constexpr std::array<std::string_view, 34> units{
    "m",    "um",   "nm",    "1/um",   "1/m",    "s",          "ms",         "1/s",   "kg/m3", "g/cm3", "Pa s", "cP",
    "Pa",   "Pa/m", "N/m",   "uN/m",   "dyn/cm", "dyn cm",     "J/m2",       "J",     "N/m3",  "deg",   "rad",  "K",
    "degC", "kDa",  "g/mol", "mol/m3", "C/m2",   "m3 mol/kg2", "cm3 mol/g2", "N s/m", "%",     ""};
constexpr std::array<std::string_view, 24> numbers{
    "0",      "-0.0",  "1",       "-1",         "2",          "0.5",   "0.1",   "3.91",
    "8",      "100",   "1e-6",    "1e-9",       "1e-12",      "1e-15", "1e-30", "1e-300",
    "5e-324", "65536", "1000000", "2147483647", "4294967295", "1e12",  "1e300", "1.7e308"};

std::size_t below(std::size_t count, Random& random) { return random() % count; }
bool one_of(std::size_t many, Random& random) { return below(many, random) == 0; }
template <class List>
const auto& any(const List& list, Random& random) {
  return list[below(list.size(), random)];
}

/// Nothing for texts that are no JSON, or so deep that writing them would use up the stack.
std::optional<Json> parsed(const std::uint8_t* data, std::size_t size) {
  constexpr int deepest = 100;
  const auto shallow = [](int depth, Json::parse_event_t, Json&) { return depth < deepest; };
  auto json = Json::parse(data, data + size, shallow, false);
  if (json.is_discarded()) return std::nullopt;
  return json;
}

std::size_t written(const Json& json, std::uint8_t* out, std::size_t most) {
  const auto text = json.dump(-1, ' ', false, Json::error_handler_t::ignore);
  if (text.size() > most) return 0;
  std::memcpy(out, text.data(), text.size());
  return text.size();
}

void list_values(Json& value, std::vector<Json*>& found) {
  found.push_back(&value);
  if (value.is_structured()) {
    for (auto& member : value) list_values(member, found);
  }
}

/// Containers count twice: what they hold is what the host looks at.
Json& some_part(Json& root, Random& random) {
  std::vector<Json*> values;
  list_values(root, values);
  return *values[below(values.size(), random)];
}

/// What is beyond std::int64_t begins anew from its other end.
std::int64_t whole_number(const Json& value) {
  return value.is_number_unsigned() ? static_cast<std::int64_t>(value.get<std::uint64_t>()) : value.get<std::int64_t>();
}

void change_number(Json& value, Random& random) {
  const double number = value.get<double>();
  switch (below(6, random)) {
    case 0:
      value = Json::parse(any(numbers, random));
      break;
    case 1:
      value = number * std::pow(10.0, static_cast<int>(below(13, random)) - 6);
      break;
    case 2:
      value = -number;
      break;
    case 3:
      value = value.is_number_integer() ? Json(whole_number(value) / 2) : Json(number / 2);
      break;
    case 4:
      value = value.is_number_integer() ? Json(static_cast<std::uint64_t>(whole_number(value)) + 1) : Json(number + 1);
      break;
    default:
      value = below(20, random);
      break;
  }
  if (value.is_number_float() && !std::isfinite(value.get<double>())) value = 1e300;
}

}  // namespace

JsonMutator::JsonMutator(const nlohmann::json& schema, std::vector<std::string> more)
    : schema_(schema), words_(std::move(more)) {
  collect(schema);
  keys_.insert(keys_.end(), words_.begin(), words_.end());
}

void JsonMutator::collect(const nlohmann::json& schema) {
  if (!schema.is_structured()) return;
  const auto add = [](std::vector<std::string>& list, const std::string& word) {
    if (std::find(list.begin(), list.end(), word) == list.end()) list.push_back(word);
  };
  if (schema.is_object()) {
    if (schema.contains("properties")) {
      for (const auto& [key, rule] : schema["properties"].items()) {
        add(keys_, key);
        rules_[key].push_back(&rule);
      }
    }
    const auto enumerated = schema.value("enum", nlohmann::json::array());
    for (const auto& word : enumerated) {
      if (word.is_string()) add(words_, word);
    }
    if (schema.contains("const") && schema["const"].is_string()) add(words_, schema["const"]);
  }
  for (const auto& member : schema) collect(member);
}

Json JsonMutator::some_value(Random& random) const {
  switch (below(8, random)) {
    case 0:
      return nullptr;
    case 1:
      return one_of(2, random);
    case 2:
      return Json::array();
    case 3:
      return Json::object();
    case 4:
      return words_.empty() ? "" : any(words_, random);
    case 5:
      return std::string(any(numbers, random)) + ' ' + std::string(any(units, random));
    default:
      return Json::parse(any(numbers, random));
  }
}

Json JsonMutator::fitting(const nlohmann::json& rule, int depth, Random& random) const {
  if (depth > 8 || !rule.is_object()) return some_value(random);
  if (rule.contains("$ref")) {
    const auto reference = rule["$ref"].get<std::string>();  // "#/definitions/quantity"
    return fitting(schema_.at(nlohmann::json::json_pointer(reference.substr(1))), depth + 1, random);
  }
  if (rule.contains("const")) return rule["const"];
  if (rule.contains("enum")) return any(rule["enum"], random);
  for (const char* choice : {"oneOf", "anyOf"}) {
    if (rule.contains(choice)) return fitting(any(rule[choice], random), depth + 1, random);
  }
  const auto types = rule.value("type", nlohmann::json());
  const auto type = types.is_array()    ? any(types, random).get<std::string>()
                    : types.is_string() ? types.get<std::string>()
                                        : std::string();
  if (type == "boolean") return one_of(2, random);
  if (type == "string") return some_text(random);
  if (type == "number" || type == "integer") {
    // Over all orders of magnitude between the limits; a plain number is a quantity in SI, too.
    const bool whole = type == "integer";
    const double least = std::max(rule.value("minimum", rule.value("exclusiveMinimum", 0.0)), whole ? 1.0 : 1e-9);
    const double most = std::max(least, rule.value("maximum", 1e3));
    const double share = static_cast<double>(random()) / static_cast<double>(Random::max());
    const double value = least * std::pow(most / least, one_of(4, random) ? share : share * share);
    return whole ? Json(std::llround(value)) : Json(value);
  }
  if (type == "array") {
    Json list = Json::array();
    const auto least = rule.value("minItems", std::size_t{0});
    const auto count = least + below(std::max<std::size_t>(1, std::min<std::size_t>(3, rule.value("maxItems", 3U)) -
                                                                  std::min<std::size_t>(3, least) + 1),
                                     random);
    for (std::size_t i = 0; i < count; ++i) {
      list.push_back(rule.contains("items") ? fitting(rule["items"], depth + 1, random) : some_value(random));
    }
    return list;
  }
  Json object = Json::object();
  const auto required = rule.value("required", std::vector<std::string>{});
  if (rule.contains("properties")) {
    for (const auto& [key, part] : rule["properties"].items()) {
      const bool wanted = std::find(required.begin(), required.end(), key) != required.end();
      if (wanted || one_of(4, random)) object[key] = fitting(part, depth + 1, random);
    }
  }
  return object;
}

Json JsonMutator::value_for(const std::string& key, Random& random) const {
  const auto known = rules_.find(key);
  return known == rules_.end() ? some_value(random) : fitting(*any(known->second, random), 0, random);
}

std::string JsonMutator::some_text(Random& random) const {
  if (words_.empty() || one_of(2, random))
    return std::string(any(numbers, random)) + ' ' + std::string(any(units, random));
  return any(words_, random);
}

void JsonMutator::change_text(std::string& text, Random& random) const {
  const auto space = text.find(' ');
  switch (below(8, random)) {
    case 0:
      if (!words_.empty()) text = any(words_, random);
      break;
    case 1:
    case 2: {  // another number of the same unit, not far away or anywhere
      char* end = nullptr;
      const double number = std::strtod(text.c_str(), &end);
      if (space == std::string::npos || end == text.c_str()) {
        if (!words_.empty()) text = any(words_, random);
        break;
      }
      const double factor = std::pow(10.0, (static_cast<double>(below(41, random)) - 20) / 10);
      const auto written = one_of(4, random) ? std::string(any(numbers, random)) : Json(number * factor).dump();
      text = written + text.substr(space);
      break;
    }
    case 6:
      text = text.substr(0, space) + ' ' + std::string(any(units, random));
      break;
    case 3:
      text = std::string(any(numbers, random)) + ' ' + std::string(any(units, random));
      break;
    default: {
      const std::size_t size = text.size();
      text.resize(size + 8);
      text.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(text.data()), size, size + 8));
    }
  }
}

void JsonMutator::change_value(Json& value, Random& random) const {
  if (one_of(16, random)) {
    value = some_value(random);
  } else if (value.is_number()) {
    change_number(value, random);
  } else if (value.is_string()) {
    change_text(value.get_ref<std::string&>(), random);
  } else if (value.is_boolean()) {
    value = !value.get<bool>();
  } else if (value.is_array()) {
    const auto at = static_cast<std::ptrdiff_t>(value.empty() ? 0 : below(value.size(), random));
    if (value.empty() || one_of(4, random)) {
      value.push_back(some_value(random));
    } else if (one_of(2, random)) {
      const Json copy = value[static_cast<std::size_t>(at)];
      value.insert(value.begin() + at, copy);
    } else {
      value.erase(value.begin() + at);
    }
  } else if (value.is_object() && !keys_.empty()) {
    if (value.empty() || one_of(2, random)) {
      const auto& key = any(keys_, random);
      value[key] = value_for(key, random);
      return;
    }
    auto member = value.begin();
    std::advance(member, below(value.size(), random));
    switch (below(4, random)) {
      case 0:
        value.erase(member.key());
        break;
      case 1:
      case 2: {
        const std::string key = member.key();
        value[key] = value_for(key, random);
        break;
      }
      default: {
        const Json moved = member.value();
        value.erase(member.key());
        value[any(keys_, random)] = moved;
      }
    }
  } else {
    value = some_value(random);
  }
}

void JsonMutator::change(Json& root, Random& random) const {
  for (std::size_t changes = 1 + (one_of(2, random) ? 0 : below(4, random)); changes > 0; --changes) {
    if (one_of(16, random)) {  // a part of the text in another place
      const Json copy = some_part(root, random);
      some_part(root, random) = copy;
    } else {
      change_value(some_part(root, random), random);
    }
  }
}

std::size_t JsonMutator::mutate(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) const {
  Random random(seed);
  auto json = parsed(data, size);
  if (!json || one_of(10, random)) return LLVMFuzzerMutate(data, size, most);
  change(*json, random);
  const auto changed = written(*json, data, most);
  return changed > 0 ? changed : size;
}

std::size_t JsonMutator::cross(const std::uint8_t* first, std::size_t first_size, const std::uint8_t* second,
                               std::size_t second_size, std::uint8_t* out, std::size_t most, unsigned seed) {
  Random random(seed);
  auto into = parsed(first, first_size), from = parsed(second, second_size);
  if (!into || !from) return 0;
  // The same key in both is likelier to make sense than any two places.
  Json& target = some_part(*into, random);
  const Json& source = some_part(*from, random);
  if (target.is_object() && source.is_object() && !source.empty()) {
    auto member = source.begin();
    std::advance(member, below(source.size(), random));
    target[member.key()] = member.value();
  } else {
    target = source;
  }
  return written(*into, out, most);
}

}  // namespace rouleau::fuzz
