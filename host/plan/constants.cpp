#include "constants.hpp"

#include <stdexcept>

namespace rouleau::plan {

namespace {

constexpr std::array<KernelFacts, 5> kernels{{
    {core::KernelKind::peskin4, "peskin4", 0, 1, 1, least_semi_implicit_tau, ""},
    {core::KernelKind::cosine4, "cosine4", 0.0211, 1, 1, least_semi_implicit_tau,
     "its first moment reaches 0.021 spacings: with bending and segments shorter than a spacing it puts a false torque "
     "into the fluid (11 degrees off at strain 1 for a biconcave cell of half a spacing per segment); take peskin4"},
    {core::KernelKind::roma3, "roma3", 0, 0.095, 0.057, nowhere,
     "it lets ten times less stiffness pass than peskin4 before nodes zigzag, which the semi-implicit step does not "
     "change, and leaks twice the area"},
    {core::KernelKind::linear2, "linear2", 0, 0.013, 0.0066, nowhere,
     "it lets seventy times less stiffness pass than peskin4, and cells leak silently beyond that limit; it is here "
     "for comparison"},
    {core::KernelKind::sharp6, "sharp6", 0, 0.36, 0.22, 0.9, ""},
}};

}  // namespace

const KernelFacts& kernel_named(const std::string& name) {
  for (const KernelFacts& facts : kernels)
    if (facts.name == name) return facts;
  throw std::logic_error("no kernel is called " + name);
}

}  // namespace rouleau::plan
