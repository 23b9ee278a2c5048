#include "scene.hpp"

namespace rouleau::scene {

std::array<std::string, 2> Scene::names_of(const Interaction& interaction) const {
  const auto name = [&](int type) -> std::string {
    if (type == Interaction::wall) return wall_name;
    return type == Interaction::self ? self_name : cell_types[type].name;
  };
  return {name(interaction.between[0]), name(interaction.between[1])};
}

}  // namespace rouleau::scene
