#include "velocity_reader.hpp"

#include "frames.hpp"

namespace rouleau::files {

std::optional<VelocityField> last_velocity(const std::filesystem::path& frames) {
  const Hdf5File file = open_frames(frames);
  auto frame = static_cast<std::size_t>(file.members("/frames"));
  while (frame > 0 && !file.has(frame_path(frame - 1) + "/fields/velocity")) --frame;
  if (frame == 0) return std::nullopt;
  const std::string group = frame_path(frame - 1), dataset = group + "/fields/velocity";
  const auto shape = file.shape(dataset);
  VelocityField field{file.read_attribute(group, "time_s"),
                      static_cast<std::size_t>(file.read_attribute(group, "stage")),
                      shape.at(1),
                      shape.at(0),
                      {},
                      {},
                      {}};
  // Nodes of the lattice lie half a spacing from the walls; those of a region or a stride where the file says.
  const bool part = file.has_attribute("/", "fields_first_m");
  const double height = file.read_attribute("/", "size_m", 1);
  const double spacing =
      part ? file.read_attribute("/", "fields_spacing_m", 1) : height / static_cast<double>(field.ny);
  const double first = part ? file.read_attribute("/", "fields_first_m", 1) : spacing / 2;
  for (std::size_t j = 0; j < field.ny; ++j) field.y.push_back(first + static_cast<double>(j) * spacing);
  const std::vector<double> vectors = file.read(dataset);
  for (std::size_t i = 0; i + 2 < vectors.size(); i += 3) {
    field.velocity_x.push_back(vectors[i]);
    field.velocity_y.push_back(vectors[i + 1]);
  }
  return field;
}

}  // namespace rouleau::files
