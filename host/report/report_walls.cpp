#include "report_walls.hpp"

#include <algorithm>
#include <cmath>

#include "report_outlines.hpp"

namespace rouleau::report {

nlohmann::json wall_data(const files::FrameReader& reader) {
  const files::WallBorder walls = reader.walls();
  if (walls.empty()) return nullptr;
  nlohmann::json data{{"corners_um", nlohmann::json::array()},
                      {"first", walls.first},
                      {"segments", walls.segments},
                      {"surface", nullptr}};
  for (const auto& corner : walls.corners) {
    for (const double metres : corner) data["corners_um"].push_back(std::round(metres * micro * 1000) / 1000);
  }
  if (walls.triangles.empty()) return data;
  const auto [x, y, z] = reader.size_in_space();
  const double quantum = quantum_of(std::hypot(x, y, z));
  std::vector<unsigned char> points, triangles;
  for (const auto& point : walls.points) {
    for (const double metres : point) append_place(points, metres, quantum);
  }
  for (const auto& corners : walls.triangles) {
    for (const int corner : corners) append_number(triangles, corner);
  }
  data["surface"] = {{"quantum_um", quantum * micro}, {"points", base64(points)}, {"triangles", base64(triangles)}};
  return data;
}

}  // namespace rouleau::report
