#include "velocity_reader.hpp"

#include "field_nodes.hpp"
#include "frames.hpp"

namespace rouleau::files {

std::optional<VelocityField> last_velocity(const std::filesystem::path& frames) {
  const hdf5::File file = open_frames(frames);
  auto frame = static_cast<std::size_t>(file.members("/frames"));
  while (frame > 0 && !file.has(frame_path(frame - 1) + "/fields/velocity")) --frame;
  if (frame == 0) return std::nullopt;
  const std::string group = frame_path(frame - 1), dataset = group + "/fields/velocity";
  const FieldNodes nodes(file, dataset);
  VelocityField field{file.read_attribute(group, "time_s"),
                      static_cast<std::size_t>(file.read_attribute(group, "stage")),
                      nodes.nx,
                      {},
                      {},
                      nodes.all(file, dataset)};
  for (std::size_t j = 0; j < nodes.ny; ++j) field.y.push_back(nodes.first[1] + double(j) * nodes.spacing[1]);
  for (std::size_t k = 0; k < nodes.nz; ++k) field.z.push_back(nodes.first[2] + double(k) * nodes.spacing[2]);
  return field;
}

}  // namespace rouleau::files
