#include "result_directory.hpp"

#include "base/error.hpp"
#include "json/number_or_null.hpp"
#include "run/provenance.hpp"
#include "run/summary.hpp"

namespace rouleau::trial {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A directory of the command holds its file, or its points, before anything else.
void require_own(const fs::path& directory, const ResultKind& kind) {
  if (!fs::exists(directory)) return;
  if (!fs::is_directory(directory))
    throw Error(ExitCode::bad_input, directory.string() + " is no directory; choose another with --out");
  if (fs::is_empty(directory) || fs::exists(directory / kind.file) || fs::exists(directory / "points")) return;
  throw Error(ExitCode::bad_input, directory.string() + " holds files that no " + kind.command +
                                       " wrote; choose another directory with --out");
}

}  // namespace

void take_result_directory(const fs::path& directory, const ResultKind& kind, std::optional<FileLock>& lock) {
  require_own(directory, kind);
  fs::create_directories(directory / "points");
  lock.emplace(directory);
  if (!lock->take())
    throw Error(ExitCode::bad_input, std::string("another ") + kind.program + " is writing into " + directory.string() +
                                         "; wait for it, or choose another directory with --out");
}

Json machine_json() {
  const run::Machine machine = run::this_machine();
  return {{"cpu", machine.processor},
          {"cores", machine.processors},
          {"memory_bytes", machine.memory_bytes},
          {"system", machine.system},
          {"compiler", machine.compiler}};
}

Json axes_json(const std::vector<Axis>& axes) {
  Json all = Json::array();
  for (const Axis& axis : axes) {
    Json labels = Json::array(), positions = Json::array();
    for (const Setting& setting : axis.settings) {
      labels.push_back(setting.label);
      positions.push_back(json::number_or_null(setting.position));
    }
    all.push_back({{"name", axis.name}, {"labels", labels}, {"positions", positions}});
  }
  return all;
}

}  // namespace rouleau::trial
