#include "mesh.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <string>
#include "line_crossing.hpp"

namespace rouleau::core {

namespace {

[[noreturn]] void refuse(const std::string& problem) { throw std::invalid_argument(problem); }

std::string triangle_name(int t) { return "triangle " + std::to_string(t); }

/// Fills rings from pairs (node, entry), which come in the order of the entries.
template <class ForEach>
Mesh::Rings rings(int nodes, const ForEach& for_each) {
  Mesh::Rings made;
  made.first.assign(nodes + 1, 0);
  for_each([&](int node, int) { ++made.first[node + 1]; });
  for (int i = 0; i < nodes; ++i) made.first[i + 1] += made.first[i];
  made.entry.resize(made.first[nodes]);
  std::vector<int> next(made.first.begin(), made.first.end() - 1);
  for_each([&](int node, int entry) { made.entry[next[node]++] = entry; });
  return made;
}

}  // namespace

Mesh::Mesh(int node_count, std::vector<std::array<int, 3>> triangles)
    : node_count_(node_count), triangles_(std::move(triangles)) {
  if (triangle_count() < 4)
    refuse("a closed surface has at least four triangles, not " + std::to_string(triangle_count()));
  for (int t = 0; t < triangle_count(); ++t) {
    for (const int node : triangles_[t]) {
      if (node < 0 || node >= node_count_) {
        refuse(triangle_name(t) + " has the node " + std::to_string(node) + ", and there are " +
               std::to_string(node_count_));
      }
    }
    const auto [a, b, c] = triangles_[t];
    if (a == b || b == c || c == a) refuse(triangle_name(t) + " has a node twice");
  }
  join_edges();
  make_rings();
}

void Mesh::join_edges() {
  std::map<std::pair<int, int>, int> known;  // from (a, b) to the edge that runs so in its left triangle
  triangle_edges_.resize(triangles_.size());
  for (int t = 0; t < triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles_[t][(k + 1) % 3], b = triangles_[t][(k + 2) % 3];
      const auto words = [&](int other) {
        return triangle_name(t) + " and " + triangle_name(other) + " run along the edge from node " +
               std::to_string(a) + " to node " + std::to_string(b);
      };
      if (const auto same = known.find({a, b}); same != known.end()) {
        refuse(words(edges_[same->second].left) +
               " in the same direction: they face opposite sides, or the edge has three triangles\nturn one over, or "
               "leave one out");
      }
      const auto opposite = known.find({b, a});
      if (opposite == known.end()) {
        known[{a, b}] = triangle_edges_[t][k] = edge_count();
        edges_.push_back({a, b, t, -1});
        continue;
      }
      Edge& edge = edges_[triangle_edges_[t][k] = opposite->second];
      if (edge.right >= 0) refuse(words(edge.right) + ", which has three triangles");
      edge.right = t;
    }
  }
  for (const Edge& edge : edges_) {
    if (edge.right < 0) {
      refuse(triangle_name(edge.left) + " has no neighbour beyond the edge from node " + std::to_string(edge.a) +
             " to node " + std::to_string(edge.b) + ": the surface is not closed\nfill the hole there");
    }
  }
}

void Mesh::make_rings() {
  corners_ = rings(node_count_, [&](const auto& add) {
    for (int t = 0; t < triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) add(triangles_[t][k], 3 * t + k);
  });
  node_edges_ = rings(node_count_, [&](const auto& add) {
    for (int e = 0; e < edge_count(); ++e) {
      add(edges_[e].a, e);
      add(edges_[e].b, e);
    }
  });
  std::vector<int> reached = {0};
  std::vector<bool> seen(triangles_.size());
  seen[0] = true;
  for (std::size_t next = 0; next < reached.size(); ++next) {
    for (const int e : triangle_edges_[reached[next]]) {
      for (const int t : {edges_[e].left, edges_[e].right})
        if (!seen[t]) reached.push_back(t), seen[t] = true;
    }
  }
  if (static_cast<int>(reached.size()) < triangle_count()) {
    const auto lost = std::find(seen.begin(), seen.end(), false) - seen.begin();
    refuse(triangle_name(static_cast<int>(lost)) +
           " is not joined to the first one: the surface has several pieces\nkeep one of them");
  }
  for (int i = 0; i < node_count_; ++i) {
    const int first = corners_.first[i], end = corners_.first[i + 1];
    if (first == end) refuse("node " + std::to_string(i) + " belongs to no triangle\nleave it out");
    // Turn around the node from triangle to triangle: one turn must meet all of them.
    int count = 0, t = corners_.entry[first] / 3;
    do {
      const auto k = std::find(triangles_[t].begin(), triangles_[t].end(), i) - triangles_[t].begin();
      const Edge& edge = edges_[triangle_edges_[t][(k + 1) % 3]];
      t = edge.left == t ? edge.right : edge.left;
      ++count;
    } while (t != corners_.entry[first] / 3 && count <= end - first);
    if (count != end - first) refuse("at node " + std::to_string(i) + " two parts of the surface touch");
  }
}

double enclosed_volume(const Mesh& mesh, Nodes nodes) {
  const Vec<3> origin = nodes[0];  // far from it the digits would cancel
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles())
    sum += (nodes[a] - origin).dot((nodes[b] - origin).cross(nodes[c] - origin));
  return sum / 6;
}

