#include "report_outlines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <string_view>

namespace rouleau::report {

namespace {

using Json = nlohmann::json;

/// What places within a domain of this size are multiples of, m.
double quantum_of(const std::vector<double>& size) {
  const double squares = std::inner_product(size.begin(), size.end(), size.begin(), 0.0);
  return std::max(1e-9, std::sqrt(squares) / std::numeric_limits<std::int16_t>::max());
}

/// Adds a number as a little-endian int32.
void append_number(std::vector<unsigned char>& bytes, int number) {
  for (int shift = 0; shift < 32; shift += 8)
    bytes.push_back(static_cast<unsigned char>(static_cast<std::uint32_t>(number) >> shift & 0xff));
}

constexpr std::size_t most_surface_points = 200000;  ///< of all outputs: about 1.6 MB of page

/// One output's outlines, or surfaces, as the page holds them.
void add_nodes(Json& result, const observe::OutlineSnapshot& s, std::size_t stride, double quantum) {
  std::vector<const std::vector<double>*> along{&s.x, &s.y};
  if (!s.triangles.empty()) along.push_back(&s.z);
  Json origins = Json::array();
  std::vector<unsigned char> bytes;
  for (std::size_t cell = 0; cell + 1 < s.first.size(); ++cell) {
    const auto begin = static_cast<std::size_t>(s.first[cell]), end = static_cast<std::size_t>(s.first[cell + 1]);
    std::vector<double> origin;
    for (const std::vector<double>* const v : along) {
      // The middle of the bounding box keeps every node within half its extent.
      const auto [low, high] =
          std::minmax_element(v->begin() + static_cast<long>(begin), v->begin() + static_cast<long>(end));
      const double middle = std::round((*low + *high) / 2 / quantum) * quantum;
      origin.push_back(std::isfinite(middle) ? middle : 0);
      origins.push_back(std::round(origin.back() * micro * 1000) / 1000);
    }
    for (std::size_t i = begin; i < end; i += stride)
      for (std::size_t k = 0; k < along.size(); ++k) append_place(bytes, (*along[k])[i] - origin[k], quantum);
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
      for (const auto& corners : triangles)
        for (const int node : corners) append_number(bytes, node);
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

/// Tensions of one node in `stride` of every cell as signed bytes in base64: 127 stands for `scale`.
std::string tension_bytes(const observe::OutlineSnapshot& outlines, std::size_t stride, double scale) {
  std::vector<unsigned char> bytes;
  for (std::size_t cell = 0; cell + 1 < outlines.first.size(); ++cell)
    for (auto i = std::size_t(outlines.first[cell]); i < std::size_t(outlines.first[cell + 1]); i += stride) {
      const double share = scale > 0 && std::isfinite(outlines.tension[i]) ? outlines.tension[i] / scale : 0;
      bytes.push_back(static_cast<unsigned char>(std::lround(127 * std::clamp(share, -1.0, 1.0))));
    }
  return base64(bytes);
}

/// What all but one tension in a hundred stay below in magnitude, N/m: the ends of cells would hide the rest.
double tension_scale(const files::FrameReader& reader, const std::vector<std::size_t>& selection) {
  constexpr std::size_t beyond = 100;
  std::vector<double> sizes;
  for (std::size_t k = 0; k < selection.size(); k += std::max<std::size_t>(1, selection.size() / 20))
    for (const double tension : reader.outlines(static_cast<int>(selection[k])).tension)
      if (std::isfinite(tension)) sizes.push_back(std::abs(tension));
  if (sizes.empty()) return 0;
  const auto rank = sizes.begin() + static_cast<long>(sizes.size() - 1 - sizes.size() / beyond);
  std::nth_element(sizes.begin(), rank, sizes.end());
  return *rank;
}

/// Which cells the outputs of a page have, and how many nodes of each.
class CellLayout {
 public:
  /// Those of the next output, one node in `stride`. False where a cell has another number of nodes than before.
  bool add(const observe::OutlineSnapshot& outlines, std::size_t stride = 1) {
    for (std::size_t k = 0; k < outlines.cell.size(); ++k) {
      const std::size_t nodes =
          (static_cast<std::size_t>(outlines.first[k + 1] - outlines.first[k]) + stride - 1) / stride;
      if (nodes_.try_emplace(outlines.cell[k], nodes).first->second != nodes) return false;
    }
    there_.push_back(outlines.cell);
    return true;
  }
  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  /// cells, first and there, as outline_data has them.
  void put_into(Json& result) const {
    Json &cells = result["cells"] = Json::array(), first = Json::array({0}), there = Json::array();
    std::map<int, std::size_t> place;
    for (const auto& [cell, nodes] : nodes_) {
      place[cell] = cells.size();
      cells.push_back(cell);
      first.push_back(first.back().get<std::size_t>() + nodes);
    }
    for (const std::vector<int>& numbers : there_) {
      Json places;  // null
      if (numbers.size() < nodes_.size()) {
        places = Json::array();
        for (const int cell : numbers) places.push_back(place.at(cell));
      }
      there.push_back(std::move(places));
    }
    result["first"] = std::move(first);
    result["there"] = std::move(there);
  }

 private:
  std::map<int, std::size_t> nodes_;     ///< of each cell
  std::vector<std::vector<int>> there_;  ///< cells of each output
};

}  // namespace

void append_place(std::vector<unsigned char>& bytes, double metres, double quantum) {
  const double limit = std::numeric_limits<std::int16_t>::max();
  if (!std::isfinite(metres)) metres = 0;  // the last output of a diverged run
  const auto value = static_cast<std::int16_t>(std::lround(std::clamp(metres / quantum, -limit, limit)));
  const auto bits = static_cast<std::uint16_t>(value);
  bytes.push_back(static_cast<unsigned char>(bits & 0xff));
  bytes.push_back(static_cast<unsigned char>(bits >> 8));
}

Json outline_data(const files::FrameReader& reader, const std::vector<std::size_t>& selection, std::size_t stride) {
  Json result{{"origin_um", Json::array()}, {"nodes", Json::array()}};
  const double quantum = quantum_of(reader.size());
  result["quantum_um"] = quantum * micro;
  const double scale = tension_scale(reader, selection);
  result["tension"] = {{"scale_N_per_m", scale}, {"values", Json::array()}};
  CellLayout layout;
  for (const std::size_t output : selection) {
    const auto outlines = reader.outlines(static_cast<int>(output));
    if (!outlines.triangles.empty() || !layout.add(outlines, stride)) return nullptr;
    add_nodes(result, outlines, stride, quantum);
    result["tension"]["values"].push_back(tension_bytes(outlines, stride, scale));
  }
  layout.put_into(result);
  return layout.empty() ? Json(nullptr) : result;
}

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
  const double scale = tension_scale(reader, selection);
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
    add_nodes(result, surfaces, 1, quantum);
    result["tension"]["values"].push_back(tension_bytes(surfaces, 1, scale));
  }
  layout.put_into(result);
  meshes.put_into(result);
  return result;
}

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return i + k < bytes.size() ? unsigned{bytes[i + k]} : 0u; };
    const unsigned triple = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (unsigned k = 0; k < 4; ++k) text += i + k <= bytes.size() ? letters[triple >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

nlohmann::json wall_data(const files::FrameReader& reader) {
  const files::WallBorder walls = reader.walls();
  if (walls.empty()) return nullptr;
  nlohmann::json data{{"corners_um", nlohmann::json::array()},
                      {"first", walls.first},
                      {"segments", walls.segments},
                      {"surface", nullptr}};
  for (const auto& corner : walls.corners)
    for (const double metres : corner) data["corners_um"].push_back(std::round(metres * micro * 1000) / 1000);
  if (walls.triangles.empty()) return data;
  const double quantum = quantum_of(reader.size());
  std::vector<unsigned char> points, triangles;
  for (const auto& point : walls.points)
    for (const double metres : point) append_place(points, metres, quantum);
  for (const auto& corners : walls.triangles)
    for (const int corner : corners) append_number(triangles, corner);
  data["surface"] = {{"quantum_um", quantum * micro}, {"points", base64(points)}, {"triangles", base64(triangles)}};
  return data;
}

}  // namespace rouleau::report
