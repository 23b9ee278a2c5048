// The interface as C++17 sees it: the same layout as in C, in plain structs.
#include "layout.h"

#include <type_traits>

static_assert(std::is_standard_layout_v<rouleau_setup> && std::is_trivial_v<rouleau_setup>);
static_assert(std::is_standard_layout_v<rouleau_collision_block_f64> && std::is_trivial_v<rouleau_collision_block_f64>);
static_assert(std::is_standard_layout_v<rouleau_collision_block_f32> && std::is_trivial_v<rouleau_collision_block_f32>);
static_assert(std::is_standard_layout_v<rouleau_membrane_block> && std::is_trivial_v<rouleau_membrane_block>);
static_assert(std::is_standard_layout_v<rouleau_interaction_block> && std::is_trivial_v<rouleau_interaction_block>);
static_assert(std::is_standard_layout_v<rouleau_model> && std::is_trivial_v<rouleau_model>);
static_assert(std::is_standard_layout_v<rouleau_plugin> && std::is_trivial_v<rouleau_plugin>);

extern "C" int check_layout_in_c(void);

int main() { return check_layout_in_c(); }
