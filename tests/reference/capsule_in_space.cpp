// A capsule, or two, in unbounded simple shear in three dimensions, by boundary integrals: what Rouleau is compared
// with, and does not compute (tests/reference/capsules_in_space.json). Shares no code with it.
//
//   g++ -O3 -march=native -fopenmp -std=c++20 -I /usr/include/eigen3 tests/reference/capsule_in_space.cpp -o
//   /tmp/capsule /tmp/capsule LAW CA RATIO [N] [STRAIN] [STEP] [SHAPE] [DX DY]
//
// LAW is neo-hookean, skalak (C = 1) or drop; CA = viscosity times shear rate times radius over the shear modulus (the
// surface tension); RATIO the viscosity inside over that outside; N the frequency of the geodesic sphere (10 N^2 + 2
// nodes); SHAPE "sphere", if left out, or "biconcave". Prints strain, deformation (a - b)/(a + b) of the ellipsoid of
// inertia in the plane of shear, its angle over pi, and the volume over that at first. With DX and DY a second one like
// it lies that far along the flow and along its gradient, and the distances of their centroids along both follow, and
// the least one from a node of the first to the second's nodes and middles of triangles.
//
// Lengths are over the radius, rates over the shear rate, stresses over viscosity times shear rate. On the surface
//   u(x0) = u_shear(x0) + 1/(8 pi) int G.q dS + (1 - ratio)/(8 pi) int (u(x) - u(x0)).T.n dS,
// q the force of the membrane on the fluid per area, x - x0 the argument of G and T (Pozrikidis, Boundary Integral and
// Singularity Methods, 1992, section 5.3, with the identity int T.n dS = -4 pi to take the singularity out). q and u
// are linear on flat triangles; those around x0 are integrated in polar coordinates, near ones with more points. The
// equation for u is solved by fixed points with Anderson's mixing. Steps are Runge-Kutta's of second order. Membranes
// have no bending stiffness.
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <vector>

using Vec = Eigen::Vector3d;
using Field = std::vector<Vec>;
using std::numbers::pi;

struct Mesh {
  Field x;
  std::vector<std::array<int, 3>> triangles;
};

