// What a checkpoint keeps of the links to walls of any shape.
#pragma once

#include "core/fluid/any_fluid.hpp"
#include "files/checkpoint_file.hpp"
#include "json/json.hpp"

namespace rouleau::run {

/// Writes the arrays, if there are links; `writer`: null on ranks that do not write. Returns how many there are.
std::size_t save_links(files::CheckpointWriter* writer, const core::LinkMemory& links);
/// Of the solver's part of a checkpoint. Former versions kept nothing, and took what came back for what had left.
core::LinkMemory read_links(const files::CheckpointReader& reader, const nlohmann::json& of_solver);

}  // namespace rouleau::run
