// PLY, in text and in both binary forms.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

#include "mesh_words.hpp"

namespace rouleau::shape {

namespace {

enum class Kind { signed_number, unsigned_number, real };
struct Type {
  std::size_t size;
  Kind kind;
};

const Type* type_of(const std::string& name) {
  using enum Kind;
  static const std::map<std::string, Type> types = {{"char", {1, signed_number}},
                                                    {"int8", {1, signed_number}},
                                                    {"uchar", {1, unsigned_number}},
                                                    {"uint8", {1, unsigned_number}},
                                                    {"short", {2, signed_number}},
                                                    {"int16", {2, signed_number}},
                                                    {"ushort", {2, unsigned_number}},
                                                    {"uint16", {2, unsigned_number}},
                                                    {"int", {4, signed_number}},
                                                    {"int32", {4, signed_number}},
                                                    {"uint", {4, unsigned_number}},
                                                    {"uint32", {4, unsigned_number}},
                                                    {"float", {4, real}},
                                                    {"float32", {4, real}},
                                                    {"double", {8, real}},
                                                    {"float64", {8, real}}};
  const auto found = types.find(name);
  return found == types.end() ? nullptr : &found->second;
}

struct Property {
  std::string name;
  const Type* type = nullptr;
  const Type* count = nullptr;  ///< of a list
};
struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};
enum class Form { text, little_endian, big_endian };

struct Header {
  Form form = Form::text;
  std::vector<Element> elements;
};

Header read_header(Words& words) {
  Header header;
  for (;;) {
    std::istringstream line{std::string(words.rest_of_line())};
    std::string word;
    line >> word;
    if (word == "end_header") return header;
    if (word == "format") {
      line >> word;
      const std::vector<std::string> known = {"ascii", "binary_little_endian", "binary_big_endian"};
      const auto found = std::find(known.begin(), known.end(), word);
      if (found == known.end())
        words.refuse("the format " + in_quotes(word) + " is none of PLY; it has " + listed(known));
      header.form = static_cast<Form>(found - known.begin());
    } else if (word == "element") {
      Element& element = header.elements.emplace_back();
      line >> element.name >> element.count;
      if (!line || element.count > words.size()) words.refuse("an element without a number that fits the file");
    } else if (word == "property" && !header.elements.empty()) {
      Property& property = header.elements.back().properties.emplace_back();
      line >> word;
      const bool list = word == "list";
      if (list) {
        line >> word;
        property.count = type_of(word);
        line >> word;
      }
      property.type = type_of(word);
      line >> property.name;
      if (!line || property.type == nullptr || (list && property.count == nullptr))
        words.refuse("a property of an unknown type");
      if (list && property.count->kind == Kind::real) words.refuse("a list whose length is no whole number");
    } else if (words.at_end()) {
      words.refuse("ends within its header");
    }
  }
}

template <class T>
double value_of(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double read_number(Words& words, Form form, const Type& type) {
  static_assert(std::endian::native == std::endian::little);
  if (form == Form::text) return words.number<double>("a number");
  std::array<char, 8> bytes{};
  std::memcpy(bytes.data(), words.bytes(type.size, "its data").data(), type.size);
  if (form == Form::big_endian) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(type.size));
  if (type.kind == Kind::real) return type.size == 4 ? value_of<float>(bytes.data()) : value_of<double>(bytes.data());
  const bool with_sign = type.kind == Kind::signed_number;
  const char* const from = bytes.data();
  if (type.size == 1) return with_sign ? value_of<std::int8_t>(from) : value_of<std::uint8_t>(from);
  if (type.size == 2) return with_sign ? value_of<std::int16_t>(from) : value_of<std::uint16_t>(from);
  return with_sign ? value_of<std::int32_t>(from) : value_of<std::uint32_t>(from);
}

bool is_corners(const Property& property) {
  return property.count != nullptr && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// Nodes have x, y and z, faces a list of them; whatever else there is, is skipped.
void check_header(const Header& header, const Words& words) {
  std::vector<std::string> there;
  bool nodes = false, faces = false;
  for (const Element& element : header.elements) {
    for (const Property& property : element.properties) {
      there.push_back(element.name + '.' + property.name);
      nodes |= element.name == "vertex" && property.name == "x" && property.count == nullptr;
      faces |= element.name == "face" && is_corners(property);
    }
  }
  const std::string has = "; it has " + listed(there);
  if (!nodes) words.refuse("there is no element vertex with x, y and z" + has);
  if (!faces) words.refuse("there is no element face with a list vertex_indices or vertex_index" + has);
}

std::vector<int> read_list(Words& words, Form form, const Property& property) {
  const double count = read_number(words, form, *property.count);
  if (!(count >= 0 && count <= static_cast<double>(words.size()) && count == std::floor(count)))
    words.refuse("a list of " + rouleau::number(count) + " numbers");
  std::vector<int> corners;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const double value = read_number(words, form, *property.type);
    if (!is_corners(property)) continue;
    if (!(value >= 0 && value < 1e9 && value == std::floor(value)))
      words.refuse("a face has the node " + rouleau::number(value));
    corners.push_back(static_cast<int>(value));
  }
  return corners;
}

}  // namespace

core::TriangleSurface read_ply(Words& words) {
  const Header header = read_header(words);
  check_header(header, words);
  core::TriangleSurface surface;
  for (const Element& element : header.elements) {
    for (std::size_t i = 0; i < element.count; ++i) {
      core::Vec<3> place = core::Vec<3>::Constant(std::nan(""));
      std::vector<int> corners;
      for (const Property& property : element.properties) {
        if (property.count != nullptr) {
          const std::vector<int> list = read_list(words, header.form, property);
          if (is_corners(property)) corners = list;
          continue;
        }
        const double value = read_number(words, header.form, *property.type);
        if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
          place[property.name[0] - 'x'] = value;
      }
      if (element.name == "vertex") surface.nodes.push_back(place);
      if (element.name == "face") add_face(surface, corners, words);
    }
  }
  if (!words.next().empty()) words.refuse("goes on behind what its header announces");
  return surface;
}

}  // namespace rouleau::shape
