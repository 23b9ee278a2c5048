// Outlines read back from a frames.h5: our reader, and HDF5 under it.
#include "files/frames.hpp"

#include <algorithm>

#include "target.hpp"

using namespace rouleau;

void fuzz_target(std::string_view bytes) {
  const fuzz::MemoryFile file(bytes);
  fuzz::may_refuse([&] {
    const files::FrameReader reader(file.path());
    static_cast<void>(reader.size());
    static_cast<void>(reader.periodic());
    const int frames = reader.frames();
    for (int frame = 0; frame < std::min(frames, 3); ++frame) {
      const auto outlines = reader.outlines(frame);
      for (const int first : outlines.first) {
        if (first < 0 || static_cast<std::size_t>(first) > outlines.x.size()) {
          fuzz::broken_promise("an outline beyond its points", std::to_string(first));
        }
      }
    }
  });
}

fuzz::Form fuzz_form() { return {}; }
