// Surfaces from files: the same in every format, and what is no surface is refused with its line.
#include "shape/mesh_file.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "fixture.hpp"

using namespace rouleau;
using namespace rouleau::test;
using Catch::Matchers::Contains;

namespace {

class File {
 public:
  ~File() { std::filesystem::remove(path_); }
  explicit File(const std::string& ending = "")
      : path_(std::filesystem::temp_directory_path() / ("rouleau-mesh-" + std::to_string(::getpid()) + ending)) {}
  shape::TriangleSurface read(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return shape::read_mesh(path_);
  }
  [[nodiscard]] Error refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const Error& error) {
      return error;
    }
    return {Cause::bad_input, "read without a fault"};
  }

 private:
  std::filesystem::path path_;
};

void put(std::ostream& out, const auto& value) { out.write(reinterpret_cast<const char*>(&value), sizeof value); }

std::string off_of(const shape::TriangleSurface& s) {
  std::ostringstream out;
  out.precision(17);
  out << "OFF\n# a comment\n" << s.nodes.size() << ' ' << s.triangles.size() << " 0\n";
  for (const Vec<3>& node : s.nodes) out << node.x() << ' ' << node.y() << ' ' << node.z() << '\n';
  for (const auto& t : s.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << " 255 0 0\n";
  return out.str();
}

std::string obj_of(const shape::TriangleSurface& s, bool from_the_end) {
  std::ostringstream out;
  out.precision(17);
  out << "# a comment\r\nmtllib none.mtl\r\no sphere\r\n";
  for (const Vec<3>& node : s.nodes)
    out << "v " << node.x() << ' ' << node.y() << ' ' << node.z() << " 1.0\r\nvn 0 0 1\r\n";
  const int before = from_the_end ? -static_cast<int>(s.nodes.size()) : 1;
  for (const auto& t : s.triangles) {
    out << "f " << t[0] + before << ' ' << t[1] + before << "//" << t[1] + before << ' ' << t[2] + before << "/7/"
        << t[2] + before << " # a face\r\n";
  }
  return out.str();
}

std::string ply_of(const shape::TriangleSurface& s, bool binary) {
  std::ostringstream out;
  out.precision(17);
  out << "ply\nformat " << (binary ? "binary_little_endian" : "ascii") << " 1.0\ncomment a sphere\nelement vertex "
      << s.nodes.size()
      << "\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\nelement face "
      << s.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec<3>& node : s.nodes) {
    for (int k = 0; k < 3; ++k) {
      if (binary)
        put(out, node[k]);
      else
        out << node[k] << ' ';
    }
    if (binary)
      put(out, static_cast<unsigned char>(7));
    else
      out << "7\n";
  }
  for (const auto& t : s.triangles) {
    if (binary) {
      put(out, static_cast<unsigned char>(3));
      for (const int node : t) put(out, node);
    } else {
      out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    }
  }
  return out.str();
}

std::string stl_of(const shape::TriangleSurface& s, bool binary) {
  std::ostringstream out;
  out.precision(9);
  if (binary) {
    out << std::string(80, ' ');
    put(out, static_cast<std::uint32_t>(s.triangles.size()));
  } else {
    out << "solid sphere\n";
  }
  for (const auto& t : s.triangles) {
    if (!binary)
      out << "facet normal 0 0 0\nouter loop\n";
    else
      out << std::string(12, '\0');
    for (const int node : t) {
      if (!binary) out << "vertex";
      for (int k = 0; k < 3; ++k) {
        if (binary)
          put(out, static_cast<float>(s.nodes[node][k]));
        else
          out << ' ' << static_cast<float>(s.nodes[node][k]);
      }
      if (!binary) out << '\n';
    }
    out << (binary ? std::string(2, '\0') : "endloop\nendfacet\n");
  }
  if (!binary) out << "endsolid sphere\n";
  return out.str();
}

}  // namespace

