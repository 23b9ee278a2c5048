// Reads a scene as `rouleau plan` does, up to and not including its plugins: `read_scene plan SCENE [--set
// POINTER=VALUE]...` prints the message of the first fault and returns its exit code. For
// tests/scenes/run_bad_scenes.py and for fuzzing.
#include <cstdio>
#include <string>
#include <vector>

#include "scene/scene.hpp"

int main(int count, char** arguments) {
  if (count < 3 || std::string(arguments[1]) != "plan") {
    std::fputs("usage: read_scene plan SCENE [--set POINTER=VALUE]...\n", stderr);
    return static_cast<int>(rouleau::ExitCode::bad_input);
  }
  std::vector<std::string> overrides;
  for (int i = 4; i < count; i += 2) overrides.emplace_back(arguments[i]);
  try {
    const auto scene = rouleau::scene::read_scene(arguments[2], overrides);
    std::printf("%zu cells, %zu stages\n", scene.cells.size(), scene.stages.size());
    return static_cast<int>(rouleau::ExitCode::done);
  } catch (const rouleau::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
}
