// The names of what models of each kind read and write: the vocabulary of a manifest's "needs" and "gives".
#pragma once

#include <string>
#include <vector>

#include "manifest.hpp"

namespace rouleau::plugin {

/// Element of a membrane that a law describes (plugin.h, rouleau_membrane_block).
enum class MembraneElement { segment, triangle, node, cell };
const char* to_string(MembraneElement element);

/// Names that "needs" and "gives" of a kind may hold in two or three dimensions, in the order of plugin.h.
const std::vector<std::string>& inputs_of(ModelKind kind, int dimension);
const std::vector<std::string>& outputs_of(ModelKind kind, int dimension);

/// The element that a membrane law's input or output belongs to; none for "energy", which belongs to all.
std::optional<MembraneElement> element_of(const std::string& name);

/// SI dimension and unit ("N/m") of an input or output of a model; that of a membrane law's energy follows from its
/// element. Collision operators know no unit but those of the lattice: all of theirs are numbers, the force a momentum
/// per step in units of the reference density.
units::Dimension dimension_of(const Manifest& manifest, const std::string& name);
std::string unit_of(const Manifest& manifest, const std::string& name);

}  // namespace rouleau::plugin
