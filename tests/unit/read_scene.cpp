// Reads a scene as `rouleau plan` does, up to and not including its plugins: `read_scene plan SCENE [--set
// POINTER=VALUE]...` prints the message of the first fault and returns its exit code. For
// tests/scenes/check_bad_scenes.py and for fuzzing.
#include <cstdio>
#include <string>
#include <vector>

#include "command/process/program.hpp"
#include "plan/read_scene.hpp"

int main(int count, char** arguments) {
  using namespace rouleau::command;
  if (count < 3 || std::string(arguments[1]) != "plan") {
    std::fputs("usage: read_scene plan SCENE [--set POINTER=VALUE]...\n", stderr);
    return exit_code::bad_input;
  }
  std::vector<std::string> overrides;
  for (int i = 4; i < count; i += 2) overrides.emplace_back(arguments[i]);
  const auto body = [&] {
    const auto scene = rouleau::plan::read_scene(arguments[2], overrides);
    std::printf("%zu cells, %zu stages\n", scene.cells.size(), scene.stages.size());
    return exit_code::done;
  };
  return run_program(body, "");
}
