// Shapes of walls, and openings: what the scene says of them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/text.hpp"
#include "driving_flow.hpp"
#include "json/json_pointer.hpp"
#include "scene_reader.hpp"

namespace rouleau::scene {
namespace {

constexpr int most_levels = 20;  // of shapes made of shapes
constexpr double endless = std::numeric_limits<double>::infinity();
constexpr AllowedRange any_length = range::unit_of_length;  // may be longer than the box

using Point = std::array<double, 2>;

std::string in_um(const Point& point) {
  return '(' + number(point[0] * 1e6) + " um, " + number(point[1] * 1e6) + " um)";
}

/// Twice the area of the triangle, positive where it runs counter-clockwise.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Of a point that lies on the line through both others.
bool is_between(const Point& point, const Point& a, const Point& b) {
  for (const int k : {0, 1})
    if (point[k] < std::min(a[k], b[k]) || point[k] > std::max(a[k], b[k])) return false;
  return true;
}

bool meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double at_c = turn(a, b, c), at_d = turn(a, b, d), at_a = turn(c, d, a), at_b = turn(c, d, b);
  const auto opposite = [](double one, double other) { return (one > 0 && other < 0) || (one < 0 && other > 0); };
  if (opposite(at_c, at_d) && opposite(at_a, at_b)) return true;
  return (at_c == 0 && is_between(c, a, b)) || (at_d == 0 && is_between(d, a, b)) ||
         (at_a == 0 && is_between(a, c, d)) || (at_b == 0 && is_between(b, c, d));
}

class ShapeReader {
 public:
  ShapeReader(const SceneFields& fields, const Domain& domain) : fields_(fields), domain_(domain) {}

  /// `inside_is_fluid`: what belongs to it is, rather than wall.
  WallShape read(const std::string& pointer, bool inside_is_fluid, int level = 1) const {
    if (level > most_levels)
      fields_.refuse(pointer, "shapes are made of shapes more than " + std::to_string(most_levels) +
                                  " levels deep\nput parts of one union into the union around it");
    WallShape shape{{}, pointer};
    const std::string below = pointer + '/';
    if (fields_.has(below + "box")) shape.is = box(below + "box");
    if (fields_.has(below + "sphere")) shape.is = sphere(below + "sphere");
    if (fields_.has(below + "cylinder")) shape.is = cylinder(below + "cylinder");
    if (fields_.has(below + "outline")) shape.is = outline(below + "outline");
    if (fields_.has(below + "mesh")) shape.is = mesh(below + "mesh");
    if (fields_.has(below + "image")) shape.is = image(below + "image", inside_is_fluid);
    using Kind = WallShape::Kind;
    for (const auto& [name, kind] : {std::pair{"intersection", Kind::all_of}, std::pair{"union", Kind::any_of},
                                     std::pair{"difference", Kind::first_without_others}})
      if (fields_.has(below + name)) shape.is = joined(below + name, kind, inside_is_fluid, level);
    return shape;
  }
  /// Of a wall that has been read, m/s.
  [[nodiscard]] double fastest() const { return fastest_; }

 private:
  /// Of a length that may be left out.
  [[nodiscard]] double end(const std::string& pointer, double otherwise) const {
    return fields_.quantity_or(pointer, "m", range::place, otherwise);
  }

  void require_rise(const std::string& pointer, double from, double to, const char* names) const {
    if (!(from >= to)) return;
    fields_.refuse(pointer, "it ends at " + number(to * 1e6) + " um and begins at " + number(from * 1e6) +
                                " um\ngive lengths that rise from " + names);
  }

  [[nodiscard]] WallShape::Box box(const std::string& pointer) const {
    WallShape::Box box{fields_.place(pointer + "/lower", domain_, "corner"),
                       fields_.place(pointer + "/upper", domain_, "corner")};
    if (fields_.has(pointer + "/velocity"))
      box.velocity = space(fields_.quantities(pointer + "/velocity", "m/s", range::velocity, domain_.dimension()));
    note_speed(box.velocity.norm());
    for (int axis = 0; axis < domain_.dimension(); ++axis)
      require_rise(json::child_pointer(pointer + "/upper", axis), box.lower[axis], box.upper[axis], "lower to upper");
    return box;
  }

