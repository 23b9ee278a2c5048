#include "velocity_reader.hpp"

#include "field_nodes.hpp"
#include "frames.hpp"

namespace rouleau::files {

std::optional<VelocityField> last_velocity(const std::filesystem::path& frames) {
  const Hdf5File file = open_frames(frames);
  auto frame = static_cast<std::size_t>(file.members("/frames"));
  while (frame > 0 && !file.has(frame_path(frame - 1) + "/fields/velocity")) --frame;
  if (frame == 0) return std::nullopt;
  const std::string group = frame_path(frame - 1), dataset = group + "/fields/velocity";
  const FieldNodes nodes(file, dataset);
  VelocityField field{file.read_attribute(group, "time_s"),
                      static_cast<std::size_t>(file.read_attribute(group, "stage")),
                      nodes.nx,
                      nodes.ny,
                      {},
                      {},
                      {}};
  for (std::size_t j = 0; j < nodes.ny; ++j)
    field.y.push_back(nodes.first[1] + static_cast<double>(j) * nodes.spacing[1]);
  const std::vector<double> vectors = nodes.section(file, dataset);
  for (std::size_t i = 0; i + 2 < vectors.size(); i += 3) {
    field.velocity_x.push_back(vectors[i]);
    field.velocity_y.push_back(vectors[i + 1]);
  }
  return field;
}

}  // namespace rouleau::files
