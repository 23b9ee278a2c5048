// Surroundings of the same call that a model must not notice, each in a process of its own.
#pragma once

#include <string>

#include "conform/subject.hpp"

namespace rouleau::conform {

/// What is other in a world, as bits of a number.
namespace world {
inline constexpr unsigned memory = 1, addresses = 2, clock = 4, environment = 8, folder = 16, processor = 32, all = 63;
}

/// Becomes this program again, with the same words and one more, in that world. Returns where the kernel refuses.
void enter_world(unsigned other, int count, char** words);

/// What the model gives in the world that was entered, a number a line with its name; lines "# with ..." say for which
/// parameters. "!name" alone is a variable of the environment that it has asked for.
std::string outputs_in_world(const Subject& subject, unsigned other);

/// The same from a process of its own; a JSON finding instead when that process ended in another way.
std::string outputs_of_process(const Subject& subject, unsigned other);

}  // namespace rouleau::conform
