// Surroundings of the same call that a model must not notice: a process of its own, and one in which all else is other.
#pragma once

#include <string>

#include "conform/subject.hpp"

namespace rouleau::conform {

enum class World { here, there };
/// As the word of a command line.
const char* to_string(World world);
World world_named(const std::string& name);

/// What differs between the two.
inline constexpr const char* what_differs =
    "what was in new memory or on the stack, addresses, the date, the environment, the working directory and mask, the "
    "thread and its processor";

/// Becomes this program again, with the same words and one more, in that world. Returns where the kernel refuses.
void enter_world(World world, int count, char** words);

/// What the model gives in the world that was entered, a number a line with its name; lines "# with ..." say for which
/// parameters.
std::string outputs_in_world(const Subject& subject, World world);

/// The same from a process of its own; a JSON finding instead when that process ended in another way.
std::string outputs_of_process(const Subject& subject, World world);

}  // namespace rouleau::conform
