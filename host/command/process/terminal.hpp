// Standard output and standard error of the program, which no plugin can spoil.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>

namespace rouleau::command {

/// From here standard output belongs to std::cout alone: what anybody else prints there, a plugin for instance, goes to
/// standard error. What std::cout and std::cerr print cannot steer a terminal: control characters in names and titles
/// come out as \uXXXX, which means the same in JSON.
void take_terminal();

/// Nothing that std::cout and std::cerr print is shown: the first rank of a run speaks for the others.
void silence_terminal();

/// Standard output is the descriptor 1 again: for a program that this process becomes.
void give_terminal_back();

/// Characters in a line of what is printed: COLUMNS, or what the terminal has, at least 40 and at most 100. Lines of
/// what goes into a file or another program, which may look for words in them, are as long as they are: `without`.
std::size_t text_width(std::size_t without = std::string::npos);

enum class Colour { red = 31, green = 32, yellow = 33 };

/// What is printed to the stream meanwhile is coloured, if the stream is std::cout or std::cerr, leads to a terminal,
/// and neither NO_COLOR (https://no-color.org) nor TERM=dumb asks for plain text.
class Coloured {
 public:
  Coloured(std::ostream& stream, Colour colour);
  ~Coloured();
  Coloured(const Coloured&) = delete;
  Coloured& operator=(const Coloured&) = delete;

 private:
  std::ostream& stream_;
  bool shown_;
};

}  // namespace rouleau::command
