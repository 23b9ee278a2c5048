// rouleau-bench: measures speed side by side in one run, and checks what it measures.
#include <boost/program_options.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <rouleau/dispatch.hpp>
#include <string>
#include <thread>

#include "block_bench.hpp"
#include "fluid_bench.hpp"
#include "network_bench.hpp"
#include "rank_bench.hpp"
#include "scene_bench.hpp"
#include "space_bench.hpp"

namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

const char* instruction_set() {
  switch (rouleau::instruction_set()) {
    case rouleau::InstructionSet::avx512:
      return "AVX-512";
    case rouleau::InstructionSet::avx2:
      return "AVX2";
    default:
      return "baseline";
  }
}

}  // namespace

int main(int argc, char** argv) {
  namespace options = boost::program_options;
  bool check = false, whole = false, f32 = false, force = false;
  std::string only, kernel, scene;
  double seconds = 1;
  long steps = 0;
  int nx = 256, ny = 128, cube = 0, ranks = 0, rank = 0;
  options::options_description description("options");
  auto add = description.add_options();
  add("check", options::bool_switch(&check), "no timing: check every kernel against an exact solution");
  add("only", options::value(&only)->value_name("TABLE"),
      "fluid, space (three dimensions; of fluid, too), scene, cells or nodes (membrane nodes in three dimensions); all "
      "without. Or network: messages between ranks, under mpirun");
  add("whole", options::bool_switch(&whole), "run the four-cell scene to its end (four times 10 s)");
  add("seconds", options::value(&seconds)->default_value(1)->value_name("S"),
      "time for each fluid kernel, each line of network, and about each round of --ranks");
  add("kernel", options::value(&kernel)->value_name("NAME"), "run one fluid kernel (plugin, plain, move) for counting");
  add("steps", options::value(&steps)->default_value(0)->value_name("N"), "with --kernel: its steps");
  add("nx", options::value(&nx)->default_value(256), "with --kernel: nodes along x, a multiple of 16");
  add("ny", options::value(&ny)->default_value(128), "with --kernel: nodes along y");
  add("cube", options::value(&cube)->value_name("N"),
      "with --kernel plugin or plain: three dimensions, N^3 nodes, N a multiple of 16");
  add("f32", options::bool_switch(&f32), "with --kernel: single precision");
  add("force", options::bool_switch(&force), "with --kernel: every node has a force and writes its velocity");
  add("ranks", options::value(&ranks)->value_name("N"),
      "one rank of N: what a step of its fluid costs, its neighbours replaced by itself, and a whole step with its "
      "cells");
  add("rank", options::value(&rank)->value_name("K"), "with --ranks: which, 0 to N - 1");
  add("scene",
      options::value(&scene)->value_name("FILE")->default_value(ROULEAU_SCENES "/four-cells-shear.json", "four cells"),
      "with --ranks: the scene");
  add("help", "this text");
  try {
    options::variables_map values;
    options::store(options::parse_command_line(argc, argv, description), values);
    options::notify(values);
    if (values.count("help") != 0) {
      std::cout << "Measures the speed of Rouleau; docs/performance.md has a table. Let the machine do nothing else.\n"
                << description;
      return 0;
    }
    if (!kernel.empty() && cube != 0) {
      rouleau::bench::run_space_kernel(kernel, f32, force, cube, steps);
      return 0;
    }
    if (!kernel.empty()) {
      rouleau::bench::run_kernel(kernel.c_str(), f32, force, nx, ny, steps);
      return 0;
    }
    if (only == "network") {
      rouleau::bench::network_table(seconds);
      return 0;
    }
    std::printf("%s, %u processors, %s\n%s, %s\n", processor().c_str(), std::thread::hardware_concurrency(),
                instruction_set(), ROULEAU_COMPILER, ROULEAU_FLAGS);
    std::printf("\nChecks\n");
    rouleau::bench::check_fluid();
    rouleau::bench::check_space();
    rouleau::bench::check_block();
    rouleau::bench::check_rank();
    if (check) return 0;
    if (ranks != 0) {
      rouleau::bench::block_table(scene, ranks, rank, seconds);
      return 0;
    }
    if (only.empty() || only == "fluid") rouleau::bench::fluid_table(seconds);
    if (only.empty() || only == "fluid" || only == "space") rouleau::bench::space_table(seconds);
    if (only.empty() || only == "scene") rouleau::bench::scene_table(whole);
    if (only.empty() || only == "cells") rouleau::bench::cells_table();
    if (only.empty() || only == "nodes") rouleau::bench::nodes_table();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "rouleau-bench: " << error.what() << "\n";
    return 1;
  }
}
