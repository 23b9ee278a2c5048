// Potentials that take velocities: each lane gets those of its own contact, in blocks of any size.
#include <rouleau/interaction.hpp>

#include <algorithm>
#include <catch2/catch.hpp>

#include "instruction_sets.hpp"
#include "model_setup.hpp"

namespace {

using namespace rouleau::test;

/// Energy is the distance, force the approach, its derivative the sliding and a thousand times its speed: what went in
/// comes out.
struct Mirror {
  explicit Mirror(const rouleau::Parameters&) {}
  double cutoff() const { return 1; }
  template <class S>
  rouleau::Pair<S> operator()(const rouleau::Contact<S>& contact) const {
    return {contact.distance, contact.normal_velocity, contact.tangential_velocity + 1000.0 * contact.sliding_speed};
  }
};

}  // namespace

TEST_CASE("a potential that takes a contact gets its distance, both velocities and the speed") {
  constexpr std::size_t count = 37;
  double in[3][count], out[3][count];
  for (std::size_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) in[k][i] = 100.0 * k + static_cast<double>(i);
  }
  const rouleau_model model = rouleau::interaction<Mirror>("mirror", "1.0.0");
  const Self self = make(model, {});
  const auto check = [&](const std::string& set, bool host_of_1_0) {
    const auto compute =
        pick_for<rouleau::detail::InteractionLoop<Mirror>, const void*, const rouleau_interaction_block*>(set);
    for (const std::size_t size : {1UL, 3UL, 8UL, count}) {
      CAPTURE(set, host_of_1_0, size);
      for (std::size_t first = 0; first < count; first += size) {
        rouleau_interaction_block block{};
        block.struct_size = host_of_1_0 ? offsetof(rouleau_interaction_block, sliding_speed) : sizeof block;
        block.count = static_cast<std::uint32_t>(std::min(size, count - first));
        block.distance = in[0] + first, block.normal_velocity = in[1] + first,
        block.tangential_velocity = in[2] + first;
        block.sliding_speed = in[0] + first;  // not to be read where the block ends before it
        block.energy = out[0] + first, block.force = out[1] + first, block.force_by_distance = out[2] + first;
        compute(self.get(), &block);
      }
      for (int k = 0; k < 2; ++k) CHECK(std::equal(in[k], in[k] + count, out[k]));
      for (std::size_t i = 0; i < count; ++i) CHECK(out[2][i] == in[2][i] + (host_of_1_0 ? 0 : 1000 * in[0][i]));
    }
  };
  for (const auto& set : instruction_sets()) {
    check(set, false);
    check(set, true);
  }
}
