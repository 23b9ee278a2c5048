#include "command_line.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <iostream>
#include <sstream>
#include <system_error>

#include "base/error.hpp"
#include "base/text.hpp"
#include "program.hpp"
#include "terminal.hpp"
#include "units/units.hpp"

namespace rouleau::command {

namespace options = boost::program_options;

namespace {

/// The options that are given by name: `help` has shown the positional ones in its first line.
options::options_description named(const options::options_description& all,
                                   const options::positional_options_description& positional) {
  constexpr unsigned one_line = 1000;  // they are broken later, and never within a word
  options::options_description result("options", one_line, one_line / 2);
  for (const auto& option : all.options()) {
    bool by_place = false;
    // A command may take any number of arguments by place, but has no more names for them than options.
    const auto places = std::min<std::size_t>(positional.max_total_count(), all.options().size());
    for (unsigned place = 0; place < places; ++place)
      by_place = by_place || positional.name_for_position(place) == option->long_name();
    if (!by_place) result.add(option);
  }
  return result;
}

/// Words behind the value of a --set that the shell has cut off it: `--set /fluid/viscosity=6 cP`. What names a file is
/// meant to stand there.
std::string unquoted_set(const std::vector<std::string>& arguments) {
  const auto is_option = [](const std::string& word) { return word.starts_with("--"); };
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const bool joined = arguments[i].starts_with("--set=");
    if (!joined && (arguments[i] != "--set" || i + 1 == arguments.size())) continue;
    const std::string first = joined ? arguments[i].substr(6) : arguments[i + 1];
    std::string whole = first;
    std::error_code ignored;
    for (std::size_t k = i + (joined ? 1 : 2); k < arguments.size() && !is_option(arguments[k]); ++k) {
      if (arguments[k].ends_with(".json") || std::filesystem::is_regular_file(arguments[k], ignored)) break;
      whole += ' ' + arguments[k];
    }
    if (whole != first) return whole;
  }
  return {};
}

}  // namespace

bool parse_command_line(const std::string& command, const std::string& help, const std::vector<std::string>& arguments,
                        options::options_description& description,
                        const options::positional_options_description& positional) {
  description.add_options()("help", "this text");
  std::vector<std::string> own;
  for (const auto& option : description.options()) own.push_back(option->long_name());
  know_options(std::move(own));
  const Remedy hint{"rouleau " + command + " --help lists the options"};
  try {
    options::variables_map values;
    options::store(options::command_line_parser(arguments)
                       .options(description)
                       .positional(positional)
                       .extra_parser([](const std::string& word) {
                         return std::pair<std::string, std::string>(word == "-h" ? "help" : "", "");
                       })
                       .style(options::command_line_style::default_style & ~options::command_line_style::allow_guessing)
                       .run(),
                   values);
    if (values.count("help") != 0) {
      std::ostringstream listed;
      listed << named(description, positional);
      std::cout << reflowed(help, text_width(100)) << "\n" << folded(listed.str(), text_width(100));
      return false;
    }
    options::notify(values);
    return true;
  } catch (const options::unknown_option& unknown) {
    std::vector<std::string> names;
    for (const auto& option : description.options()) names.push_back("--" + option->long_name());
    const std::string near = nearest(unknown.get_option_name(), names);
    throw Error(Cause::bad_input,
                "unknown option " + unknown.get_option_name() + (near.empty() ? "" : "; did you mean " + near + "?"),
                hint);
  } catch (const options::required_option& missing) {
    // Only what is given by place is required, and its users do not know it as an option.
    const auto& option = description.find(missing.get_option_name().substr(2), false);
    throw Error(Cause::bad_input, "a " + option.description() + " is missing", hint);
  } catch (const options::too_many_positional_options_error&) {
    const bool sets = description.find_nothrow("set", false) != nullptr;
    if (const std::string whole = sets ? unquoted_set(arguments) : ""; !whole.empty()) {
      throw Error(Cause::bad_input, "--set " + whole + ": the shell takes this for several words",
                  {"quote the whole: --set " + in_shell(whole)});
    }
    throw Error(Cause::bad_input,
                "more words stand without an option than it takes, " + std::to_string(positional.max_total_count()),
                hint);
  } catch (const options::error& error) {
    throw Error(Cause::bad_input, error.what(), hint);
  }
}

std::function<void(const std::string&)> not_empty(const std::string& option) {
  return [option](const std::string& value) {
    if (value.empty()) throw Error(Cause::bad_input, option + " is empty; give it a value, or leave the option out");
  };
}

std::filesystem::path directory_for(const std::string& file) {
  const std::filesystem::path stem = std::filesystem::path(file).stem();
  if (stem.empty() || stem == "." || stem == "..")
    throw Error(Cause::bad_input, Place{file}, "has no name from which that of a directory could be made",
                {"name the directory with --out"});
  return std::filesystem::path("runs") / stem;
}

std::string in_shell(const std::string& word) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || std::strchr("/._-+=:,@%", c) != nullptr; };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + '\'';
}

double seconds_in(const std::string& option, const std::string& text) {
  // "5min" as well as "5 min"; a plain number is seconds.
  const std::size_t digits = text.find_first_not_of("0123456789.eE+-");
  const std::string number_text = text.substr(0, digits);
  const std::string unit = digits == std::string::npos ? "s" : text.substr(text.find_first_not_of(' ', digits));
  double seconds = NAN;
  try {
    seconds = units::Units().to_si(number_text + ' ' + unit, "s", option);
  } catch (const units::UnitError& error) {
    throw Error(Cause::bad_input, option + " " + in_quotes(text) + ": " + error.what());
  }
  if (seconds > 0) return seconds;
  throw Error(Cause::bad_input, option + " " + in_quotes(text) + ": wants a time above zero, for example 5min");
}

}  // namespace rouleau::command
