// OFF, OBJ and STL.
#include <algorithm>
#include <bit>
#include <cstring>

#include "mesh_words.hpp"

namespace rouleau::shape {

namespace {

bool is_keyword(std::string_view word, std::string_view keyword) {
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

core::Vec<3> read_place(Words& words) {
  core::Vec<3> place;
  for (int k = 0; k < 3; ++k) place[k] = words.number<double>("a coordinate");
  return place;
}

}  // namespace

void add_face(core::TriangleSurface& surface, const std::vector<int>& corners, const Words& words) {
  if (corners.size() < 3) words.refuse("a face has " + std::to_string(corners.size()) + " corners");
  for (std::size_t k = 2; k < corners.size(); ++k)
    surface.triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

core::TriangleSurface read_off(Words& words) {
  core::TriangleSurface surface;
  const std::string_view keyword = words.next();
  const bool more = keyword != "OFF";  // texture coordinates, colours, normals behind each place: ST, C, N
  if (keyword.find('4') != keyword.npos || keyword.find('n') != keyword.npos)
    words.refuse("in a file that begins with " + in_quotes(keyword) + " a place does not have three coordinates");
  const std::size_t nodes = words.count("the number of nodes"), faces = words.count("the number of faces");
  words.count("the number of edges");
  for (std::size_t i = 0; i < nodes; ++i) {
    surface.nodes.push_back(read_place(words));
    if (more) words.rest_of_line();
  }
  for (std::size_t f = 0; f < faces; ++f) {
    std::vector<int> corners(words.count("the number of a face's corners"));
    for (int& corner : corners) corner = words.number<int>("a node");
    add_face(surface, corners, words);
    words.rest_of_line();  // colours
  }
  return surface;
}

core::TriangleSurface read_obj(Words& words) {
  words.join_lines();
  core::TriangleSurface surface;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "v") surface.nodes.push_back(read_place(words));
    const std::vector<std::string_view> rest = words.rest();  // of other lines: names, normals, colours
    if (word != "f") continue;
    std::vector<int> corners;
    for (const std::string_view corner : rest) {
      // NODE, NODE/TEXTURE or NODE/TEXTURE/NORMAL. The first node is 1, the last one -1.
      const auto number = words.number<std::int64_t>(corner.substr(0, corner.find('/')), "a node");
      const auto count = static_cast<std::int64_t>(surface.nodes.size());
      if (number == 0 || std::abs(number) > count) {
        words.refuse("a face has the node " + std::to_string(number) + ", and there are " + std::to_string(count) +
                     " before it");
      }
      corners.push_back(static_cast<int>(number > 0 ? number - 1 : count + number));
    }
    add_face(surface, corners, words);
  }
  return surface;
}

core::TriangleSurface read_stl_text(Words& words) {
  core::TriangleSurface surface;
  std::vector<int> face;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (is_keyword(word, "solid") || is_keyword(word, "endsolid")) {
      words.rest_of_line();  // a name, of any words
    } else if (is_keyword(word, "vertex")) {
      face.push_back(static_cast<int>(surface.nodes.size()));
      surface.nodes.push_back(read_place(words));
    } else if (is_keyword(word, "endloop")) {
      add_face(surface, face, words);
      face.clear();
    }
  }
  return surface;
}

core::TriangleSurface read_stl_binary(Words& words) {
  static_assert(std::endian::native == std::endian::little);
  core::TriangleSurface surface;
  words.bytes(80, "the header of a binary STL");
  std::uint32_t faces = 0;
  std::memcpy(&faces, words.bytes(4, "the number of faces").data(), sizeof faces);
  for (std::uint32_t f = 0; f < faces; ++f) {
    std::array<float, 12> numbers{};
    std::memcpy(numbers.data(), words.bytes(50, "its faces, read as binary STL").data(), sizeof numbers);
    const int first = static_cast<int>(surface.nodes.size());
    for (int k = 3; k < 12; k += 3) surface.nodes.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

}  // namespace rouleau::shape
