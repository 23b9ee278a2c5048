#include "report_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

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

/// The triangles of each cell's type, and which type a cell has.
class Meshes {
 public:
  void add(const observe::OutlineSnapshot& s) {
    auto triangle = s.triangles.begin();
    for (std::size_t k = 0; k < s.cell.size(); ++k) {
      std::vector<std::array<int, 3>> own;
      for (; triangle != s.triangles.end() && (*triangle)[0] < s.first[k + 1]; ++triangle) {
        own.push_back(*triangle);
        for (int& corner : own.back()) corner = std::clamp(corner, s.first[k], s.first[k + 1] - 1) - s.first[k];
      }
      if (!of_cell_.contains(s.cell[k])) of_cell_[s.cell[k]] = number_.try_emplace(own, number_.size()).first->second;
    }
  }
  void put_into(Json& result) const {
    std::vector<std::string> meshes(number_.size());
    for (const auto& [triangles, number] : number_) {
      std::vector<unsigned char> bytes;
      for (const auto& corners : triangles) {
        for (const int node : corners) append_number(bytes, node);
      }
      meshes[number] = base64(bytes);
    }
    result["meshes"] = meshes;
    Json& mesh = result["mesh"] = Json::array();
    for (const auto& [cell, number] : of_cell_) mesh.push_back(number);
  }

 private:
  std::map<std::vector<std::array<int, 3>>, std::size_t> number_;
  std::map<int, std::size_t> of_cell_;
};

}  // namespace

Json surface_data(const files::FrameReader& reader, const std::vector<std::size_t>& selection) {
  std::size_t nodes = 0, fullest = 0;
  for (const std::size_t output : selection) {
    const std::size_t here = reader.nodes(static_cast<int>(output));
    if (here > nodes) nodes = here, fullest = output;
  }
  if (nodes == 0 || reader.outlines(static_cast<int>(fullest)).triangles.empty()) return nullptr;
  const double quantum = quantum_of(reader.size());
  Json result{{"quantum_um", quantum * micro},
              {"outputs", Json::array()},
              {"origin_um", Json::array()},
              {"nodes", Json::array()}};
  const double scale = tension_scale([&](int output) { return reader.outlines(output); }, selection);
  result["tension"] = {{"scale_N_per_m", scale}, {"values", Json::array()}};
  const std::size_t kept =
      std::clamp<std::size_t>(most_surface_points / nodes, 2, std::max<std::size_t>(2, selection.size()));
  CellLayout layout;
  Meshes meshes;
  std::size_t last = selection.size();  // none yet
  for (std::size_t k = 0; k < kept; ++k) {
    const std::size_t place = k * (selection.size() - 1) / (kept - 1);
    if (place == last) continue;
    last = place;
    const observe::OutlineSnapshot surfaces = reader.outlines(static_cast<int>(selection[place]));
    if (!layout.add(surfaces)) return nullptr;
    meshes.add(surfaces);
    result["outputs"].push_back(place);
    add_surfaces(result, surfaces, quantum);
    result["tension"]["values"].push_back(tension_bytes(surfaces, 1, scale));
  }
  layout.put_into(result);
  meshes.put_into(result);
  return result;
}

}  // namespace rouleau::report
