#include "program.hpp"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <rouleau/dispatch.hpp>
#include <string_view>

#include "base/foreign_call.hpp"
#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "crew.hpp"
#include "json/json.hpp"
#include "terminal.hpp"

namespace rouleau::command {

namespace {

std::vector<std::string> known_options;

/// Empty where the command has none.
std::string option_for(Way way) {
  const auto first_of = [](std::initializer_list<const char*> names) -> std::string {
    for (const char* name : names)
      if (std::find(known_options.begin(), known_options.end(), name) != known_options.end())
        return std::string("--") + name;
    return {};
  };
  if (way == Way::elsewhere) return first_of({"out", "dir"});
  if (way == Way::anew) return first_of({"overwrite"});
  return first_of({way == Way::resume ? "resume" : "force"});
}

Error for_terminal(const Error& error) {
  return {error.cause(), error.place(), error.problem(), {in_options(error.remedy())}};
}

int show(const std::string& message, int code) {
  // Place and problem in red; the lines below them say more.
  const auto first_line = message.find('\n');
  {
    const Coloured red(std::cerr, Colour::red);
    std::cerr << message.substr(0, first_line);
  }
  std::cerr << (first_line == std::string::npos ? "" : message.substr(first_line)) << '\n';
  return code;
}

/// Of several ranks the first one shows it, for all that fail together.
int fail(const std::string& message, int code) {
  Crew* const crew = Crew::present();
  if (crew == nullptr) return show(message, code);
  crew->report(code, crew->first() ? "" : crew->name() + ": " + message);
  return crew->first() ? show(message, code) : code;
}

nlohmann::json as_json(const Error& error) {
  const Place& place = error.place();
  return {{"file", place.file},     {"pointer", place.pointer},   {"line", place.line},
          {"column", place.column}, {"problem", error.problem()}, {"remedy", in_options(error.remedy())}};
}

/// One line for programs that start this one.
int fail_in_json(const Error& error, int code) {
  nlohmann::json faults = nlohmann::json::array();
  if (const auto* several = dynamic_cast<const SeveralFaults*>(&error))
    for (const Error& fault : several->faults()) faults.push_back(as_json(fault));
  else
    faults.push_back(as_json(error));
  nlohmann::json line = {{"faults", faults}, {"exit_code", code}};
  Crew* const crew = Crew::present();
  if (crew != nullptr && !crew->first()) line["rank"] = crew->name();
  const std::string words = line.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  if (crew != nullptr) crew->report(code, crew->first() ? "" : words);
  return crew == nullptr || crew->first() ? show(words, code) : code;
}

bool programs_read_errors() {
  const char* form = std::getenv("ROULEAU_ERRORS");
  return form != nullptr && std::string_view(form) == "json";
}

}  // namespace

int exit_code_of(Cause cause) {
  if (cause == Cause::bad_input) return exit_code::bad_input;
  return cause == Cause::plugin_refused ? exit_code::plugin_refused : exit_code::input_output;
}

std::string in_options(const Remedy& remedy) {
  std::string options;
  for (const Way way : remedy.ways) {
    const std::string option = option_for(way);
    if (!option.empty()) options += (options.empty() ? " (" : ", ") + option;
  }
  return remedy.words + options + (options.empty() ? "" : ")");
}

void know_options(std::vector<std::string> names) { known_options = std::move(names); }

void check_instruction_set() {
  const char* wanted = std::getenv("ROULEAU_INSTRUCTION_SET");
  if (wanted == nullptr || *wanted == '\0' || wanted == std::string_view(name_of(instruction_set()))) return;
  std::vector<std::string> names;
  for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512})
    names.emplace_back(name_of(set));
  const bool known = std::find(names.begin(), names.end(), wanted) != names.end();
  throw Error(Cause::bad_input,
              "the environment variable ROULEAU_INSTRUCTION_SET is " + in_quotes(wanted) +
                  (known ? ", which this processor does not have"
                         : "; it can be one of: " + listed(names) + did_you_mean(wanted, names)),
              {"unset it, or choose a set that is there"});
}

int run_program(const std::function<int()>& body, const std::string& too_large) {
  try {
    const int code = body();
    std::cout.flush();
    // A full disk or a closed pipe must not look like success to the script that reads the output.
    return std::cout || code != 0 ? code : fail("rouleau: the output could not be written", exit_code::input_output);
  } catch (const transport::Farewell& farewell) {
    return Crew::present()->first() ? show(farewell.what(), farewell.exit_code) : farewell.exit_code;
  } catch (const SeveralFaults& several) {
    if (programs_read_errors()) return fail_in_json(several, exit_code_of(several.cause()));
    return fail(several.with(for_terminal).what(), exit_code_of(several.cause()));
  } catch (const Error& error) {
    if (programs_read_errors()) return fail_in_json(error, exit_code_of(error.cause()));
    return fail(for_terminal(error).what(), exit_code_of(error.cause()));
  } catch (const ForeignException& exception) {
    const Error shown(Cause::plugin_refused, exception.what(), {"report it to the plugin's author"});
    return fail(shown.what(), exit_code::plugin_refused);
  } catch (const std::bad_alloc&) {
    return fail("rouleau: there is not enough memory" + too_large, exit_code::input_output);
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(std::string("rouleau: ") + error.what(), exit_code::input_output);
  } catch (const std::exception& error) {
    return fail(std::string("rouleau: internal error, please report it: ") + error.what(), exit_code::input_output);
  }
}

}  // namespace rouleau::command
