#include "schema.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <regex>
#include <set>

#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "json_pointer.hpp"
#include "schema_words.hpp"
#include "shown.hpp"

namespace rouleau::json {

using Json = nlohmann::json;

namespace {

struct SchemaFault {
  std::string pointer;
  bool at_key;  ///< the key is at fault rather than its value
  std::string problem;
};
using Found = std::vector<SchemaFault>;

void append(Found& found, Found more) {
  found.insert(found.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// Matching recurses several times for every character of a text, so that a long one would exhaust the stack.
constexpr std::size_t longest_matched = 1000;  // bytes

/// A pattern of the schemas, which are asked for often: compiling one takes longer than all else that reading does.
const std::regex& compiled(const std::string& pattern) {
  thread_local std::map<std::string, std::regex> known;
  const auto found = known.find(pattern);
  return found != known.end() ? found->second : known.emplace(pattern, pattern).first->second;
}

/// Keys that belong to the other branches of a choice: known, but not beside the keys that are there.
using OtherKeys = std::vector<std::string>;

/// How much of what is wrong is asked for.
enum class Ask { whether, what };

class Explainer {
 public:
  Explainer(const Document& document, const Json& schema, Ask ask = Ask::what)
      : document_(document), schema_(schema), ask_(ask) {}

  /// A value, its pointer, and its node in the text (none when it was made by --set).
  struct At {
    const Json& value;
    std::string pointer;
    std::optional<TextTree::Index> node;
  };

  /// Faults in the order of the text; one at most where only is asked whether there is one.
  [[nodiscard]] Found explain(const At& at, const Json& unresolved, const OtherKeys& others = {}) const {
    Json described;  // a description beside a $ref speaks of this use of the rule
    const Json* chosen = &resolve(schema_, unresolved);
    if (chosen != &unresolved && unresolved.contains("description")) {
      described = *chosen;
      described["description"] = unresolved["description"];
      chosen = &described;
    }
    const Json& rule = *chosen;
    if (rule.is_boolean()) return rule.get<bool>() ? Found{} : fault(at, "nothing may stand here");
    if (auto found = wrong_kind(at, rule); !found.empty()) return found;
    if (auto found = wrong_number(at, rule); !found.empty()) return found;
    if (auto found = wrong_text(at, rule); !found.empty()) return found;
    Found found;
    if (at.value.is_array()) found = wrong_array(at, rule);
    if (at.value.is_object()) found = wrong_object(at, rule, others);
    if (rule.contains("oneOf") && found.empty()) return wrong_choice(at, rule, rule["oneOf"]);
    return found;
  }

 private:
  [[nodiscard]] static Found fault(const At& at, const std::string& problem) {
    return {SchemaFault{at.pointer, false, problem}};
  }

  /// Nobody reads more, and the text may hold a million.
  [[nodiscard]] bool enough(const Found& found) const {
    constexpr std::size_t most = 200;
    return found.size() >= (ask_ == Ask::whether ? 1 : most);
  }

  /// The schema's own words about a value, as a second sentence.
  [[nodiscard]] static std::string description(const At& at, const Json& rule) {
    if (!rule.contains("description")) return "";
    return "\n" + subject(at.pointer) + ": " + rule["description"].get<std::string>();
  }

  [[nodiscard]] std::string described_member(const std::string& key, const Json& rule) const {
    const Json& source = rule.contains("description") ? rule : resolve(schema_, rule);
    return source.contains("description") ? "\n" + key + ": " + source["description"].get<std::string>() : "";
  }

  [[nodiscard]] Found wrong_kind(const At& at, const Json& rule) const {
    const auto name = subject(at.pointer);
    if (rule.contains("const") && at.value != rule["const"]) {
      return fault(
          at, "found " + shown(at.value) + "; " + name + " must be " + shown(rule["const"]) + description(at, rule));
    }
    if (rule.contains("enum") && std::find(rule["enum"].begin(), rule["enum"].end(), at.value) == rule["enum"].end())
      return fault(at, not_among(at.value, name, rule["enum"]) + description(at, rule));
    if (fits_type(at.value, rule)) return {};
    std::string remedy;
    if (at.value.is_string() && Json::accept(at.value.get_ref<const std::string&>())) {
      const auto bare = Json::parse(at.value.get_ref<const std::string&>());
      if (!bare.is_string() && fits_type(bare, rule)) remedy = "; write " + shown(bare) + " without quotes";
    }
    if (at.value.is_number_float() && at.value.get<double>() == std::floor(at.value.get<double>()) &&
        std::abs(at.value.get<double>()) < 1e15 && fits_type(Json(1), rule))
      remedy = "; write " + number(at.value.get<double>(), 15);
    return fault(at, "found " + kind_and_value(at.value) + "; " + name + " wants " + wanted_kind(schema_, rule) +
                         remedy + description(at, rule));
  }

  [[nodiscard]] static Found wrong_number(const At& at, const Json& rule) {
    if (!at.value.is_number()) return {};
    const auto value = at.value.get<double>();
    const auto bound = [&](const char* key) { return rule[key].get<double>(); };
    const bool bad = (rule.contains("minimum") && value < bound("minimum")) ||
                     (rule.contains("maximum") && value > bound("maximum")) ||
                     (rule.contains("exclusiveMinimum") && value <= bound("exclusiveMinimum")) ||
                     (rule.contains("exclusiveMaximum") && value >= bound("exclusiveMaximum"));
    if (!bad) return {};
    return fault(at, shown(at.value) + " is out of range; " + subject(at.pointer) + " must be " + range_words(rule) +
                         description(at, rule));
  }

  [[nodiscard]] static Found wrong_text(const At& at, const Json& rule) {
    if (!at.value.is_string()) return {};
    const auto& text = at.value.get_ref<const std::string&>();
    const auto name = subject(at.pointer);
    const auto length = character_count(text);
    if (rule.contains("minLength") && length < rule["minLength"].get<std::size_t>()) {
      return fault(
          at, (text.empty() ? "an empty text" : in_quotes(text)) + " is too short for " + name + description(at, rule));
    }
    if (rule.contains("maxLength") && length > rule["maxLength"].get<std::size_t>()) {
      return fault(at, in_quotes(text) + " has " + std::to_string(length) + " characters; " + name + " may have " +
                           std::to_string(rule["maxLength"].get<std::size_t>()));
    }
    if (rule.contains("pattern") && text.size() > longest_matched) {
      return fault(at, in_quotes(text) + " is too long for " + name + ": at most " + std::to_string(longest_matched) +
                           " bytes" + description(at, rule));
    }
    if (rule.contains("pattern") && !std::regex_search(text, compiled(rule["pattern"].get<std::string>())))
      return fault(at, in_quotes(text) + " cannot be used for " + name + description(at, rule));
    return {};
  }

  [[nodiscard]] Found wrong_array(const At& at, const Json& rule) const {
    const auto size = at.value.size();
    const auto least = rule.value("minItems", std::size_t{0});
    const auto most = rule.value("maxItems", static_cast<std::size_t>(-1));
    if (size < least || size > most) {
      const auto want = least == most
                            ? "exactly " + std::to_string(least)
                            : (size < least ? "at least " + std::to_string(least) : "at most " + std::to_string(most));
      return fault(at, "found " + std::to_string(size) + (size == 1 ? " value; " : " values; ") + subject(at.pointer) +
                           " wants " + want + description(at, rule));
    }
    const auto nodes = at.node ? document_.tree().children(*at.node) : std::vector<TextTree::Index>{};
    Found found;
    for (std::size_t i = 0; rule.contains("items") && i < size && !enough(found); ++i) {
      auto pointer = child_pointer(at.pointer, i);
      const bool in_text = i < nodes.size() && !document_.overridden(pointer);
      const auto node = in_text ? std::optional(nodes[i]) : std::nullopt;
      append(found, explain({at.value[i], std::move(pointer), node}, rule["items"]));
    }
    if (rule.value("uniqueItems", false) && found.empty()) {
      std::set<Json> seen;
      for (std::size_t i = 0; i < size && !enough(found); ++i) {
        if (seen.insert(at.value[i]).second) continue;
        found.push_back({child_pointer(at.pointer, i), false,
                         shown(at.value[i]) + " stands twice in " + subject(at.pointer) + "; keep one of them"});
      }
    }
    return found;
  }

  /// Members in the text's order, then those made by --set.
  [[nodiscard]] std::vector<std::pair<std::string, std::optional<TextTree::Index>>> members(const At& at) const {
    std::vector<std::pair<std::string, std::optional<TextTree::Index>>> list;
    std::set<std::string> listed;
    if (at.node) {
      for (const auto node : document_.tree().children(*at.node)) {
        auto key = TextTree::key(document_.text(), document_.tree()[node].key);
        const bool in_text = !document_.overridden(child_pointer(at.pointer, key));
        listed.insert(key);
        list.emplace_back(std::move(key), in_text ? std::optional(node) : std::nullopt);
      }
    }
    for (const auto& [key, value] : at.value.items())
      if (!listed.contains(key)) list.emplace_back(key, std::nullopt);
    return list;
  }

  [[nodiscard]] Found wrong_object(const At& at, const Json& rule, const OtherKeys& others) const {
    const Json none = Json::object();
    const Json& properties = rule.contains("properties") ? rule["properties"] : none;
    const Json& patterns = rule.contains("patternProperties") ? rule["patternProperties"] : none;
    Found found;
    std::vector<std::string> misspelt_here;  // known keys that unknown ones were most likely meant to be
    for (const auto& [key, node] : members(at)) {
      if (enough(found)) return found;
      const At member{at.value.at(key), child_pointer(at.pointer, key), node};
      const bool known = properties.contains(key);
      if (known) append(found, explain(member, properties[key]));
      bool matched = false;
      for (const auto& [pattern, part] : patterns.items()) {
        if (!std::regex_search(key, compiled(pattern))) continue;
        matched = true;
        append(found, explain(member, part));
      }
      if (known || matched || !rule.contains("additionalProperties")) continue;
      const Json& additional = rule["additionalProperties"];
      if (additional == Json(false)) {
        const auto allowed = keys_of(properties);
        misspelt_here.push_back(likely(key, allowed));
        found.push_back(unknown_key(member.pointer, key, allowed, others));
      } else {
        append(found, explain(member, additional));
      }
    }
    if (enough(found)) return found;
    if (rule.contains("required")) {
      for (const auto& key : rule["required"]) {
        const auto& word = key.get_ref<const std::string&>();
        if (at.value.contains(word)) continue;
        if (std::find(misspelt_here.begin(), misspelt_here.end(), word) != misspelt_here.end()) continue;
        append(found,
               fault(at, in_quotes(word) + " is missing" + (at.pointer.empty() ? "" : " in " + subject(at.pointer)) +
                             (properties.contains(word) ? described_member(word, properties[word]) : "")));
      }
    }
    if (!found.empty()) return found;
    const auto least = rule.value("minProperties", std::size_t{0});
    if (at.value.size() < least) {
      const auto keys = properties.empty() ? "" : "; possible: " + listed(keys_of(properties));
      return fault(at, subject(at.pointer) + " must not be empty" + keys + description(at, rule));
    }
    const auto most = rule.value("maxProperties", static_cast<std::size_t>(-1));
    if (at.value.size() > most) {
      return fault(at, "found " + std::to_string(at.value.size()) + " keys; " + subject(at.pointer) +
                           " may have at most " + std::to_string(most) + description(at, rule));
    }
    return {};
  }

  /// Says where else a key stands that has nothing like it here.
  [[nodiscard]] std::string known_elsewhere(const std::string& key) const {
    const auto places = places_of_keys(schema_);
    std::vector<std::string> keys;
    keys.reserve(places.size());
    for (const auto& [known, where] : places) keys.push_back(known);
    auto near = synonym(key, keys);
    if (near.empty()) near = misspelt(key, keys);
    constexpr std::size_t most = 2;  // "angle" and "strain" stand in so many places that none is likely
    if (near.empty() || places.at(near).size() > most) return "";
    return "; did you mean " + listed(places.at(near)) + "?";
  }

  [[nodiscard]] SchemaFault unknown_key(const std::string& pointer, const std::string& key,
                                        const std::vector<std::string>& allowed, const OtherKeys& others) const {
    if (std::find(others.begin(), others.end(), key) != others.end()) {
      return {
          pointer, true,
          in_quotes(key) + " cannot stand here together with the other keys\nallowed beside them: " + listed(allowed)};
    }
    if (ask_ == Ask::whether) return {pointer, true, {}};  // looking for it elsewhere takes time
    const auto here = did_you_mean(key, allowed);
    return {pointer, true,
            "unknown key " + in_quotes(key) + (here.empty() ? known_elsewhere(key) : here) +
                "\nallowed here: " + listed(allowed)};
  }

  [[nodiscard]] Found wrong_choice(const At& at, const Json& rule, const Json& branches) const {
    const Explainer judge(document_, schema_, Ask::whether);
    const auto fitting = std::count_if(branches.begin(), branches.end(),
                                       [&](const Json& branch) { return judge.explain(at, branch).empty(); });
    if (fitting == 1) return {};
    if (ask_ == Ask::whether) return fault(at, "");  // shapes within shapes would double the work with every level
    const Choice choice(schema_, branches, at.value);
    const auto name = subject(at.pointer);
    if (fitting > 1) {
      return fault(at, name + " can be read in " + std::to_string(fitting) +
                           " ways, and must be one of: " + choice.wanted + description(at, rule));
    }
    if (choice.possible.empty() || (at.value.is_string() && choice.only_words)) {
      if (at.value.is_string() && !choice.words.empty()) {
        const auto near = did_you_mean(at.value.get_ref<const std::string&>(), choice.words);
        return fault(at, "found " + kind_and_value(at.value) + near + "\n" + name + " wants " + choice.wanted +
                             description(at, rule));
      }
      return fault(
          at, "found " + kind_and_value(at.value) + "; " + name + " wants " + choice.wanted + description(at, rule));
    }
    if (choice.meant.size() == 1) return explain(at, *choice.meant.front(), choice.other_keys);
    // Nothing in the object tells the branches apart: a key is misspelt, two of them decide, or none does.
    Found found;
    std::string first;
    for (const auto& member : members(at)) {
      const auto& key = member.first;
      const auto in = [&key](const std::vector<std::string>& keys) {
        return std::find(keys.begin(), keys.end(), key) != keys.end();
      };
      if (!in(choice.all_keys)) found.push_back(unknown_key(child_pointer(at.pointer, key), key, choice.all_keys, {}));
      if (enough(found)) return found;
      if (!in(choice.deciding_keys)) continue;
      if (!first.empty()) {
        found.push_back({child_pointer(at.pointer, key), true,
                         in_quotes(key) + " cannot stand beside " + in_quotes(first) + "; " + name +
                             " takes only one of: " + listed(choice.deciding_keys)});
        return found;
      }
      first = key;
    }
    if (!found.empty()) return found;
    return fault(at, name + " needs one of: " + listed(choice.deciding_keys) + description(at, rule));
  }

  const Document& document_;
  const Json& schema_;
  Ask ask_;
};

}  // namespace

void judge(const Document& document, const Json& schema, Faults& faults, Cause cause) {
  const auto node = document.tree().size() > 0 ? std::optional<TextTree::Index>(0) : std::nullopt;
  for (const SchemaFault& fault : Explainer(document, schema).explain({document.root(), "", node}, schema)) {
    faults.add({cause, fault.at_key ? document.key_place(fault.pointer) : document.place(fault.pointer),
                indented(fault.problem)});
  }
}

void validate(const Document& document, const Json& schema, Cause cause) {
  Faults faults;
  judge(document, schema, faults, cause);
  faults.raise();
}

}  // namespace rouleau::json
