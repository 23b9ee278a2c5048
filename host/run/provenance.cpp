#include "provenance.hpp"

#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>
#include <chrono>
#include <ctime>
#include <fstream>
#include <rouleau/dispatch.hpp>
#include <thread>

#include "base/input_file.hpp"
#include "files/run_directory.hpp"
#include "json/document.hpp"
#include "plugin/library.hpp"

namespace rouleau::run {

Machine this_machine() {
  std::string model = "unknown processor";
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) == 0) {
      model = line.substr(line.find(':') + 2);
      break;
    }
  }
  utsname system{};
  uname(&system);
#ifdef __clang__
  const std::string compiler = "clang " __clang_version__;
#else
  const std::string compiler = "g++ " __VERSION__;
#endif
  return {model, std::thread::hardware_concurrency(), sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGE_SIZE),
          std::string(system.sysname) + " " + system.release + " " + system.machine, compiler};
}

std::string machine_description() {
  const Machine machine = this_machine();
  return machine.processor + ", " + std::to_string(machine.processors) + " processors, " + machine.system;
}

std::string present_time() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

long peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024L;
}

Summary describe(const plan::Plan& plan, const plan::PlanReport& report, int threads) {
  const scene::Scene& scene = *plan.scene;
  Summary s;
  s.title = scene.title;
  s.scene_file = scene.document->file();
  s.scene_sha256 = sha256_of(files::scene_text(*scene.document));
  s.git = program_version();
  s.machine = machine_description();
  s.started = present_time();
  s.threads = threads;
  for (const scene::StageSetting& stage : plan.stages) s.steps_at_most += stage.max_steps;
  s.dimensions = scene.domain.dimension();
  s.precision = scene.numerics.precision == scene::Precision::f64 ? "f64" : "f32";
  s.instruction_set = name_of(instruction_set());
  for (const plan::PlannedModel* model : plan.active_models()) {
    const plugin::Manifest& m = *model->manifest;
    s.plugins.push_back({m.id, m.version, plugin::to_string(m.kind), m.library.string(), plugin::library_sha256(m)});
  }
  s.lock = plan.lock;
  s.numerics_choice = plan.numerics_choice;
  s.plan = report;
  return s;
}

std::string program_version() { return ROULEAU_VERSION; }

}  // namespace rouleau::run
