#include "kernel.hpp"

#include "core/fluid/field.hpp"

namespace rouleau::core {

int stencil_above(KernelKind kernel) {
  return with_kernel(kernel, []<class Kernel>(Kernel) {
    constexpr int above = Kernel::first + Kernel::points - 1;
    static_assert(above == 1 - Kernel::first && above <= Field<double, 2>::halo);
    return above;
  });
}

KernelResponse kernel_response(KernelKind kernel) {
  return with_kernel(kernel, []<class Kernel>(Kernel) { return Kernel::response; });
}

}  // namespace rouleau::core
