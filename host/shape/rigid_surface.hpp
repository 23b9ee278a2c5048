// The surface of a cell as a rigid body that can be turned and scaled, and whether two of them keep a distance.
#pragma once

#include <array>
#include <vector>

#include "crowding.hpp"
#include "rigid_body.hpp"
#include "scene/scene.hpp"

namespace rouleau::shape {

/// A closed surface of triangles about the origin as it is at angle 0, in a unit of length of the caller's choice.
class RigidSurface {
 public:
  static constexpr int dimension = 3;
  struct Orientation {
    std::array<Place<3>, 3> rows;  ///< of the matrix that turns
    Place<3> axis;                 ///< what the y axis is turned to
    std::uint32_t angle;           ///< about it
  };
  /// Uniform: of the axis on the sphere, and of the angle.
  static Orientation drawn(RandomNumbers& numbers);
  /// Axis and angle turned at random by a part `most` of a whole turn at most. The way back is as likely.
  static Orientation turned(const Orientation& from, double most, RandomNumbers& numbers);
  static Orientation of(const scene::CellPlacement& cell);
  static void put(const Orientation& orientation, scene::CellPlacement& cell);

  /// Surface of a cell type with its triangles, for gaps of at least `gap`.
  RigidSurface(const scene::CellType& type, double unit, double gap);

  [[nodiscard]] const std::vector<Place<3>>& nodes() const { return nodes_; }
  [[nodiscard]] double radius() const { return radius_; }  ///< of the sphere about the origin that holds it
  [[nodiscard]] double content() const { return volume_; }
  /// By how much two surfaces may be nearer to each other than keep_apart() is asked for.
  [[nodiscard]] double allowance() const { return allowance_; }
  /// Points of the surface, nodes among them.
  [[nodiscard]] const std::vector<Place<3>>& samples() const { return samples_; }
  [[nodiscard]] const BallTree& sample_tree() const { return sample_tree_; }
  /// What lies between samples: allowance() has it.
  [[nodiscard]] double between_samples(double /*gap*/) const { return 0; }
  /// Whether keeps(sample, 0) holds for all samples; those in a ball for which keeps(center, radius) holds are not
  /// asked.
  template <class Keeps>
  [[nodiscard]] bool all_samples(const Keeps& keeps) const {
    return sample_tree_.all(keeps, [&](int item) { return keeps(samples_[item], 0.0); });
  }

  /// Whether a point lies outside and at least that far from the surface, from a map of distances where that suffices,
  /// else from the triangles. A point outside that is as near as the map is coarse may be denied.
  [[nodiscard]] bool keeps(const Place<3>& point, double least) const;
  /// The same by the map alone: false where that does not suffice.
  [[nodiscard]] bool surely_keeps(const Place<3>& point, double least) const;

 private:
  [[nodiscard]] double distance(const Place<3>& point, double at_most) const;
  /// Distance in the middle of the map's cube that holds the point, negative inside; none where there is no map.
  [[nodiscard]] const float* mapped(const Place<3>& point) const;
  void make_samples(double gap);
  void make_map();

  std::vector<Place<3>> nodes_, samples_;
  std::vector<std::array<int, 3>> triangles_;
  BallTree sample_tree_, triangle_tree_;
  double radius_ = 0, volume_ = 0, allowance_ = 0;
  std::array<int, 3> count_{};
  Place<3> least_{}, most_{}, lower_{};  ///< corners of the box around the surface; lower one of the map
  double step_ = 0, half_diagonal_ = 0;
  std::vector<float> map_;
};

/// A point of the surface as it lies from the centre of a body of size 1.
Place<3> rotated(const RigidSurface::Orientation& orientation, const Place<3>& point);

/// Whether a body lies around a point, given as it lies from the body's centre, or nearly so: a point as near to the
/// surface as the map is coarse may be taken for one inside.
bool encloses(const RigidBody<RigidSurface>& body, const Place<3>& point);

/// Whether the surfaces of two bodies, the second moved by `shift`, keep the distance `gap` (above 0), up to their
/// allowance, and none lies in the other.
bool keep_apart(const RigidBody<RigidSurface>& a, const RigidBody<RigidSurface>& b, const Place<3>& shift, double gap);

}  // namespace rouleau::shape
