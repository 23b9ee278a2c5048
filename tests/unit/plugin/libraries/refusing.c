/* Says that it cannot work with any host. */
#include <rouleau/plugin.h>

const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) {
  (void)host_minor;
  return NULL;
}