double surface_area(const Mesh& mesh, Nodes nodes) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles()) sum += (nodes[b] - nodes[a]).cross(nodes[c] - nodes[a]).norm();
  return sum / 2;
}

bool encloses(const Mesh& mesh, Nodes nodes, const Vec<3>& point) {
  int inside = 0;
  for (const auto& [i, j, k] : mesh.triangles()) {
    const auto crossing = LinesThroughTriangle(nodes[i], nodes[j], nodes[k]).crossing({point.y(), point.z()});
    if (crossing && crossing->x > point.x()) inside += crossing->leaves ? 1 : -1;
  }
  return inside > 0;
}

std::vector<Vec<3>> area_vectors(const Mesh& mesh, Nodes nodes) {
  std::vector<Vec<3>> vectors;
  vectors.reserve(mesh.triangles().size());
  for (const auto& [a, b, c] : mesh.triangles()) vectors.push_back((nodes[b] - nodes[a]).cross(nodes[c] - nodes[a]));
  return vectors;
}

std::vector<double> node_areas(const Mesh& mesh, Nodes nodes) {
  std::vector<double> area(mesh.node_count());
  for (const auto& corners : mesh.triangles()) {
    double along[3], square[3];  // of the corner: the dot product of its sides; the square of the side opposite to it
    for (int k = 0; k < 3; ++k) {
      const Vec<3> here = nodes[corners[k]], one = nodes[corners[(k + 1) % 3]], two = nodes[corners[(k + 2) % 3]];
      along[k] = (one - here).dot(two - here);
      square[k] = (two - one).squaredNorm();
    }
    const double twice = (nodes[corners[1]] - nodes[corners[0]]).cross(nodes[corners[2]] - nodes[corners[0]]).norm();
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      double share = 0;
      if (along[0] < 0 || along[1] < 0 || along[2] < 0)
        share = along[k] < 0 ? twice / 4 : twice / 8;
      else
        share = (square[l] * along[l] + square[m] * along[m]) / (8 * twice);
      area[corners[k]] += share;
    }
  }
  return area;
}

std::vector<Vec<3>> node_normals(const Mesh& mesh, Nodes nodes) {
  const std::vector<Vec<3>> of_triangle = area_vectors(mesh, nodes);
  std::vector<Vec<3>> normals(static_cast<std::size_t>(mesh.node_count()), Vec<3>::Zero());
  std::size_t t = 0;
  for (const auto& corners : mesh.triangles()) {
    for (const int node : corners) normals[node] += of_triangle[t];
    ++t;
  }
  for (Vec<3>& normal : normals) normal.normalize();
  return normals;
}

std::vector<double> integrated_curvature(const Mesh& mesh, Nodes nodes) {
  const std::vector<Vec<3>> normal = area_vectors(mesh, nodes);
  std::vector<double> sum(mesh.node_count());
  for (const Mesh::Edge& edge : mesh.edges()) {
    const Vec<3> along = nodes[edge.b] - nodes[edge.a];
    const double length = along.norm();
    const double sine = normal[edge.left].cross(normal[edge.right]).dot(along) / length;
    const double turned = length * std::atan2(sine, normal[edge.left].dot(normal[edge.right]));
    sum[edge.a] += turned / 2;
    sum[edge.b] += turned / 2;
  }
  return sum;
}

InertiaEllipsoid inertia_ellipsoid(const Mesh& mesh, Nodes nodes) {
  const Vec<3> origin = nodes[0];
  double volume = 0;
  Vec<3> first = Vec<3>::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& [i, j, k] : mesh.triangles()) {
    const Vec<3> a = nodes[i] - origin, b = nodes[j] - origin, c = nodes[k] - origin, sum = a + b + c;
    const double six = a.dot(b.cross(c));  // times the volume of the tetrahedron
    volume += six / 6;
    first += six / 24 * sum;
    second += six / 120 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  InertiaEllipsoid ellipsoid;
  const Vec<3> middle = first / volume;
  ellipsoid.center = origin + middle;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second / volume - middle * middle.transpose());
  for (int k = 0; k < 3; ++k) {  // of an ellipsoid the moments are semi_axis^2 / 5
    ellipsoid.semi_axes[k] = std::sqrt(5 * std::max(0.0, solver.eigenvalues()[2 - k]));
    ellipsoid.axes[k] = solver.eigenvectors().col(2 - k);
  }
  return ellipsoid;
}

PlaneDeformation deformation_in_xy(const InertiaEllipsoid& ellipsoid) {
  int across = 0;  // the axis that lies closest to z
  for (int k = 1; k < 3; ++k)
    if (std::abs(ellipsoid.axes[k].z()) > std::abs(ellipsoid.axes[across].z())) across = k;
  const int major = across == 0 ? 1 : 0, minor = across == 2 ? 1 : 2;
  const double a = ellipsoid.semi_axes[major], b = ellipsoid.semi_axes[minor];
  const Vec<3>& axis = ellipsoid.axes[major];
  const double sign = axis.x() < 0 || (axis.x() == 0 && axis.y() < 0) ? -1 : 1;
  return {(a - b) / (a + b), std::atan2(sign * axis.y(), sign * axis.x())};
}

}  // namespace rouleau::core
