// rouleau conform MANIFEST...: becomes the program of tools/conform, which checks plugins.
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/installation.hpp"
#include "command/process/terminal.hpp"
#include "commands.hpp"

namespace rouleau::command {

std::filesystem::path conform_program() {
  std::filesystem::path program = installation().programs / "conform";
  if (std::filesystem::exists(program)) return program;
  throw Error(Cause::input_output, Place{program.string()}, "is not there, so no plugin can be checked",
              {"in a build of your own, cmake --build FOLDER --target conform makes it"});
}

int conform_command(const std::vector<std::string>& arguments) {
  const std::string program = conform_program();
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  give_terminal_back();
  ::execv(program.c_str(), pointers.data());
  throw Error(Cause::input_output, program + " could not be started: " + std::strerror(errno));
}

}  // namespace rouleau::command
