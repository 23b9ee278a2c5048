// The last words of a process that a plugin or a library ends: whichever way it does that, a sentence names the cause.
#pragma once

#include <string>

namespace rouleau::command {

/// From here a crash, an uncaught exception or an end of the process within a plugin's function (base/foreign_call.hpp)
/// prints a sentence that names plugin and function, and ends the process with exit_code::plugin_refused. So do, with
/// exit_code::input_output and words about memory, a crash, an uncaught std::bad_alloc and an end of the process where
/// memory has just been refused; any other crash is called one. What comes from outside is as it would be without.
void name_culprits();

/// The program is about to end by itself.
void expect_end();

/// Of several ranks, one that is not the first: its last words begin with its name, and come only if the launcher has
/// not ended it by then, as it does when the first has said the same.
void speak_as(const std::string& name);

}  // namespace rouleau::command