/// Icosahedron whose faces are cut into n^2, put onto the unit sphere.
Mesh geodesic_sphere(int n) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const Vec corner[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                          {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  constexpr int face[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                               {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                               {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  Mesh mesh;
  std::map<std::array<long, 3>, int> known;
  const auto node = [&](const Vec& place) {
    const Vec p = place.normalized();
    const std::array<long, 3> key{std::lround(p.x() * 1e8), std::lround(p.y() * 1e8), std::lround(p.z() * 1e8)};
    const auto [at, is_new] = known.try_emplace(key, static_cast<int>(mesh.x.size()));
    if (is_new) mesh.x.push_back(p);
    return at->second;
  };
  for (const auto& f : face) {
    const auto at = [&](int i, int j) {
      return node(corner[f[0]] * (n - i - j) + corner[f[1]] * i + corner[f[2]] * j);
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < n) mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  for (auto& [a, b, c] : mesh.triangles) {
    if ((mesh.x[b] - mesh.x[a]).cross(mesh.x[c] - mesh.x[a]).dot(mesh.x[a]) < 0) std::swap(b, c);
  }
  return mesh;
}

/// The same points on the biconcave disc of Evans and Fung (Microvascular Research 4, 335, 1972), its axis along y, its
/// radius 1.
void make_biconcave(Field& x) {
  for (Vec& p : x) {
    const double r2 = p.x() * p.x() + p.z() * p.z();
    p.y() *= 0.5 * (0.207 + 2.002 * r2 - 1.122 * r2 * r2);
  }
}

struct Point {
  double weight, b, c;  ///< of the triangle's area; a + b (B - A) + c (C - A)
};
/// Dunavant's rules of degree 5 with 7 points, and of degree 2 with 3.
const std::vector<Point>& points(bool near) {
  static const std::vector<Point> three{
      {1.0 / 3, 1.0 / 6, 1.0 / 6}, {1.0 / 3, 2.0 / 3, 1.0 / 6}, {1.0 / 3, 1.0 / 6, 2.0 / 3}};
  static const std::vector<Point> many = [] {
    const double p = 0.470142064105115, q = 0.101286507323456, wp = 0.132394152788506, wq = 0.125939180544827;
    const std::vector<Point> seven{{0.225, 1.0 / 3, 1.0 / 3}, {wp, p, p}, {wp, 1 - 2 * p, p},
                                   {wp, p, 1 - 2 * p},        {wq, q, q}, {wq, 1 - 2 * q, q},
                                   {wq, q, 1 - 2 * q}};
    std::vector<Point> all;  // on four parts
    for (const Point& s : seven) {
      for (const auto& [b, c] : {std::pair{0.0, 0.0}, {0.5, 0.0}, {0.0, 0.5}})
        all.push_back({s.weight / 4, b + s.b / 2, c + s.c / 2});
      all.push_back({s.weight / 4, 0.5 - s.b / 2, 0.5 - s.c / 2});
    }
    return all;
  }();
  return near ? many : three;
}
/// From corner A outward: (r, s) in the unit square to b = r (1 - s), c = r s; with 1/r in the integrand exact to high
/// order.
const std::vector<Point>& polar_points() {
  static const std::vector<Point> all = [] {
    constexpr double x[4] = {0.0694318442029737, 0.330009478207572, 0.669990521792428, 0.930568155797026};
    constexpr double w[4] = {0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727};
    std::vector<Point> p;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) p.push_back({2 * w[i] * w[j] * x[i], x[i] * (1 - x[j]), x[i] * x[j]});
    }
    return p;
  }();
  return all;
}

struct Capsule {
  Mesh mesh;
  Field rest;
  std::string law;
  double ca, ratio;
  std::deque<Eigen::VectorXd> tried, moved;  // of Anderson's mixing

  /// Force of each node on the fluid over the area that belongs to it, less a pressure, which moves nothing: so that
  /// what is left does no work where the volume alone changes.
  Field tractions(const Field& x) const {
    Field force(x.size(), Vec::Zero()), normal(x.size(), Vec::Zero());
    std::vector<double> area(x.size(), 0);
    for (const auto& t : mesh.triangles) {
      const Vec a = x[t[1]] - x[t[0]], b = x[t[2]] - x[t[0]];
      const double now = a.cross(b).norm() / 2;
      for (const int i : t) area[i] += now / 3, normal[i] += a.cross(b) / 6;
      const double g11 = a.dot(a), g12 = a.dot(b), g22 = b.dot(b);
      double w11, w12,
          w22;  // derivative of the triangle's energy by its metric, w12 for both off the diagonal together
      if (law == "drop") {
        // Energy sqrt(g)/2 with the tension 1/Ca.
        const double f = 1 / ca / (4 * 2 * now);
        w11 = f * g22, w12 = -2 * f * g12, w22 = f * g11;
      } else {
        const Vec p = rest[t[1]] - rest[t[0]], q = rest[t[2]] - rest[t[0]];
        const double r11 = p.dot(p), r12 = p.dot(q), r22 = q.dot(q), det = r11 * r22 - r12 * r12,
                     at_rest = std::sqrt(det) / 2;
        const double m11 = r22 / det, m12 = -r12 / det, m22 = r11 / det;  // inverse metric at rest
        const double i1 = m11 * g11 + 2 * m12 * g12 + m22 * g22 - 2, square = (g11 * g22 - g12 * g12) / det;
        double by_1, by_square;
        if (law == "skalak") {  // G/4 (I1^2 + 2 I1 - 2 I2 + C I2^2), C = 1
          by_1 = (i1 + 1) / 2, by_square = (square - 1) / 2 - 0.5;
        } else {  // G/2 (I1 + 1/(I2 + 1))
          by_1 = 0.5, by_square = -0.5 / (square * square);
        }
        const double scale = at_rest / ca;
        w11 = scale * (by_1 * m11 + by_square * g22 / det);
        w12 = scale * (2 * by_1 * m12 - 2 * by_square * g12 / det);
        w22 = scale * (by_1 * m22 + by_square * g11 / det);
      }
      const Vec on_1 = -(2 * w11 * a + w12 * b), on_2 = -(2 * w22 * b + w12 * a);
      force[t[1]] += on_1, force[t[2]] += on_2, force[t[0]] -= on_1 + on_2;
    }
    double work = 0, square = 0;
    for (std::size_t i = 0; i < x.size(); ++i) work += force[i].dot(normal[i]), square += normal[i].squaredNorm();
    for (std::size_t i = 0; i < x.size(); ++i) force[i] = (force[i] - work / square * normal[i]) / area[i];
    return force;
  }

  static bool has(const std::array<int, 3>& t, int i) { return t[0] == i || t[1] == i || t[2] == i; }

  /// int G.q dS at each node, and the shear.
  Field driven(const Field& x) const {
    const Field q = tractions(x);
    Field u(x.size());
#pragma omp parallel for schedule(dynamic, 8)
    for (std::size_t i = 0; i < x.size(); ++i) {
      Vec sum = Vec::Zero();
      for (std::array<int, 3> t : mesh.triangles) {
        const bool own = has(t, static_cast<int>(i));
        while (own && t[0] != static_cast<int>(i)) t = {t[1], t[2], t[0]};
        const Vec a = x[t[1]] - x[t[0]], b = x[t[2]] - x[t[0]];
        const double area = a.cross(b).norm() / 2;
        const bool near = (x[t[0]] - x[i]).squaredNorm() < 25 * area;
        for (const Point& p : own ? polar_points() : points(near)) {
          const Vec r = x[t[0]] + p.b * a + p.c * b - x[i],
                    f = (1 - p.b - p.c) * q[t[0]] + p.b * q[t[1]] + p.c * q[t[2]];
          const double inverse = 1 / r.norm();
          sum += p.weight * area * inverse * (f + r * (r.dot(f) * inverse * inverse));
        }
      }
      u[i] = Vec(x[i].y(), 0, 0) + sum / (8 * pi);
    }
    return u;
  }

  /// int (u(x) - u(x0)).T.n dS at each node; nothing from flat triangles around it.
  Field double_layer(const Field& x, const Field& u) const {
    Field result(x.size());
#pragma omp parallel for schedule(dynamic, 8)
    for (std::size_t i = 0; i < x.size(); ++i) {
      Vec sum = Vec::Zero();
      for (const auto& t : mesh.triangles) {
        if (has(t, static_cast<int>(i))) continue;
        const Vec a = x[t[1]] - x[t[0]], b = x[t[2]] - x[t[0]], normal = a.cross(b) / 2;
        const bool near = (x[t[0]] - x[i]).squaredNorm() < 25 * normal.norm();
        for (const Point& p : points(near)) {
          const Vec r = x[t[0]] + p.b * a + p.c * b - x[i];
          const Vec v = (1 - p.b - p.c) * u[t[0]] + p.b * u[t[1]] + p.c * u[t[2]] - u[i];
          const double square = r.squaredNorm();
          sum -= r * (6 * p.weight * r.dot(v) * r.dot(normal) / (square * square * std::sqrt(square)));
        }
      }
      result[i] = sum;
    }
    return result;
  }

  Field velocity(const Field& x, Field guess) {
    const Field at_first = driven(x);
    if (ratio == 1) return at_first;
    const long n = static_cast<long>(3 * x.size());
    const auto flat = [&](const Field& f) { return Eigen::Map<const Eigen::VectorXd>(f.front().data(), n); };
    tried.clear(), moved.clear();
    Field u = std::move(guess);
    for (int round = 0; round < 60; ++round) {
      const Field layer = double_layer(x, u);
      Field next = at_first;
      for (std::size_t i = 0; i < x.size(); ++i) next[i] += (1 - ratio) / (8 * pi) * layer[i];
      const Eigen::VectorXd change = flat(next) - flat(u);
      const double most = change.cwiseAbs().maxCoeff();
      if (most < 1e-7) return next;
      tried.push_back(flat(u)), moved.push_back(change);
      if (tried.size() > 8) tried.pop_front(), moved.pop_front();
      const long m = static_cast<long>(tried.size()) - 1;
      Eigen::VectorXd mixed = tried.back() + moved.back();
      if (m > 0) {
        Eigen::MatrixXd differences(n, m), steps(n, m);
        for (long k = 0; k < m; ++k) {
          differences.col(k) = moved[k + 1] - moved[k];
          steps.col(k) = tried[k + 1] - tried[k];
        }
        const Eigen::VectorXd share = differences.colPivHouseholderQr().solve(moved.back());
        mixed -= (steps + differences) * share;
      }
      Eigen::Map<Eigen::VectorXd>(u.front().data(), n) = mixed;
    }
    std::fprintf(stderr, "the double layer's equation is not solved\n");
    std::exit(1);
  }
};

struct Shape {
  double deformation, angle, volume;
  Vec centroid;
};
/// Of the capsule whose triangles these are.
Shape shape_of(std::span<const std::array<int, 3>> triangles, const Field& x) {
  double volume = 0;
  Vec first = Vec::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& t : triangles) {
    const Vec &p = x[t[0]], &q = x[t[1]], &r = x[t[2]];
    const double det = p.dot(q.cross(r));
    const Vec s = p + q + r;
    volume += det / 6;
    first += det / 24 * s;
    second += det / 120 * (p * p.transpose() + q * q.transpose() + r * r.transpose() + s * s.transpose());
  }
  const Eigen::Matrix2d plane = (second / volume - first * first.transpose() / (volume * volume)).topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(plane);
  const double a = std::sqrt(solver.eigenvalues()[1]), b = std::sqrt(solver.eigenvalues()[0]);
  const Eigen::Vector2d axis = solver.eigenvectors().col(1);
  return {(a - b) / (a + b), std::atan(axis.y() / axis.x()) / pi, volume, first / volume};
}

/// The shape as it lies in a mesh, and once more, so far from there.
void add_second(Mesh& mesh, const Vec& shift) {
  const int nodes = static_cast<int>(mesh.x.size());
  const std::size_t triangles = mesh.triangles.size();
  for (int i = 0; i < nodes; ++i) mesh.x.push_back(mesh.x[i] + shift / 2), mesh.x[i] -= shift / 2;
  for (std::size_t k = 0; k < triangles; ++k) {
    const auto [a, b, c] = mesh.triangles[k];
    mesh.triangles.push_back({a + nodes, b + nodes, c + nodes});
  }
}

double least_distance(const Mesh& mesh, const Field& x) {
  double least = INFINITY;
  const std::size_t nodes = x.size() / 2, half = mesh.triangles.size() / 2;
  for (std::size_t i = 0; i < nodes; ++i) {
    for (std::size_t j = nodes; j < x.size(); ++j) least = std::min(least, (x[i] - x[j]).norm());
    for (std::size_t k = half; k < 2 * half; ++k) {
      const auto& [a, b, c] = mesh.triangles[k];
      least = std::min(least, (x[i] - (x[a] + x[b] + x[c]) / 3).norm());
    }
  }
  return least;
}

int main(int count, char** words) {
  const std::string shape = count > 7 ? words[7] : "sphere";
  if (count < 4 || (shape != "sphere" && shape != "biconcave")) {
    std::fprintf(stderr, "usage: capsule LAW CA RATIO [N] [STRAIN] [STEP] [SHAPE] [DX DY]\n");
    return 2;
  }
  const int n = count > 4 ? std::atoi(words[4]) : 8;
  const double strain = count > 5 ? std::atof(words[5]) : 4, step = count > 6 ? std::atof(words[6]) : 0.01;
  Capsule c{geodesic_sphere(n), {}, words[1], std::atof(words[2]), std::atof(words[3]), {}, {}};
  if (shape == "biconcave") make_biconcave(c.mesh.x);
  const std::size_t of_one = c.mesh.triangles.size();
  const bool pair = count > 9;
  if (pair) add_second(c.mesh, {std::atof(words[8]), std::atof(words[9]), 0});
  const auto triangles = [&](int which) { return std::span(c.mesh.triangles).subspan(which * of_one, of_one); };
  c.rest = c.mesh.x;
  Field x = c.rest, u(x.size(), Vec::Zero());
  for (std::size_t i = 0; i < x.size(); ++i) u[i] = Vec(x[i].y(), 0, 0);
  const double volume = shape_of(triangles(0), x).volume;
  const long steps = std::lround(strain / step), every = std::max(1L, std::lround(0.05 / step));
  for (long s = 0; s <= steps; ++s) {
    if (s % every == 0 || s == steps) {
      const Shape now = shape_of(triangles(0), x);
      std::printf("%.3f %.5f %.4f %.6f", static_cast<double>(s) * step, now.deformation, now.angle,
                  now.volume / volume);
      if (pair) {
        const Vec apart = shape_of(triangles(1), x).centroid - now.centroid;
        std::printf(" %.5f %.5f %.4f", apart.x(), apart.y(), least_distance(c.mesh, x));
      }
      std::puts("");
      std::fflush(stdout);
    }
    u = c.velocity(x, u);
    Field half = x;
    for (std::size_t i = 0; i < x.size(); ++i) half[i] += step / 2 * u[i];
    u = c.velocity(half, u);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += step * u[i];
  }
}
