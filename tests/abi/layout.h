/* Layout of every struct of the plugin interface on machines with 64-bit pointers (LP64), as released in version 1.0,
 * and with what 1.1 appends.
 * A failure here means that plugins which are out in the world break: append fields, never move or resize them. An
 * appended field gets its line here; the sizes grow with it. */
#ifndef ROULEAU_TESTS_ABI_LAYOUT_H
#define ROULEAU_TESTS_ABI_LAYOUT_H

#include <rouleau/plugin.h>

#ifdef __cplusplus
#define LAYOUT_ASSERT(condition, text) static_assert(condition, text)
#else
#define LAYOUT_ASSERT(condition, text) _Static_assert(condition, text)
#endif
#define SIZE(type, bytes) LAYOUT_ASSERT(sizeof(type) == (bytes), "size of " #type)
#define FIELD(type, field, offset) LAYOUT_ASSERT(offsetof(type, field) == (offset), #type "::" #field)
/* Padding at the end would take in an appended field without a change of struct_size. */
#define LAST(type, field) \
  LAYOUT_ASSERT(offsetof(type, field) + sizeof(((type*)0)->field) == sizeof(type), "padding at the end of " #type)

#if defined(__LP64__)

SIZE(rouleau_setup, 104);
FIELD(rouleau_setup, struct_size, 0);
FIELD(rouleau_setup, host_minor, 4);
FIELD(rouleau_setup, parameter_count, 8);
FIELD(rouleau_setup, parameter_names, 16);
FIELD(rouleau_setup, parameter_values, 24);
FIELD(rouleau_setup, length_unit, 32);
FIELD(rouleau_setup, time_unit, 40);
FIELD(rouleau_setup, mass_unit, 48);
FIELD(rouleau_setup, dimension, 56);
FIELD(rouleau_setup, velocity_count, 60);
FIELD(rouleau_setup, velocities, 64);
FIELD(rouleau_setup, weights, 72);
FIELD(rouleau_setup, sound_speed_squared, 80);
FIELD(rouleau_setup, relaxation_rate, 88);
FIELD(rouleau_setup, inertia, 96);
FIELD(rouleau_setup, reserved, 100);
LAST(rouleau_setup, reserved);

SIZE(rouleau_collision_block_f64, 48);
FIELD(rouleau_collision_block_f64, struct_size, 0);
FIELD(rouleau_collision_block_f64, count, 4);
FIELD(rouleau_collision_block_f64, in, 8);
FIELD(rouleau_collision_block_f64, out, 16);
FIELD(rouleau_collision_block_f64, force, 24);
FIELD(rouleau_collision_block_f64, relaxation_rate, 32);
FIELD(rouleau_collision_block_f64, velocity, 40);
LAST(rouleau_collision_block_f64, velocity);

SIZE(rouleau_collision_block_f32, 48);
FIELD(rouleau_collision_block_f32, struct_size, 0);
FIELD(rouleau_collision_block_f32, count, 4);
FIELD(rouleau_collision_block_f32, in, 8);
FIELD(rouleau_collision_block_f32, out, 16);
FIELD(rouleau_collision_block_f32, force, 24);
FIELD(rouleau_collision_block_f32, relaxation_rate, 32);
FIELD(rouleau_collision_block_f32, velocity, 40);
LAST(rouleau_collision_block_f32, velocity);

SIZE(rouleau_collision, 24);
FIELD(rouleau_collision, struct_size, 0);
FIELD(rouleau_collision, collide_f64, 8);
FIELD(rouleau_collision, collide_f32, 16);
LAST(rouleau_collision, collide_f32);

SIZE(rouleau_membrane_block, 312);
FIELD(rouleau_membrane_block, struct_size, 0);
FIELD(rouleau_membrane_block, count, 4);
FIELD(rouleau_membrane_block, time_step, 8);
FIELD(rouleau_membrane_block, stretch, 16);
FIELD(rouleau_membrane_block, stretch_rate, 24);
FIELD(rouleau_membrane_block, curvature, 32);
FIELD(rouleau_membrane_block, rest_curvature, 40);
FIELD(rouleau_membrane_block, area, 48);
FIELD(rouleau_membrane_block, rest_area, 56);
FIELD(rouleau_membrane_block, perimeter, 64);
FIELD(rouleau_membrane_block, rest_perimeter, 72);
FIELD(rouleau_membrane_block, tension, 80);
FIELD(rouleau_membrane_block, moment, 88);
FIELD(rouleau_membrane_block, pressure, 96);
FIELD(rouleau_membrane_block, perimeter_tension, 104);
FIELD(rouleau_membrane_block, energy, 112);
FIELD(rouleau_membrane_block, tension_by_stretch, 120);
FIELD(rouleau_membrane_block, tension_by_rate, 128);
FIELD(rouleau_membrane_block, moment_by_curvature, 136);
FIELD(rouleau_membrane_block, state, 144);
FIELD(rouleau_membrane_block, new_state, 152);
FIELD(rouleau_membrane_block, invariant_1, 160);
FIELD(rouleau_membrane_block, invariant_2, 168);
FIELD(rouleau_membrane_block, invariant_1_rate, 176);
FIELD(rouleau_membrane_block, invariant_2_rate, 184);
FIELD(rouleau_membrane_block, area_ratio, 192);
FIELD(rouleau_membrane_block, volume, 200);
FIELD(rouleau_membrane_block, rest_volume, 208);
FIELD(rouleau_membrane_block, surface_area, 216);
FIELD(rouleau_membrane_block, rest_surface_area, 224);
FIELD(rouleau_membrane_block, stress_1, 232);
FIELD(rouleau_membrane_block, stress_2, 240);
FIELD(rouleau_membrane_block, area_tension, 248);
FIELD(rouleau_membrane_block, surface_tension, 256);
FIELD(rouleau_membrane_block, shear_viscosity, 264);
FIELD(rouleau_membrane_block, area_viscosity, 272);
FIELD(rouleau_membrane_block, stress_1_by_1, 280);
FIELD(rouleau_membrane_block, stress_1_by_2, 288);
FIELD(rouleau_membrane_block, stress_2_by_2, 296);
FIELD(rouleau_membrane_block, area_tension_by_ratio, 304);
LAST(rouleau_membrane_block, area_tension_by_ratio);

SIZE(rouleau_membrane, 16);
FIELD(rouleau_membrane, struct_size, 0);
FIELD(rouleau_membrane, compute, 8);
LAST(rouleau_membrane, compute);

SIZE(rouleau_interaction_block, 88);
FIELD(rouleau_interaction_block, struct_size, 0);
FIELD(rouleau_interaction_block, count, 4);
FIELD(rouleau_interaction_block, time_step, 8);
FIELD(rouleau_interaction_block, distance, 16);
FIELD(rouleau_interaction_block, normal_velocity, 24);
FIELD(rouleau_interaction_block, tangential_velocity, 32);
FIELD(rouleau_interaction_block, energy, 40);
FIELD(rouleau_interaction_block, force, 48);
FIELD(rouleau_interaction_block, force_by_distance, 56);
FIELD(rouleau_interaction_block, state, 64);
FIELD(rouleau_interaction_block, new_state, 72);
FIELD(rouleau_interaction_block, sliding_speed, 80);
LAST(rouleau_interaction_block, sliding_speed);

SIZE(rouleau_interaction, 24);
FIELD(rouleau_interaction, struct_size, 0);
FIELD(rouleau_interaction, cutoff, 8);
FIELD(rouleau_interaction, compute, 16);
LAST(rouleau_interaction, compute);

SIZE(rouleau_model, 64);
FIELD(rouleau_model, struct_size, 0);
FIELD(rouleau_model, kind, 4);
FIELD(rouleau_model, id, 8);
FIELD(rouleau_model, version, 16);
FIELD(rouleau_model, create, 24);
FIELD(rouleau_model, destroy, 32);
FIELD(rouleau_model, collision, 40);
FIELD(rouleau_model, membrane, 48);
FIELD(rouleau_model, interaction, 56);
LAST(rouleau_model, interaction);

SIZE(rouleau_plugin, 16);
FIELD(rouleau_plugin, struct_size, 0);
FIELD(rouleau_plugin, abi_minor, 4);
FIELD(rouleau_plugin, models, 8);
LAST(rouleau_plugin, models);

#endif

LAYOUT_ASSERT(ROULEAU_ABI_MAJOR == 1 && ROULEAU_ABI_MINOR == 1, "a new version needs its own lines here");
LAYOUT_ASSERT(ROULEAU_COLLISION_KIND == 1 && ROULEAU_MEMBRANE_KIND == 2 && ROULEAU_INTERACTION_KIND == 3, "kinds");

#endif
