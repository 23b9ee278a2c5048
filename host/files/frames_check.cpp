#include "frames_check.hpp"

#include <algorithm>
#include <cmath>

#include "frames.hpp"

namespace rouleau::files {

std::optional<std::string> find_no_number_in_frames(const std::filesystem::path& frames) {
  const hdf5::File file = open_frames(frames);
  for (const std::string& frame : file.names("/frames")) {
    for (const char* part : {"/membranes", "/fields"}) {
      const std::string group = "/frames/" + frame + part;
      if (!file.has(group)) continue;
      for (const std::string& name : file.names(group)) {
        const std::vector<double> values = file.read(group + '/' + name);
        if (std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); })) continue;
        return group + '/' + name + " of " + frames.filename().string() + " holds a value that is no number";
      }
    }
  }
  return std::nullopt;
}

}  // namespace rouleau::files
