#include "report_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "report_outlines.hpp"

namespace rouleau::report {

namespace {

using Json = nlohmann::json;

constexpr std::size_t most_surface_points = 200000;  ///< of all outputs: about 1.6 MB of page

/// One output's surfaces.
void add_surfaces(Json& result, const observe::OutlineSnapshot& s, double quantum) {
  const std::vector<double>* const along[] = {&s.x, &s.y, &s.z};
  Json origins = Json::array();
  std::vector<unsigned char> bytes;
  for (std::size_t cell = 0; cell + 1 < s.first.size(); ++cell) {
    const auto begin = static_cast<std::size_t>(s.first[cell]), end = static_cast<std::size_t>(s.first[cell + 1]);
    double origin[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] =
          std::minmax_element(along[k]->begin() + static_cast<long>(begin), along[k]->begin() + static_cast<long>(end));
      const double middle = std::round((*low + *high) / 2 / quantum) * quantum;
      origin[k] = std::isfinite(middle) ? middle : 0;
      origins.push_back(std::round(origin[k] * micro * 1000) / 1000);
    }
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < 3; ++k) append_place(bytes, (*along[k])[i] - origin[k], quantum);
    }
  }
  result["origin_um"].push_back(std::move(origins));
  result["nodes"].push_back(base64(bytes));
}

}  // namespace

Json surface_data(const files::FrameReader& reader, const std::vector<std::size_t>& selection) {
  if (selection.empty()) return nullptr;
  const observe::OutlineSnapshot begin = reader.surfaces(static_cast<int>(selection.front()));
  if (begin.triangles.empty()) return nullptr;
  const std::array<double, 3> size = reader.size_in_space();
  const double quantum = quantum_of(std::hypot(size[0], size[1], size[2]));
  std::vector<unsigned char> triangles;
  for (const auto& corners : begin.triangles) {
    for (const int node : corners) append_number(triangles, node);
  }
  Json result{{"size_um", {size[0] * micro, size[1] * micro, size[2] * micro}},
              {"periodic", {reader.periodic_x(), reader.periodic_y(), reader.periodic_z()}},
              {"quantum_um", quantum * micro},
              {"first", begin.first},
              {"triangles", base64(triangles)},
              {"outputs", Json::array()},
              {"origin_um", Json::array()},
              {"nodes", Json::array()}};
  const double scale = tension_scale([&](int output) { return reader.surfaces(output); }, selection);
  result["tension"] = {{"scale_N_per_m", scale}, {"values", Json::array()}};
  const std::size_t kept =
      std::clamp<std::size_t>(most_surface_points / begin.x.size(), 2, std::max<std::size_t>(2, selection.size()));
  std::size_t last = selection.size();  // none yet
  for (std::size_t k = 0; k < kept; ++k) {
    const std::size_t place = k * (selection.size() - 1) / (kept - 1);
    if (place == last) continue;
    last = place;
    const observe::OutlineSnapshot surfaces = reader.surfaces(static_cast<int>(selection[place]));
    if (surfaces.first != begin.first) return nullptr;
    result["outputs"].push_back(place);
    add_surfaces(result, surfaces, quantum);
    result["tension"]["values"].push_back(tension_bytes(surfaces, 1, scale));
  }
  return result;
}

}  // namespace rouleau::report
