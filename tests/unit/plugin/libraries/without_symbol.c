/* A shared library that is no plugin. */
__attribute__((visibility("default"))) int rouleau_open_v0(void);
int rouleau_open_v0(void) { return 0; }
