// The text of the files in sdk/template, and of scenes to begin from, which CMake compiles into the program
// (cmake/embed_texts.cmake).
#pragma once

#include <string_view>

namespace rouleau::command {

// In all of them ModelType stands for the name of the C++ type, model-name for that of the files and model-id for the
// manifest's id.
extern const std::string_view collision_source, collision_manifest;
extern const std::string_view membrane_source, membrane_manifest, membrane_3d_source, membrane_3d_manifest;
extern const std::string_view membrane_both_source, membrane_both_manifest;
extern const std::string_view interaction_source, interaction_manifest;
extern const std::string_view plugin_build_file;

extern const std::string_view demo_scene, channel_scene, suspension_scene, suspension_3d_scene, capsule_scene,
    red_cell_3d_scene, doublet_3d_scene, tube_3d_scene, vessel_scene, drawing_scene;
/// Which drawing_scene names drawing.png.
extern const std::string_view drawing_picture;

}  // namespace rouleau::command
