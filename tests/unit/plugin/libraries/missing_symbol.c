/* Exports what a plugin does, but needs a function that nobody has: only the loader can tell. */
#include <rouleau/plugin.h>

extern const rouleau_plugin* function_that_nobody_has(void);

const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) {
  (void)host_minor;
  return function_that_nobody_has();
}