  [[nodiscard]] WallShape::Sphere sphere(const std::string& pointer) const {
    WallShape::Sphere sphere{fields_.place(pointer + "/center", domain_),
                             fields_.quantity(pointer + "/radius", "m", any_length)};
    const std::string turns = pointer + "/angular_velocity";
    if (fields_.has(turns) && fields_.at(turns).is_array() == domain_.in_plane())
      fields_.refuse(turns, domain_.in_plane() ? "a disc turns in the plane\ngive one number, such as \"10 1/s\", "
                                                 "positive counter-clockwise"
                                               : "a ball turns about an axis\ngive three numbers, such as [0, 0, "
                                                 "\"10 1/s\"]");
    if (fields_.has(turns) && domain_.in_plane())
      sphere.angular_velocity.z() = fields_.quantity(turns, "1/s", range::shear_rate);
    if (fields_.has(turns) && !domain_.in_plane())
      sphere.angular_velocity = space(fields_.quantities(turns, "1/s", range::shear_rate, 3));
    note_speed(sphere.radius * sphere.angular_velocity.norm());
    return sphere;
  }

  static Eigen::Vector3d space(const Vector& vector) {
    Eigen::Vector3d made = Eigen::Vector3d::Zero();
    for (int axis = 0; axis < vector.dimension(); ++axis) made[axis] = vector[axis];
    return made;
  }
  void note_speed(double speed) const { fastest_ = std::max(fastest_, speed); }

  [[nodiscard]] WallShape::Cylinder cylinder(const std::string& pointer) const {
    if (domain_.in_plane())
      fields_.refuse_key(pointer, "a cylinder has three dimensions, and the domain two\ntake \"sphere\", here a disc");
    const auto axis = static_cast<int>(fields_.value<std::string>(pointer + "/axis")[0] - axis_names[0]);
    const Vector center = fields_.quantities(pointer + "/center", "m", range::place, 2);
    const WallShape::Cylinder cylinder{
        axis,
        {center[0], center[1]},
        fields_.quantity(pointer + "/radius", "m", any_length),
        end(pointer + "/from", -endless),
        end(pointer + "/to", endless),
        fields_.quantity_or(pointer + "/velocity", "m/s", range::velocity, 0.0),
        fields_.quantity_or(pointer + "/angular_velocity", "1/s", range::shear_rate, 0.0)};
    note_speed(std::hypot(cylinder.velocity, cylinder.radius * cylinder.angular_velocity));
    require_rise(pointer + "/to", cylinder.from, cylinder.to, "\"from\" to \"to\"");
    return cylinder;
  }

  [[nodiscard]] WallShape::Outline outline(const std::string& pointer) const {
    for (const char* key : {"/lower", "/upper"})
      if (domain_.in_plane() && fields_.has(pointer + key))
        fields_.refuse_key(pointer + key, "there is no z in two dimensions\nleave this out");
    WallShape::Outline outline{{}, end(pointer + "/lower", -endless), end(pointer + "/upper", endless)};
    require_rise(pointer + "/upper", outline.lower, outline.upper, "lower to upper");
    const std::string points = pointer + "/points";
    const std::size_t count = fields_.count(points);
    for (std::size_t i = 0; i < count; ++i) {
      const Vector point = fields_.quantities(json::child_pointer(points, i), "m", range::place, 2);
      outline.points.push_back({point[0], point[1]});
      if (!std::isfinite(point[0] + point[1])) throw Misread{};
    }
    if (outline.points.size() > 3 && outline.points.front() == outline.points.back()) outline.points.pop_back();
    check_outline(points, outline.points);
    double area = 0;
    for (const Point& point : outline.points) area += turn(outline.points[0], point, next_of(outline.points, point));
    if (area < 0) std::reverse(outline.points.begin(), outline.points.end());
    return outline;
  }

