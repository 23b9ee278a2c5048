// Surfaces from files: the same in every format, and what is no surface is refused with its line.
#include "shape/formats/mesh_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "shape/surface.hpp"
#include "unit/surface/fixture.hpp"

using namespace rouleau;
using namespace rouleau::test;
using Catch::Matchers::Contains;

namespace {

class File {
 public:
  ~File() { std::filesystem::remove(path_); }
  explicit File(const std::string& ending = "")
      : path_(std::filesystem::temp_directory_path() / ("rouleau-mesh-" + std::to_string(::getpid()) + ending)) {}
  [[nodiscard]] std::filesystem::path write(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return path_;
  }
  [[nodiscard]] core::TriangleSurface read(const std::string& text) const { return shape::read_mesh(write(text)); }
  [[nodiscard]] Error refusal(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const Error& error) {
      return error;
    }
    return {Cause::bad_input, "read without a fault"};
  }

 private:
  std::filesystem::path path_;
};

void put(std::ostream& out, const auto& value) { out.write(reinterpret_cast<const char*>(&value), sizeof value); }

std::string off_of(const core::TriangleSurface& s) {
  std::ostringstream out;
  out.precision(17);
  out << "OFF\n# a comment\n" << s.nodes.size() << ' ' << s.triangles.size() << " 0\n";
  for (const Vec<3>& node : s.nodes) out << node.x() << ' ' << node.y() << ' ' << node.z() << '\n';
  for (const auto& t : s.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << " 255 0 0\n";
  return out.str();
}

std::string obj_of(const core::TriangleSurface& s, bool from_the_end) {
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

std::string ply_of(const core::TriangleSurface& s, bool binary) {
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

std::string stl_of(const core::TriangleSurface& s, bool binary) {
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
  const core::TriangleSurface sphere = core::unit_sphere(3);
  const auto is_the_sphere = [&](const core::TriangleSurface& read) {
    CHECK(read.triangles == sphere.triangles);
    REQUIRE(read.nodes.size() == sphere.nodes.size());
    for (std::size_t i = 0; i < read.nodes.size(); ++i) CHECK(read.nodes[i] == sphere.nodes[i]);
  };
  for (const std::string& text : {off_of(sphere), ply_of(sphere, false), ply_of(sphere, true)})
    is_the_sphere(file.read(text));
  for (const bool from_the_end : {false, true}) is_the_sphere(File(".OBJ").read(obj_of(sphere, from_the_end)));
  for (const std::string& text : {stl_of(sphere, false), stl_of(sphere, true)}) {
    const core::TriangleSurface read = file.read(text);
    CHECK(read.nodes.size() == sphere.nodes.size());
    CHECK(core::rest_surface(read).rest_volume == Approx(core::rest_surface(sphere).rest_volume).epsilon(1e-6));
  }
  // Squares become triangles.
  CHECK(file.read("OFF\n8 6 12\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n4 0 3 2 1\n4 4 5 6 7\n"
                  "4 0 1 5 4\n4 1 2 6 5\n"
                  "4 2 3 7 6\n4 3 0 4 7\n")
            .triangles.size() == 12);
  CHECK(File(".obj")
            .read("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 4 3 2\nf 5 6 7 8\n"
                  "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n")
            .triangles.size() == 12);
}

TEST_CASE("a file that holds no closed surface is refused with its place and the reason") {
  const File file;
  const core::TriangleSurface sphere = core::unit_sphere(2);
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
  CHECK_THAT(file.refusal("nothing of the kind").what(),
             Contains("no OBJ, OFF, PLY or STL file: it begins with \"nothing\""));
  CHECK(file.read(obj_of(sphere, false)).triangles == sphere.triangles);  // whatever it is called
  const File obj(".obj");
  const auto refused_face = [&](const std::string& face) {
    return obj.refusal("v 0 0 0\nv 1 0 0\n\nf " + face + "\n");
  };
  CHECK_THAT(refused_face("1 2 3").what(), Contains("has the node 3, and there are 2 before it"));
  CHECK_THAT(refused_face("1 2 -3").what(), Contains("has the node -3"));
  CHECK_THAT(refused_face("1 2 0").what(), Contains("has the node 0") && Contains("write the mesh anew"));
  CHECK_THAT(refused_face("1 2 x/1").what(), Contains("\"x\" stands where a node is expected"));
  CHECK_THAT(refused_face("1 2 99999999999999999999").what(), Contains("stands where a node is expected"));
  CHECK_THAT(refused_face("1 2").what(), Contains("a face has 2 corners"));
  CHECK(refused_face("1 2 3").place().line == 4);
  CHECK_THAT(obj.refusal("v 0 0").what(), Contains("ends where a coordinate"));
  CHECK_THAT(obj.refusal("").what(), Contains("triangles"));
  const std::string ply = ply_of(sphere, true), stl = stl_of(sphere, true);
  CHECK_THAT(file.refusal(ply.substr(0, ply.size() - 9)).what(), Contains("ends within its data"));
  CHECK_THAT(file.refusal(ply.substr(0, 45)).what(), Contains("ends within its header"));
  CHECK_THAT(file.refusal(stl.substr(0, stl.size() - 9)).what(),
             Contains("ends within its faces, read as binary STL") && Contains("write the mesh anew"));
  // A sphere seen from inside.
  core::TriangleSurface inside = sphere;
  for (auto& triangle : inside.triangles) std::swap(triangle[0], triangle[1]);
  CHECK_THAT(file.refusal(off_of(inside)).what(),
             Contains("clockwise seen from outside") && Contains("turn them over"));
}

namespace {

/// A PLY file whose faces have further lists and numbers around their nodes, in any of its forms.
std::string rich_ply_of(const core::TriangleSurface& s, const std::string& form, const std::string& list) {
  std::ostringstream out;
  out.precision(17);
  out << "ply\r\nformat " << form << " 1.0\r\nobj_info a scan\r\nelement camera 1\r\nproperty list uchar float view\r\n"
      << "element vertex " << s.nodes.size() << "\r\nproperty float nx\r\nproperty double x\r\nproperty double y\r\n"
      << "property double z\r\nelement face " << s.triangles.size()
      << "\r\nproperty list uchar float texcoord\r\nproperty uchar flags\r\nproperty list ushort uint " << list
      << "\r\nproperty list int short more\r\nelement edge 1\r\nproperty int vertex1\r\nend_header\r\n";
  const bool text = form == "ascii", big = form == "binary_big_endian";
  const auto add = [&](auto value) {
    if (text) {
      out << +value << ' ';
      return;
    }
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    if (big) std::reverse(bytes.begin(), bytes.end());
    out << bytes;
  };
  add(std::uint8_t{2}), add(0.5F), add(0.25F);
  for (const Vec<3>& node : s.nodes) add(1.0F), add(node.x()), add(node.y()), add(node.z());
  for (const auto& t : s.triangles) {
    add(std::uint8_t{6});
    for (int k = 0; k < 6; ++k) add(0.125F);
    add(std::uint8_t{255}), add(std::uint16_t{3});
    for (const int node : t) add(static_cast<std::uint32_t>(node));
    add(std::int32_t{1}), add(std::int16_t{-7});
    if (text) out << '\n';
  }
  add(std::int32_t{3});
  return out.str();
}

}  // namespace

TEST_CASE("of PLY the list of nodes is the face, and everything else is skipped") {
  const File file;
  const core::TriangleSurface sphere = core::unit_sphere(3);
  for (const char* form : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const char* list : {"vertex_indices", "vertex_index"}) {
      CAPTURE(form, list);
      const core::TriangleSurface read = file.read(rich_ply_of(sphere, form, list));
      CHECK(read.triangles == sphere.triangles);
      CHECK(read.nodes == sphere.nodes);
    }
  }
  const std::string good = ply_of(sphere, false);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return file.refusal(text);
  };
  CHECK_THAT(changed("vertex_indices", "corners").what(),
             Contains("no element face with a list vertex_indices or vertex_index") && Contains("face.corners"));
  CHECK_THAT(changed("double x", "double a").what(), Contains("no element vertex with x, y and z"));
  CHECK_THAT(changed("list uchar", "list float").what(), Contains("length is no whole number"));
  CHECK_THAT(changed("element face " + std::to_string(sphere.triangles.size()), "element face 179").what(),
             Contains("goes on behind"));
  CHECK_THAT(changed("element face " + std::to_string(sphere.triangles.size()), "element face 181").what(),
             Contains("ends where"));
}

TEST_CASE("meshes are read in the ways that programs write them") {
  const File file;
  const core::TriangleSurface sphere = core::unit_sphere(2);
  const double volume = core::rest_surface(sphere).rest_volume;
  const auto is_the_sphere = [&](const std::string& text) {
    const core::TriangleSurface read = file.read(text);
    CHECK(read.nodes.size() == sphere.nodes.size());
    CHECK(read.triangles.size() == sphere.triangles.size());
    CHECK(core::rest_surface(read).rest_volume == Approx(volume).epsilon(1e-5));
  };
  const auto upper = [](std::string text) {
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
  };
  std::string stl = stl_of(sphere, false), named = stl, binary = stl_of(sphere, true), obj = obj_of(sphere, false);
  is_the_sphere(upper(stl));
  named.replace(0, 12, "solid " + std::string(220, 'x') + " vertex");
  is_the_sphere(named);
  binary.replace(0, 15, "solid of facets");  // a binary file may begin so, too
  is_the_sphere(binary);
  // Lines that go on, with either end of line; the lines behind keep their numbers.
  for (const char* joint : {" \\\n", " \\\r\n", "\\\n "}) {
    std::string joined = obj;
    for (std::size_t at = joined.find("\nf "); at != joined.npos; at = joined.find("\nf ", at + 8))
      joined.replace(joined.find(' ', at + 3), 1, joint);
    is_the_sphere(joined);
  }
  CHECK(file.refusal("v 0 0 \\\n0\nv 1 0 0\nf 1 2 x\n").place().line == 4);
  std::string off = off_of(sphere), coloured = "COFF\n" + off.substr(off.find('#'));
  for (std::size_t i = 0, at = coloured.find(" 0\n") + 2; i < sphere.nodes.size(); ++i) {
    at = coloured.find('\n', at + 1);
    coloured.insert(at, " 200 30 30 255");
    at = coloured.find('\n', at);
  }
  is_the_sphere(coloured);
  is_the_sphere("\xEF\xBB\xBF" + off);
  std::string old = ply_of(sphere, false);
  std::replace(old.begin(), old.end(), '\n', '\r');
  is_the_sphere(old);
  CHECK_THAT(file.refusal("4OFF\n1 1 0\n").what(), Contains("three coordinates"));
}

TEST_CASE("nodes at the same place, or a last digit from it, are one where a mesh is not closed otherwise") {
  const File file;
  const core::TriangleSurface sphere = core::unit_sphere(3);
  const double volume = core::rest_surface(sphere).rest_volume;
  const auto apart = [&](double distance) {  // every triangle with nodes of its own
    core::TriangleSurface made;
    int turn = 0;
    for (const auto& triangle : sphere.triangles) {
      const int first = static_cast<int>(made.nodes.size());
      for (const int node : triangle) made.nodes.push_back(sphere.nodes[node] + distance * Vec<3>::Unit(++turn % 3));
      made.triangles.push_back({first, first + 1, first + 2});
    }
    return made;
  };
  for (const double distance : {0.0, 1e-6, 5e-6}) {
    const core::TriangleSurface read = file.read(off_of(apart(distance)));
    CHECK(read.nodes.size() == sphere.nodes.size());
    CHECK(core::rest_surface(read).rest_volume == Approx(volume).epsilon(1e-4));
  }
  CHECK(file.read(stl_of(apart(5e-6), true)).nodes.size() == sphere.nodes.size());
  CHECK_THAT(file.refusal(off_of(apart(1e-3))).what(), Contains("not closed"));
  // A hole stays one, and it is said what was joined.
  core::TriangleSurface open = apart(0);
  open.triangles.pop_back();
  CHECK_THAT(file.refusal(off_of(open)).what(), Contains("not closed") && Contains("448 of its nodes lie within"));
  core::TriangleSurface twice = sphere;
  twice.triangles.push_back(twice.triangles[5]);
  CHECK_THAT(file.refusal(off_of(twice)).what(), Contains("a face is there twice"));
  // Triangles between two copies of a pole have no area and go.
  core::TriangleSurface pole = sphere;
  pole.nodes.push_back(pole.nodes[0]);
  const auto with_pole = std::find_if(pole.triangles.begin(), pole.triangles.end(), [](auto& t) { return t[0] == 0; });
  const auto [a, b, c] = *with_pole;
  const int copy = static_cast<int>(pole.nodes.size()) - 1;
  *with_pole = {copy, b, c};
  pole.triangles.push_back({a, b, copy});
  pole.triangles.push_back({a, copy, b});
  CHECK(file.read(off_of(pole)).triangles.size() == sphere.triangles.size());
  // A file of zeros is no surface, and says so soon.
  std::string zeros(84 + 50 * 20000, '\0');
  const std::uint32_t faces = 20000;
  std::memcpy(&zeros[80], &faces, sizeof faces);
  CHECK_THAT(file.refusal(zeros).what(), Contains("at least four triangles"));
}

TEST_CASE("a mesh has the centroid of its volume in the origin, wherever its file has it") {
  const File file(".off");
  core::TriangleSurface body = core::ellipsoid(4, {1, 0.5, 0.7});
  for (Vec<3>& node : body.nodes) node.x() += 0.3 * node.y() * node.y();  // not the mean of its nodes
  const auto surface = [&](const Vec<3>& offset, double unit) {
    core::TriangleSurface moved = body;
    for (Vec<3>& node : moved.nodes) node += offset;
    return shape::mesh_surface({file.write(off_of(moved)), unit});
  };
  const core::TriangleSurface here = surface({0, 0, 0}, 1e-6), far = surface({40, -7, 1000}, 1e-6);
  REQUIRE(here.nodes.size() == far.nodes.size());
  Vec<3> moment = Vec<3>::Zero();
  for (const auto& [a, b, c] : here.triangles) {
    const Vec<3>&p = here.nodes[a], &q = here.nodes[b], &r = here.nodes[c];
    moment += p.dot(q.cross(r)) * (p + q + r) / 24;
  }
  CHECK(moment.norm() < 1e-14 * 1e-24);
  for (std::size_t i = 0; i < here.nodes.size(); ++i) CHECK((here.nodes[i] - far.nodes[i]).norm() < 1e-12 * 1e-6);
}
