/* The interface as C11 sees it: the layout, and that the header needs nothing but itself. */
#include "layout.h"

#include <string.h>

int check_layout_in_c(void);

/* The symbol and the function type are part of the interface, too. */
int check_layout_in_c(void) {
  const rouleau_open_function open = NULL;
  return open == NULL && strcmp(ROULEAU_OPEN_SYMBOL, "rouleau_open_v1") == 0 ? 0 : 1;
}
