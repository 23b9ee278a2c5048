#include "mesh_file.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"

namespace rouleau::shape {

namespace {

/// A file's text, read word by word.
class Words {
 public:
  Words(std::string text, std::string name) : text_(std::move(text)), name_(std::move(name)) {}

  [[noreturn]] void refuse(const std::string& problem) const {
    throw Error(Cause::bad_input, {name_, {}, line_, 0}, problem);
  }
  [[nodiscard]] std::size_t size() const { return text_.size(); }
  [[nodiscard]] bool at_end() const { return at_ == text_.size(); }
  /// The next word; empty at the end. `#` begins a comment.
  std::string_view next() {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return std::string_view(text_).substr(begin, at_ - begin);
  }
  /// The words that are left of this line.
  std::vector<std::string_view> rest() {
    std::vector<std::string_view> words;
    for (;;) {
      while (at_ < text_.size() && text_[at_] != '\n' && is_blank(text_[at_])) ++at_;
      if (at_ == text_.size() || text_[at_] == '\n' || text_[at_] == '#') return words;
      words.push_back(next());
    }
  }
  template <class T>
  T number(const char* what) {
    const std::string_view word = next();
    if (word.empty()) refuse(std::string("ends where ") + what + " is expected");
    return number<T>(word, what);
  }
  template <class T>
  T number(std::string_view word, const char* what) const {
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      refuse(in_quotes(std::string(word)) + " stands where " + what + " is expected");
    }
    return value;
  }
  /// A number of things that the rest of the file has room for.
  std::size_t count(const char* what) {
    const auto value = number<std::size_t>(what);
    if (value > size())
      refuse(std::string(what) + " is " + std::to_string(value) + ", more than the file has room for");
    return value;
  }
  std::string_view rest_of_line() {
    const std::size_t begin = at_, end = std::min(text_.find('\n', at_), text_.size());
    at_ = std::min(end + 1, text_.size());
    ++line_;
    return std::string_view(text_).substr(begin, end - begin);
  }
  /// Bytes from the present place on.
  std::string_view bytes(std::size_t wanted, const char* what) {
    if (text_.size() - at_ < wanted) refuse(std::string("ends within ") + what);
    at_ += wanted;
    return std::string_view(text_).substr(at_ - wanted, wanted);
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
  void skip_blanks() {
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '#') at_ = std::min(text_.find('\n', at_), text_.size());
      if (at_ < text_.size() && text_[at_] == '\n') ++line_;
      if (at_ == text_.size() || !is_blank(text_[at_])) return;
    }
  }
  std::string text_, name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

void add_face(TriangleSurface& surface, const std::vector<int>& corners, const Words& words) {
  if (corners.size() < 3) words.refuse("a face has " + std::to_string(corners.size()) + " corners");
  for (std::size_t k = 2; k < corners.size(); ++k)
    surface.triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

TriangleSurface read_off(Words& words) {
  TriangleSurface surface;
  words.next();  // OFF
  const std::size_t nodes = words.count("the number of nodes"), faces = words.count("the number of faces");
  words.count("the number of edges");
  for (std::size_t i = 0; i < nodes; ++i) {
    core::Vec<3>& node = surface.nodes.emplace_back();
    for (int k = 0; k < 3; ++k) node[k] = words.number<double>("a coordinate");
  }
  for (std::size_t f = 0; f < faces; ++f) {
    std::vector<int> corners(words.count("the number of a face's corners"));
    for (int& corner : corners) corner = words.number<int>("a node");
    add_face(surface, corners, words);
    words.rest_of_line();  // colours
  }
  return surface;
}

TriangleSurface read_obj(Words& words) {
  TriangleSurface surface;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "v") {
      core::Vec<3>& node = surface.nodes.emplace_back();
      for (int k = 0; k < 3; ++k) node[k] = words.number<double>("a coordinate");
    }
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

/// Nodes of corners that lie at the same place.
class Corners {
 public:
  int node(TriangleSurface& surface, const core::Vec<3>& place) {
    const auto [found, is_new] =
        known_.try_emplace({place.x(), place.y(), place.z()}, static_cast<int>(surface.nodes.size()));
    if (is_new) surface.nodes.push_back(place);
    return found->second;
  }

 private:
  std::map<std::array<double, 3>, int> known_;
};

TriangleSurface read_stl_text(Words& words) {
  TriangleSurface surface;
  Corners corners;
  words.rest_of_line();  // solid NAME
  std::vector<int> face;
  for (std::string_view word = words.next(); !word.empty() && word != "endsolid"; word = words.next()) {
    if (word == "vertex") {
      core::Vec<3> place;
      for (int k = 0; k < 3; ++k) place[k] = words.number<double>("a coordinate");
      if (!place.allFinite()) words.refuse("a coordinate is no finite number");
      face.push_back(corners.node(surface, place));
    } else if (word == "endloop") {
      add_face(surface, face, words);
      face.clear();
    }
  }
  return surface;
}

template <class T>
T little_endian(const char* bytes) {
  static_assert(std::endian::native == std::endian::little);
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

TriangleSurface read_stl_binary(Words& words) {
  TriangleSurface surface;
  Corners corners;
  words.bytes(80, "its header");
  const auto faces = little_endian<std::uint32_t>(words.bytes(4, "the number of faces").data());
  for (std::uint32_t f = 0; f < faces; ++f) {
    const char* record = words.bytes(50, "its faces").data();
    std::array<int, 3> triangle{};
    for (int k = 0; k < 3; ++k) {
      core::Vec<3> place;
      for (int c = 0; c < 3; ++c) place[c] = little_endian<float>(record + 12 + 12 * k + 4 * c);
      if (!place.allFinite()) words.refuse("face " + std::to_string(f) + " has a coordinate that is no finite number");
      triangle[k] = corners.node(surface, place);
    }
    surface.triangles.push_back(triangle);
  }
  return surface;
}

/// The header of a PLY file, as far as nodes and faces want it.
struct Ply {
  struct Property {
    std::string type, name, count_type;  ///< `count_type`: of a list
  };
  struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
  };
  bool binary = false;
  std::vector<Element> elements;
};

std::size_t size_of(std::string_view type) {
  static const std::map<std::string_view, std::size_t> sizes = {
      {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

double ply_number(std::string_view type, const char* bytes) {
  switch (size_of(type)) {
    case 1:
      return type == "char" || type == "int8" ? static_cast<signed char>(*bytes) : static_cast<unsigned char>(*bytes);
    case 2:
      return type == "short" || type == "int16" ? little_endian<std::int16_t>(bytes)
                                                : little_endian<std::uint16_t>(bytes);
    case 4:
      if (type == "float" || type == "float32") return little_endian<float>(bytes);
      return type == "int" || type == "int32" ? little_endian<std::int32_t>(bytes)
                                              : little_endian<std::uint32_t>(bytes);
    default:
      return little_endian<double>(bytes);
  }
}

Ply read_ply_header(Words& words) {
  Ply ply;
  for (;;) {
    std::istringstream line{std::string(words.rest_of_line())};
    std::string word;
    line >> word;
    if (word == "end_header") return ply;
    if (word == "format") {
      line >> word;
      if (word != "ascii" && word != "binary_little_endian")
        words.refuse("the format " + in_quotes(word) + " is not read; write PLY as ascii or binary_little_endian");
      ply.binary = word != "ascii";
    } else if (word == "element") {
      Ply::Element& element = ply.elements.emplace_back();
      line >> element.name >> element.count;
      if (!line || element.count > words.size()) words.refuse("an element without a number that fits the file");
    } else if (word == "property" && !ply.elements.empty()) {
      Ply::Property& property = ply.elements.back().properties.emplace_back();
      line >> property.type;
      if (property.type == "list") line >> property.count_type >> property.type;
      line >> property.name;
      const bool known =
          size_of(property.type) != 0 && (property.count_type.empty() || size_of(property.count_type) != 0);
      if (!line || !known) words.refuse("a property of an unknown type");
    } else if (words.at_end()) {
      words.refuse("ends within its header");
    }
  }
}

TriangleSurface read_ply(Words& words) {
  const Ply ply = read_ply_header(words);
  TriangleSurface surface;
  const auto number = [&](const std::string& type) {
    if (!ply.binary) return words.number<double>("a number");
    return ply_number(type, words.bytes(size_of(type), "its data").data());
  };
  for (const Ply::Element& element : ply.elements) {
    for (std::size_t i = 0; i < element.count; ++i) {
      core::Vec<3> place = core::Vec<3>::Constant(std::nan(""));
      std::vector<int> corners;
      for (const Ply::Property& property : element.properties) {
        if (property.count_type.empty()) {
          const double value = number(property.type);
          if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
            place[property.name[0] - 'x'] = value;
          continue;
        }
        const double count = number(property.count_type);
        if (!(count >= 0 && count <= 1000)) words.refuse("a list of " + rouleau::number(count) + " numbers");
        for (int k = 0; k < static_cast<int>(count); ++k) {
          const double value = number(property.type);
          if (!(std::abs(value) < 1e9)) words.refuse("a face has the node " + rouleau::number(value));
          corners.push_back(static_cast<int>(value));
        }
      }
      if (element.name == "vertex") surface.nodes.push_back(place);
      if (element.name == "face") add_face(surface, corners, words);
    }
  }
  return surface;
}

}  // namespace

TriangleSurface read_mesh(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  if (stream) content << stream.rdbuf();
  if (!stream || stream.bad()) throw Error(Cause::input_output, {file.string(), {}, 0, 0}, "cannot be read");
  const std::string text = content.str(), begin = text.substr(0, 200);
  Words words(text, file.string());
  TriangleSurface surface;
  if (file.extension() == ".obj" || file.extension() == ".OBJ") {
    surface = read_obj(words);
  } else if (begin.starts_with("OFF")) {
    surface = read_off(words);
  } else if (begin.starts_with("ply")) {
    surface = read_ply(words);
  } else if (begin.starts_with("solid") && begin.find("facet") != std::string::npos) {
    surface = read_stl_text(words);
  } else if (text.find('\0') != std::string::npos) {  // no text
    surface = read_stl_binary(words);
  } else {
    words.refuse("is no OFF, PLY or STL file, and its name does not end in .obj");
  }
  for (std::size_t i = 0; i < surface.nodes.size(); ++i) {
    if (!surface.nodes[i].allFinite())
      words.refuse("node " + std::to_string(i) + " has a coordinate that is no finite number");
  }
  try {
    static_cast<void>(rest_surface(surface));
  } catch (const std::invalid_argument& error) {
    words.refuse(error.what());
  }
  return surface;
}

}  // namespace rouleau::shape
