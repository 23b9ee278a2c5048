/* A plugin table smaller than that of interface 1.0. */
#include <rouleau/plugin.h>

static const rouleau_plugin plugin = {8, 0, NULL};

const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) {
  (void)host_minor;
  return &plugin;
}