  static const Point& next_of(const std::vector<Point>& points, const Point& point) {
    return &point == &points.back() ? points.front() : *(&point + 1);
  }

  /// Refuses what crosses or touches itself.
  void check_outline(const std::string& pointer, const std::vector<Point>& points) const {
    const int count = static_cast<int>(points.size());
    const auto begin = [&](int i) -> const Point& { return points[i]; };
    const auto end = [&](int i) -> const Point& { return points[(i + 1) % count]; };
    std::vector<int> by_x(count);
    for (int i = 0; i < count; ++i) {
      by_x[i] = i;
      if (begin(i) == end(i))
        fields_.refuse(json::child_pointer(pointer, i),
                       "this point and the next are the same, " + in_um(begin(i)) + "\nleave one of them out");
    }
    const auto least = [&](int i) { return std::min(begin(i)[0], end(i)[0]); };
    std::sort(by_x.begin(), by_x.end(), [&](int a, int b) { return std::pair(least(a), a) < std::pair(least(b), b); });
    for (int a = 0; a < count; ++a) {
      const int i = by_x[a];
      const double last = std::max(begin(i)[0], end(i)[0]);
      for (int b = a + 1; b < count && least(by_x[b]) <= last; ++b) {
        const int j = by_x[b];
        const auto folds = [&](int first, int second) {  // the second side goes back along the first one
          return turn(begin(first), end(first), end(second)) == 0 &&
                 (is_between(end(second), begin(first), end(first)) ||
                  is_between(begin(first), begin(second), end(second)));
        };
        const bool wrong = (i + 1) % count == j   ? folds(i, j)
                           : (j + 1) % count == i ? folds(j, i)
                                                  : meet(begin(i), end(i), begin(j), end(j));
        if (!wrong) continue;
        const auto side = [&](int k) {
          return "point " + std::to_string(k) + ' ' + in_um(begin(k)) + " to point " + std::to_string((k + 1) % count) +
                 ' ' + in_um(end(k));
        };
        fields_.refuse(pointer, "the outline crosses or touches itself: its side from " + side(std::min(i, j)) +
                                    "\nmeets the one from " + side(std::max(i, j)) +
                                    "\ngive the corners in the order in which they follow along the border; parts "
                                    "that touch belong into a \"union\"");
      }
    }
  }

  [[nodiscard]] WallShape::Mesh mesh(const std::string& pointer) const {
    if (domain_.in_plane())
      fields_.refuse_key(pointer,
                         "a mesh has three dimensions, and the domain two\ntake an outline, or give size and nodes "
                         "three numbers");
    WallShape::Mesh mesh{fields_.file(pointer + "/file"),
                         fields_.quantity(pointer + "/unit", "m", range::unit_of_length),
                         Vector::filled(3, 0),
                         fields_.quantity_or(pointer + "/angle", "rad", range::angle, 0.0),
                         {}};
    if (fields_.has(pointer + "/at")) mesh.at = fields_.place(pointer + "/at", domain_);
    if (fields_.has(pointer + "/axis")) mesh.axis = fields_.direction(pointer + "/axis");
    return mesh;
  }