TEST_CASE("a surface is the same from OBJ, OFF, PLY and STL, in text and in binary") {
  const File file;
  const shape::TriangleSurface sphere = shape::unit_sphere(3);
  const auto is_the_sphere = [&](const shape::TriangleSurface& read) {
    CHECK(read.triangles == sphere.triangles);
    REQUIRE(read.nodes.size() == sphere.nodes.size());
    for (std::size_t i = 0; i < read.nodes.size(); ++i) CHECK(read.nodes[i] == sphere.nodes[i]);
  };
  for (const std::string& text : {off_of(sphere), ply_of(sphere, false), ply_of(sphere, true)})
    is_the_sphere(file.read(text));
  for (const bool from_the_end : {false, true}) is_the_sphere(File(".OBJ").read(obj_of(sphere, from_the_end)));
  for (const std::string& text : {stl_of(sphere, false), stl_of(sphere, true)}) {
    const shape::TriangleSurface read = file.read(text);
    CHECK(read.nodes.size() == sphere.nodes.size());
    CHECK(shape::rest_surface(read).rest_volume == Approx(shape::rest_surface(sphere).rest_volume).epsilon(1e-6));
  }
  // Squares become triangles.
  CHECK(
      file.read(
              "OFF\n8 6 12\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n"
              "4 2 3 7 6\n4 3 0 4 7\n")
          .triangles.size() == 12);
  CHECK(
      File(".obj")
          .read(
              "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\n"
              "f 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n")
          .triangles.size() == 12);
}

TEST_CASE("a file that holds no closed surface is refused with its place and the reason") {
  const File file;
  const shape::TriangleSurface sphere = shape::unit_sphere(2);
  const std::string good = off_of(sphere);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  CHECK_THAT(file.refusal(good.substr(0, good.size() - 20)).what(), Contains("ends where"));
  CHECK(file.refusal(changed("42 80 0", "42 8x 0")).place().line == 3);
  CHECK_THAT(file.refusal(changed("42 80 0", "42 8x 0")).what(), Contains("\"8x\""));
  CHECK_THAT(file.refusal(changed("42 80 0", "42 79 0")).what(), Contains("not closed"));
  CHECK_THAT(file.refusal(changed("42 80 0", "99999999999 80 0")).what(), Contains("more than the file has room for"));
  CHECK_THAT(file.refusal(changed("3 0 1 2", "3 0 2 1")).what(), Contains("same direction"));
  CHECK_THAT(file.refusal(changed("3 0 1 2", "3 0 1 999")).what(), Contains("has the node 999"));
  CHECK_THAT(file.refusal("nothing of the kind").what(), Contains("no OFF, PLY or STL"));
  CHECK_THAT(file.refusal(obj_of(sphere, false)).what(), Contains("does not end in .obj"));
  const File obj(".obj");
  const auto refused_face = [&](const std::string& face) {
    return obj.refusal("v 0 0 0\nv 1 0 0\n\nf " + face + "\n");
  };
  CHECK_THAT(refused_face("1 2 3").what(), Contains("has the node 3, and there are 2 before it"));
  CHECK_THAT(refused_face("1 2 -3").what(), Contains("has the node -3"));
  CHECK_THAT(refused_face("1 2 0").what(), Contains("has the node 0"));
  CHECK_THAT(refused_face("1 2 x/1").what(), Contains("\"x\" stands where a node is expected"));
  CHECK_THAT(refused_face("1 2 99999999999999999999").what(), Contains("stands where a node is expected"));
  CHECK_THAT(refused_face("1 2").what(), Contains("a face has 2 corners"));
  CHECK(refused_face("1 2 3").place().line == 4);
  CHECK_THAT(obj.refusal("v 0 0").what(), Contains("ends where a coordinate"));
  CHECK_THAT(obj.refusal("").what(), Contains("triangles"));
  const std::string ply = ply_of(sphere, true), stl = stl_of(sphere, true);
  CHECK_THAT(file.refusal(ply.substr(0, ply.size() - 9)).what(), Contains("ends within its data"));
  CHECK_THAT(file.refusal(ply.substr(0, 45)).what(), Contains("ends within its header"));
  CHECK_THAT(file.refusal(stl.substr(0, stl.size() - 9)).what(), Contains("ends within its faces"));
  // A sphere seen from inside.
  shape::TriangleSurface inside = sphere;
  for (auto& triangle : inside.triangles) std::swap(triangle[0], triangle[1]);
  CHECK_THAT(file.refusal(off_of(inside)).what(), Contains("clockwise seen from outside"));
}
