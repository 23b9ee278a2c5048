// The kernels a scene can choose, by name, and what each does badly.
#pragma once

#include <string>

#include "core/coupling/kernel_kind.hpp"

namespace rouleau::plan {

struct KernelFacts {
  core::KernelKind kind;
  const char* name;
  double first_moment;   ///< largest |sum w (x - X)|, spacings
  double stretch_limit;  ///< largest stretching stiffness with explicit coupling over that of peskin4
  double bending_limit;  ///< the same for bending stiffness
  const char* defect;    ///< what a user has to expect, for `plan`; empty: nothing
};

/// Facts of a kernel. The limits were measured with one cell at rest, 20 spacings a radius, tau 1.
const KernelFacts& kernel_facts(core::KernelKind kind);
/// The kernel of this name, which the schema has checked.
const KernelFacts& kernel_named(const std::string& name);

}  // namespace rouleau::plan