  [[nodiscard]] WallShape::Image image(const std::string& pointer, bool inside_is_fluid) const {
    const bool stack = fields_.at(pointer + "/file").is_array();
    const std::string files = pointer + "/file";
    WallShape::Image image{{},
                           fields_.quantity(pointer + "/pixel", "m", range::length),
                           0,
                           (fields_.value_or(pointer + "/fluid", std::string("light")) == "light") == inside_is_fluid,
                           Vector::filled(domain_.dimension(), 0)};
    if (stack && domain_.in_plane())
      fields_.refuse(files, "a stack of pictures has three dimensions, and the domain two\nname one file");
    for (std::size_t i = 0; stack && i < fields_.count(files); ++i)
      image.files.push_back(fields_.file(json::child_pointer(files, i)));
    if (!stack) image.files.push_back(fields_.file(files));
    if (stack && !fields_.has(pointer + "/spacing"))
      fields_.refuse(pointer, "a stack of pictures needs the length from one to the next\ngive \"spacing\"");
    if (!stack && fields_.has(pointer + "/spacing"))
      fields_.refuse_key(pointer + "/spacing", "one picture has no distance to another\nleave this out");
    image.spacing = fields_.quantity_or(pointer + "/spacing", "m", range::length, 0);
    if (fields_.has(pointer + "/at")) image.at = fields_.place(pointer + "/at", domain_);
    return image;
  }

  [[nodiscard]] WallShape::Joined joined(const std::string& pointer, WallShape::Kind kind, bool inside_is_fluid,
                                         int level) const {
    WallShape::Joined joined{kind, {}};
    const std::size_t count = fields_.count(pointer);
    for (std::size_t i = 0; i < count; ++i) {
      fields_.attempt([&] {
        const bool removed = kind == WallShape::Kind::first_without_others && i > 0;
        joined.parts.push_back(read(json::child_pointer(pointer, i), inside_is_fluid != removed, level + 1));
      });
    }
    return joined;
  }

  const SceneFields& fields_;
  const Domain& domain_;
  mutable double fastest_ = 0;
};

Feed read_feed(const SceneFields& fields, const std::string& pointer, const std::vector<CellType>& types) {
  return {.type = fields.cell_type(pointer + "/type", types),
          .hematocrit = fields.value<double>(pointer + "/hematocrit"),
          .seed = fields.value_or(pointer + "/seed", std::uint32_t{1}),
          .length = fields.quantity_or(pointer + "/length", "m", range::length, 0),
          .pointer = pointer};
}

Opening read_inlet(const SceneFields& fields, const std::string& axis, const std::vector<CellType>& types) {
  Opening inlet{.pointer = axis + "/lower/inlet"};
  const std::string velocity = inlet.pointer + "/mean_velocity", pressure = inlet.pointer + "/pressure",
                    cells = inlet.pointer + "/cells";
  const bool by_velocity = fields.has(velocity);
  if (by_velocity == fields.has(pressure)) {
    fields.refuse(inlet.pointer, by_velocity ? "an inlet is kept at a mean velocity or at a pressure, not at both\n"
                                               "leave one of the two out"
                                             : "this inlet does not say what it is kept at\ngive mean_velocity (such "
                                               "as \"1 mm/s\") or pressure (such as \"10 Pa\")");
  }
  if (by_velocity) {
    inlet.mean_velocity = fields.quantity(velocity, "m/s", range::velocity);
    fields.attempt([&] {
      if (*inlet.mean_velocity <= 0)
        fields.refuse(velocity,
                      "fluid comes in at an inlet: its mean velocity is above 0\nturn the domain round for the other "
                      "way, or give the inlet a pressure");
    });
  } else {
    inlet.pressure = fields.quantity(pressure, "Pa", range::pressure);
  }
  fields.attempt([&] {
    if (!fields.has(cells)) return;
    inlet.cells = read_feed(fields, cells, types);
  });
  return inlet;
}

}  // namespace

void read_openings(const SceneFields& fields, const std::vector<CellType>& types, Domain& domain) {
  if (!domain.is_open()) return;
  const std::string axis = std::string("/domain/") + axis_names[domain.open_axis], outlet = axis + "/upper/outlet";
  Opening upper{.pressure = fields.quantity(outlet + "/pressure", "Pa", range::pressure), .pointer = outlet};
  domain.openings = {read_inlet(fields, axis, types), std::move(upper)};
}

