#include "source.hpp"

#define rouleau_open_v1 open_trt
#include "collision/trt/trt.cpp"

rouleau::test::OperatorSource rouleau::test::trt() { return {"trt", open_trt, with_loops<Trt>, {{"magic", 0.1875}}}; }
