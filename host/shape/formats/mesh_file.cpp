#include "mesh_file.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>
#include <stdexcept>
#include <tuple>

#include "base/input_file.hpp"
#include "mesh_words.hpp"

namespace rouleau::shape {

namespace {

using Read = core::TriangleSurface (*)(Words&);

bool is_off(std::string_view word) {
  for (const std::string_view optional : {"ST", "C", "N", "4", "n"})
    if (word.starts_with(optional)) word.remove_prefix(optional.size());
  return word == "OFF";
}

bool is_whole_binary_stl(std::string_view text) {
  if (text.size() < 84) return false;
  std::uint32_t faces = 0;
  std::memcpy(&faces, text.data() + 80, sizeof faces);
  return text.size() == 84 + std::size_t{50} * faces;
}

/// By what the file begins with; its name's end decides where that may be anything.
Read format_of(const std::string& text, const std::filesystem::path& file) {
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return read_ply;
  if (is_whole_binary_stl(text)) return read_stl_binary;
  if (text.find('\0') != std::string::npos) return read_stl_binary;
  Words words(text.substr(0, std::size_t{1} << 16U), file.string());
  std::string first(words.next()), lower = first;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  if (is_off(first)) return read_off;
  if (lower == "solid") return read_stl_text;
  static const std::set<std::string> of_obj = {"v", "vt", "vn", "vp", "f", "o", "g", "s", "l", "mtllib", "usemtl"};
  const std::string ending = file.extension().string();
  if (of_obj.contains(first) || ending == ".obj" || ending == ".OBJ") return read_obj;
  words.refuse("is no OBJ, OFF, PLY or STL file: it begins with " + in_quotes(first.substr(0, 40)));
}

/// What keeps it from being a closed surface; nothing if it is one.
std::string fault_of(const core::TriangleSurface& surface) {
  std::set<std::array<int, 3>> known;
  for (std::array<int, 3> triangle : surface.triangles) {
    std::sort(triangle.begin(), triangle.end());
    if (known.insert(triangle).second) continue;
    const auto [a, b, c] = triangle;
    return "two triangles have the nodes " + std::to_string(a) + ", " + std::to_string(b) + " and " +
           std::to_string(c) + ": a face is there twice; leave one of them out";
  }
  try {
    static_cast<void>(core::rest_surface(surface));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

}  // namespace

core::TriangleSurface read_triangles(const std::filesystem::path& file) {
  std::string text = read_input(file, largest_input);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  const bool old_ends = text.find('\n') == std::string::npos && text.find('\0') == std::string::npos;  // of lines
  if (old_ends) std::replace(text.begin(), text.end(), '\r', '\n');
  const Read read = format_of(text, file);
  Words words(std::move(text), file.string());
  core::TriangleSurface surface = read(words);
  const auto refuse = [&](const std::string& problem) {
    throw Error(Cause::bad_input, rouleau::Place{file.string()}, problem, {write_anew});
  };
  const int nodes = static_cast<int>(surface.nodes.size());
  for (int i = 0; i < nodes; ++i)
    if (!surface.nodes[i].allFinite())
      refuse("node " + std::to_string(i) + " has a coordinate that is no finite number");
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    for (const int node : surface.triangles[i]) {
      if (node < 0 || node >= nodes)
        refuse("triangle " + std::to_string(i) + " has the node " + std::to_string(node) + ", and there are " +
               std::to_string(nodes));
    }
  }
  if (read == read_stl_text || read == read_stl_binary) weld(surface, 0);
  return surface;
}

double weld_reach(const core::TriangleSurface& surface) {
  Eigen::AlignedBox3d box;
  for (const core::Vec<3>& node : surface.nodes) box.extend(node);
  return surface.nodes.empty() ? 0 : weld_distance * box.sizes().maxCoeff();
}

core::TriangleSurface read_mesh(const std::filesystem::path& file) {
  core::TriangleSurface surface = read_triangles(file);
  const auto refuse = [&](const std::string& problem) {
    throw Error(Cause::bad_input, rouleau::Place{file.string()}, problem);
  };
  std::string fault = fault_of(surface);
  if (fault.empty()) return surface;
  try {
    const double distance = weld_reach(surface);
    const int joined = weld(surface, distance);
    if (joined == 0) refuse(fault);
    fault = fault_of(surface);
    if (fault.empty()) return surface;
    fault += "\n" + std::to_string(joined) + " of its nodes lie within " + number(distance) +
             " of another one, 1e-5 of its size, and were taken as the same; numbers are counted without them";
  } catch (const std::invalid_argument& error) {
    fault = error.what();
  }
  refuse(fault);
  return surface;
}

int weld(core::TriangleSurface& surface, double distance) {
  const int count = static_cast<int>(surface.nodes.size());
  const auto is_known = [&](int node) { return node >= 0 && node < count; };
  if (!std::all_of(surface.triangles.begin(), surface.triangles.end(),
                   [&](const auto& t) { return std::all_of(t.begin(), t.end(), is_known); }))
    return 0;
  std::vector<int> order(count), first(count);
  std::iota(order.begin(), order.end(), 0);
  std::iota(first.begin(), first.end(), 0);
  const auto first_of = [&](int node) {
    while (first[node] != node) node = first[node] = first[first[node]];
    return node;
  };
  // Along a direction in which few nodes of any usual mesh are level.
  const core::Vec<3> direction = core::Vec<3>(0.4812, 0.6021, 0.6371).normalized();
  std::vector<std::array<double, 4>> key;
  for (const core::Vec<3>& at : surface.nodes) key.push_back({direction.dot(at), at.x(), at.y(), at.z()});
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::tie(key[a], a) < std::tie(key[b], b); });
  std::vector<int> different;  // one of each place, the first
  for (const int node : order)
    if (!different.empty() && surface.nodes[different.back()] == surface.nodes[node])
      first[node] = different.back();
    else
      different.push_back(node);
  long compared = 0;
  for (std::size_t a = 0; a < different.size() && distance > 0; ++a) {
    const core::Vec<3>& from = surface.nodes[different[a]];
    for (std::size_t b = a + 1; b < different.size(); ++b) {
      const core::Vec<3> way = surface.nodes[different[b]] - from;
      if (direction.dot(way) > distance) break;
      if (++compared > 1000L * count) throw std::invalid_argument("too many of its nodes lie at nearly the same place");
      if (!(way.norm() <= distance)) continue;
      const auto [lower, higher] = std::minmax({first_of(different[a]), first_of(different[b])});
      first[higher] = lower;
    }
  }
  std::vector<core::Vec<3>> nodes;
  std::vector<int> renamed(count);
  for (int i = 0; i < count; ++i) {
    const int kept = first_of(i);
    renamed[i] = kept == i ? static_cast<int>(nodes.size()) : renamed[kept];
    if (kept == i) nodes.push_back(surface.nodes[i]);
  }
  for (auto& triangle : surface.triangles)
    for (int& node : triangle) node = renamed[node];
  std::erase_if(surface.triangles, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  surface.nodes = std::move(nodes);
  return count - static_cast<int>(surface.nodes.size());
}

}  // namespace rouleau::shape
