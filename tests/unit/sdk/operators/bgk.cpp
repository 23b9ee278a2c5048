#include "source.hpp"

#define rouleau_open_v1 open_bgk
#include "collision/bgk/bgk.cpp"

rouleau::test::OperatorSource rouleau::test::bgk() { return {"bgk", open_bgk, with_loops<Bgk>, {}}; }