void check_openings(const SceneFields& fields, const Scene& scene) {
  if (!scene.domain.is_open()) return;
  const int axis = scene.domain.open_axis;
  const std::string name(1, axis_names[axis]), pointer = "/domain/" + name;
  const auto refuse_key = [&](const std::string& key, const std::string& problem) {
    fields.attempt([&] {
      if (fields.has(key)) fields.refuse_key(key, problem);
    });
  };
  refuse_key("/fluid/layers", "the flow that comes in through an opening knows of no layers\nleave the layers out");
  fields.attempt([&] {
    if (scene.fluid.body_force[axis] == 0) return;
    fields.refuse("/fluid/body_force/" + std::to_string(axis),
                  "between openings pressure and mean velocity drive the flow along " + name + "\nlet this be 0");
  });
  fields.attempt([&] {
    if (!scene.domain.openings || !scene.domain.openings->front().pressure || has_walls(scene.domain)) return;
    fields.refuse(pointer + "/lower/inlet/pressure",
                  "between two pressures a fluid without walls has nothing that could hold it\n" +
                      std::string(axis == 1 ? "put walls in its way" : "close y") +
                      ", or give the inlet a mean_velocity");
  });
  fields.attempt([&] {
    if (scene.domain.shape_speed > 0)
      fields.refuse(pointer, "the flow through openings knows of no walls of a shape that move\nlet " + name +
                                 " be periodic, "
                                 "or leave velocity and angular_velocity out of the shapes");
  });
  for (const Stage& stage : scene.stages) {
    const std::string drives =
        "between openings their pressures or velocity drive the flow, in all stages\nleave this "
        "out, and give domain." +
        name + ".lower.inlet what is wanted";
    for (const char* key : {"pressure_gradient", "mean_velocity"}) refuse_key(stage.pointer + '/' + key, drives);
    refuse_key(stage.pointer + "/oscillation",
               "openings do not oscillate, and neither does what is between them\n"
               "leave this out");
    fields.attempt([&] {
      if (axis == 2 && walls_move(stage))
        fields.refuse(stage.pointer, "these walls move along x, across what flows through the openings along " + name +
                                         "\nlet them rest, or put the openings at the ends of x");
    });
    fields.attempt([&] {
      if (stage.start == WallStart::developed)
        fields.refuse(stage.pointer + "/start",
                      "between openings no flow is known to begin with\nleave start out, and let the flow come to be");
    });
    fields.attempt([&] {
      if (!scene.domain.feed() || stage.duration || !fields.settled(stage.pointer)) return;
      fields.refuse(stage.pointer,
                    "cells come in, and how many can is not known of a stage that has no duration\ngive duration "
                    "(such as \"2 s\"), beside strain or in its place");
    });
  }
}

void read_wall_shapes(const SceneFields& fields, Domain& domain) {
  const ShapeReader reader(fields, domain);
  fields.attempt([&] {
    const std::string pointer = "/domain/walls/within";
    if (!fields.has(pointer)) return;
    for (int axis = 1; axis < domain.dimension(); ++axis)
      domain.periodic[axis] = domain.periodic[axis] && fields.has(std::string("/domain/") + axis_names[axis]);
    domain.within = reader.read(pointer, true);
  });
  const std::size_t count = fields.has("/domain/obstacles") ? fields.count("/domain/obstacles") : 0;
  for (std::size_t i = 0; i < count; ++i)
    fields.attempt(
        [&] { domain.obstacles.push_back(reader.read(json::child_pointer("/domain/obstacles", i), false)); });
  domain.shape_speed = reader.fastest();
  if (!domain.has_shapes() || domain.node_count() <= static_cast<double>(most_nodes_of_block)) return;
  fields.attempt([&] {  // every rank has a mark for each node
    fields.refuse("/domain/nodes", number(domain.node_count(), 12) +
                                       " nodes are too many between walls of any shape; "
                                       "at most " +
                                       std::to_string(most_nodes_of_block) + " can be computed");
  });
}

}  // namespace rouleau::scene
