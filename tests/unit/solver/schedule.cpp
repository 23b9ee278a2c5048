// The order of a step.
#include "core/solver/schedule.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

namespace rouleau::core {

TEST_CASE("what ranks tell each other about cells is on its way during another task") {
  using Pair = std::pair<Task, Task>;
  const std::array messages{Pair{Task::send_positions, Task::receive_positions},  // in the next step
                            Pair{Task::send_reactions, Task::receive_reactions},
                            Pair{Task::send_forces, Task::receive_forces}, Pair{Task::send_halo, Task::receive_halo},
                            Pair{Task::send_velocities, Task::receive_velocities}};
  for (int choice = 0; choice < 32; ++choice) {
    const auto chosen = [&](int bit) { return (choice >> bit & 1) != 0; };
    const StepFeatures features{.cells = true,
                                .interactions = chosen(0),
                                .wall_interactions = chosen(1),
                                .viscosity_contrast = chosen(2),
                                .area_correction = chosen(3),
                                .moving_frame = chosen(4),
                                .ranks = true};
    CAPTURE(choice);
    const std::vector<Step> steps = make_schedule(features).steps;
    const auto find = [&](Task task) {
      return std::find_if(steps.begin(), steps.end(), [&](const Step& step) { return step.task == task; });
    };
    for (const auto& [send, receive] : messages) {
      if (send == Task::send_reactions && !features.interactions) {
        CHECK(find(send) == steps.end());
        CHECK(find(receive) == steps.end());
        continue;
      }
      REQUIRE(find(send) != steps.end());
      REQUIRE(find(receive) != steps.end());
      const auto count = static_cast<std::ptrdiff_t>(steps.size());
      const std::ptrdiff_t later = (find(receive) - find(send) + count) % count;
      CHECK(later > 1);
      // Between the two halves of one message lies no other: they come in the order in which they are sent.
      for (std::ptrdiff_t k = 1; k < later; ++k) {
        const Step& between = steps[static_cast<std::size_t>((find(send) - steps.begin() + k) % count)];
        CHECK(std::string(between.name) != "ranks");
      }
      // One worker receives for all.
      CHECK(find(receive)->meeting == Meeting::all);
    }
    // Forces between cells need the places of others.
    if (features.interactions) CHECK(find(Task::receive_positions) < find(Task::find_contacts));
    CHECK(find(Task::locate_ghosts) < find(Task::spread));
  }
}

}  // namespace rouleau::core
