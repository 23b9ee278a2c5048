#include "program.hpp"

#include <exception>
#include <filesystem>
#include <iostream>
#include <new>

namespace rouleau::command {

namespace {

const char* option_for(Way way) {
  switch (way) {
    case Way::elsewhere:
      return "--out";
    case Way::anew:
      return "--overwrite";
    case Way::resume:
      return "--resume";
    case Way::accept:
      return "--force";
  }
  return "";
}

int fail(const std::string& message, int code) {
  std::cerr << message << '\n';
  return code;
}

}  // namespace

int exit_code_of(Cause cause) {
  switch (cause) {
    case Cause::bad_input:
      return exit_code::bad_input;
    case Cause::plugin_refused:
      return exit_code::plugin_refused;
    case Cause::input_output:
      break;
  }
  return exit_code::input_output;
}

std::string in_options(const Remedy& remedy) {
  std::string options;
  for (const Way way : remedy.ways) options += (options.empty() ? " (" : ", ") + std::string(option_for(way));
  return remedy.words + options + (options.empty() ? "" : ")");
}

int run_program(const std::function<int()>& body, const std::string& too_large) {
  try {
    const int code = body();
    std::cout.flush();
    // A full disk or a closed pipe must not look like success to the script that reads the output.
    return std::cout ? code : fail("rouleau: the output could not be written", exit_code::input_output);
  } catch (const Error& error) {
    const Error shown(error.cause(), error.place(), error.problem(), {in_options(error.remedy())});
    return fail(shown.what(), exit_code_of(error.cause()));
  } catch (const std::bad_alloc&) {
    return fail("rouleau: there is not enough memory" + too_large, exit_code::input_output);
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(std::string("rouleau: ") + error.what(), exit_code::input_output);
  } catch (const std::exception& error) {
    return fail(std::string("rouleau: internal error, please report it: ") + error.what(), exit_code::input_output);
  }
}

}  // namespace rouleau::command
