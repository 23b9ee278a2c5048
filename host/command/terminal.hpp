// Standard output and standard error of the program, which no plugin can spoil.
#pragma once

namespace rouleau::command {

/// From here standard output belongs to std::cout alone: what anybody else prints there, a plugin for instance, goes to
/// standard error. What std::cout and std::cerr print cannot steer a terminal: control characters in names and titles
/// come out as \uXXXX, which means the same in JSON.
void take_terminal();

/// Standard output is the descriptor 1 again: for a program that this process becomes.
void give_terminal_back();

}  // namespace rouleau::command
