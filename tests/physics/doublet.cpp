// Two cells that stick together, at rest: when the contact between them stops being flat. No fluid: least energy of
// membranes and contact.
#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <iostream>
#include <memory>
#include <numbers>

#include "core/contact/interactions.hpp"
#include "minimise.hpp"
#include "scene_run.hpp"
#include "unit/contact/surface_fixture.hpp"
#include "unit/surface/fixture.hpp"

using namespace rouleau;
using namespace rouleau::test;

namespace {

/// The Morse potential: where it is least, over what distance it falls off, and where it ends.
struct MorseWell {
  double distance, range, cutoff;
};

class Doublet {
 public:
  /// Two cells of a shape, side by side along y and bent into an S by a share of their radius.
  Doublet(const core::TriangleSurface& shape, MembraneLaws laws, MorseWell well, double bent)
      : well_(well), cells_(side_by_side(shape, well, bent)), membranes_(cells_, {std::move(laws)}) {}

  /// Goes downhill, `depth` being the energy per area of the contact, by steps that move no node farther than `longest`
  /// cells' widths: long ones leave shallow minima.
  void relax(double depth, int most_steps, double longest) {
    depth_ = depth;
    contacts_ = std::make_unique<core::Interactions<3>>(
        cells_, std::vector<core::Interaction>{{{0, 0}, morse(depth, 1 / well_.range, well_.distance, well_.cutoff)}},
        core::Domain<3>{{box, box, box}, {false, false, false}});
    Eigen::VectorXd place = place_of(cells_);
    minimise(place, {1e-4 * depth, longest * std::cbrt(cells_.types[0]->rest_volume), 1e-9, most_steps, 1e-7},
             [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) { return energy(at, gradient); });
  }

  /// Of the flat disc that would win as much energy.
  [[nodiscard]] double contact_radius() const {
    return std::sqrt(-contacts_->energy(cells_) / depth_ / std::numbers::pi);
  }
  [[nodiscard]] double membrane_energy() { return membranes_.energy(cells_); }

  /// How far the first cell's face, as far as more than half of the well holds it, is from the plane nearest to it.
  struct Face {
    double rms;
    double sigmoid;  ///< share of its square that terms of third degree in the plane take, odd on turning half around
    double bulge;    ///< and those of second degree
  };
  [[nodiscard]] Face face() const {
    std::vector<core::TriangleContact> contacts;
    contacts_->contacts().find(0, cells_, contacts);
    const double reach = well_.distance - well_.range * std::log(1 - std::sqrt(0.5));
    std::erase_if(contacts, [&](const core::TriangleContact& contact) { return contact.distance > reach; });
    const auto count = static_cast<Eigen::Index>(contacts.size());
    Eigen::MatrixXd terms(count, 10);  // 3 of the plane, 3 even, 4 odd
    Eigen::VectorXd height(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const int i = contacts[k].node;
      const double x = cells_.position[0][i] - box / 2.0, z = cells_.position[2][i] - box / 2.0;
      height[k] = cells_.position[1][i];
      terms.row(k) << 1, x, z, x * x + z * z, x * x - z * z, 2 * x * z, x * (x * x + z * z), z * (x * x + z * z),
          x * (x * x - 3 * z * z), z * (3 * x * x - z * z);
    }
    const auto left_by = [&](const Eigen::MatrixXd& basis) {
      return (height - basis * basis.colPivHouseholderQr().solve(height)).squaredNorm();
    };
    Eigen::MatrixXd odd(count, 7);
    odd << terms.leftCols(3), terms.rightCols(4);
    const double all = left_by(terms.leftCols(3));
    return {std::sqrt(all / static_cast<double>(count)), 1 - left_by(odd) / all, 1 - left_by(terms.leftCols(6)) / all};
  }

 private:
  static constexpr int box = 100;

  static Surfaces side_by_side(const core::TriangleSurface& shape, MorseWell well, double bent) {
    Surfaces cells;
    cells.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(shape)));
    const RestSurface& rest = *cells.types[0];
    const double top = *std::max_element(rest.y.begin(), rest.y.end()),
                 radius = *std::max_element(rest.x.begin(), rest.x.end());
    for (const int side : {-1, 1})
      add_cell(cells, 0, {box / 2.0, box / 2.0 + side * (top + well.distance / 2), box / 2.0});
    for (int i = 0; i < cells.node_count(); ++i)
      cells.position[1][i] += bent * radius * std::sin(std::numbers::pi * (cells.position[0][i] - box / 2.0) / radius);
    return cells;
  }

  double energy(const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
    move_to(at, cells_);
    gradient.setZero(at.size());
    rouleau::test::run(*contacts_, cells_);
    add_gradient(cells_, gradient);
    membranes_.run({}, cells_);
    add_gradient(cells_, gradient);
    return membranes_.energy(cells_) + contacts_->energy(cells_);
  }

  MorseWell well_;
  Surfaces cells_;
  core::SurfaceForces membranes_;
  std::unique_ptr<core::Interactions<3>> contacts_;
  double depth_ = 0;
};

/// Vesicles of bending modulus 1 and the area of a sphere of radius `size`: a membrane that resists shear as little as
/// keeps its mesh in shape. `volume`: over that sphere's. `adhesion`: depth size^2/kappa.
class Vesicles {
 public:
  static constexpr double size = 10;
  Vesicles(int n, double volume, double range) : Vesicles(disc(n), volume, range) {}
  void relax(double adhesion, int most_steps = 3000) { doublet_.relax(adhesion / (size * size), most_steps, 0.01); }
  [[nodiscard]] double contact_radius() const { return doublet_.contact_radius() / size; }
  [[nodiscard]] double bending() { return doublet_.membrane_energy() / (16 * std::numbers::pi); }  // over two spheres'
  [[nodiscard]] Doublet::Face face() const {
    Doublet::Face found = doublet_.face();
    found.rms /= size;
    return found;
  }

 private:
  Vesicles(const core::TriangleSurface& shape, double volume, double range)
      : doublet_(shape, laws(core::rest_surface(shape).rest_volume, volume), {2 * range, range, 14 * range}, 0.05) {}
  static core::TriangleSurface disc(int n) {
    core::TriangleSurface disc = core::biconcave_disc(n, 1);
    const double scale = size * std::sqrt(4 * std::numbers::pi / core::rest_surface(disc).rest_surface_area);
    for (Vec<3>& node : disc.nodes) node *= scale;
    return disc;
  }
  static MembraneLaws laws(double rest_volume, double volume) {
    const double sphere = 4 * std::numbers::pi / 3 * size * size * size, unit = 1 / (size * size);
    return {surface_law("bending", {1, 1, 0}), surface_law("skalak", {unit, 1000, 0}),
            surface_law("volume", {1e4 * unit / size, volume * sphere / rest_volume}),
            surface_law("surface-area", {1e4 * unit, 1, 0})};
  }
  Doublet doublet_;
};

/// Between which adhesions a flat contact is stable against an S, where contacts have no thickness.
std::array<double, 2> flat_between(double volume) {
  const nlohmann::json reference = read_reference("vesicle_doublets.json");
  for (const auto& row : reference["stable"])
    if (row["volume"] == volume) return {row["from"], row["to"]};
  FAIL("no such volume");
  return {};
}

/// Of a contact that was bent at first, with a well R/30 wide.
Doublet::Face face_at_rest(double volume, double adhesion) {
  Vesicles vesicles(12, volume, Vesicles::size / 30);
  vesicles.relax(adhesion);
  return vesicles.face();
}

void check_flat(double volume, double adhesion) {
  CAPTURE(volume, adhesion);
  CHECK(face_at_rest(volume, adhesion).rms < 0.01);
}

void check_sigmoid(double volume, double adhesion) {
  const Doublet::Face face = face_at_rest(volume, adhesion);
  CAPTURE(volume, adhesion, face.rms);
  CHECK(face.rms > 0.1);
  CHECK(face.sigmoid > 0.7);
  CHECK(face.bulge < 0.05);
}

}  // namespace

// Those of the theory have no thickness. A well R/30 wide holds the rim, too, and with it the disc: at volume 0.65 it
// bends from an adhesion of 24 to 26 on, with a well of R/60 from 20 to 22 on ("contacts of vesicles over adhesion").
TEST_CASE("the contact of vesicles is flat or sigmoid where theory says, volume 0.65", "[doublet]") {
  check_flat(0.65, 0.85 * flat_between(0.65)[1]);
  check_sigmoid(0.65, 1.5 * flat_between(0.65)[1]);
}
TEST_CASE("the contact of vesicles is flat or sigmoid where theory says, volumes 0.6 and 0.75", "[doublet]") {
  check_flat(0.6, 0.8 * flat_between(0.6)[1]);
  check_sigmoid(0.6, 1.7 * flat_between(0.6)[1]);
  REQUIRE(flat_between(0.75)[1] > 40);
  check_flat(0.75, 1.7 * flat_between(0.6)[1]);  // what bends the disc of thinner vesicles
}

TEST_CASE("the flat contact of vesicles tends to the theory's as the well gets narrow", "[doublet]") {
  // The membranes part at the rim like their curvature's parabola, so that a well of width w holds an annulus of width
  // ~ sqrt(w).
  const nlohmann::json exact = read_reference("vesicle_doublets.json")["shapes"][0];
  double radius[2], bending[2];
  for (int k = 0; k < 2; ++k) {
    Vesicles vesicles(k == 0 ? 12 : 17, exact["volume"], Vesicles::size / (30 << k));
    vesicles.relax(exact["adhesion"]);
    radius[k] = vesicles.contact_radius(), bending[k] = vesicles.bending();
    std::cout << "well R/" << (30 << k) << ": contact radius " << radius[k] << ", bending " << bending[k] << '\n';
  }
  const double disc = exact["disc_radius"];
  const auto narrow = [](const double(&of)[2]) { return of[1] + (of[1] - of[0]) / (std::numbers::sqrt2 - 1); };
  CHECK(radius[1] - disc < 0.75 * (radius[0] - disc));
  CHECK(narrow(radius) == Approx(disc).epsilon(0.02));
  CHECK(narrow(bending) == Approx(exact["bending_over_sphere"].get<double>()).epsilon(0.01));
}

TEST_CASE("contacts of vesicles over adhesion", "[.doublet_scan]") {
  for (const auto& [nodes, part] : {std::pair{12, 30}, {17, 60}}) {
    for (double adhesion = 16; adhesion <= 30; adhesion += 2) {
      Vesicles vesicles(nodes, 0.65, Vesicles::size / part);
      vesicles.relax(adhesion, 6000);
      const Doublet::Face face = vesicles.face();
      std::cout << "well R/" << part << ", adhesion " << adhesion << ": contact radius " << vesicles.contact_radius()
                << ", off the plane " << face.rms << ", sigmoid " << face.sigmoid << ", bulge " << face.bulge << '\n';
    }
  }
}

TEST_CASE("contacts of red cells over depth", "[.doublet_scan]") {
  // The cells of scenes/doublet-3d.json: lengths in um, forces in pN, so that 1e-6 J/m2 are 1. There are minima beside
  // the least one: each depth is tried from straight cells, from bent ones, and from where the next larger depth left
  // those.
  const MembraneLaws laws = {surface_law("skalak", {5, 10, 0}), surface_law("bending", {0.36, 0, 0}),
                             surface_law("volume", {1e4, 1})};
  const core::TriangleSurface shape = core::biconcave_disc(12, 3.91);
  constexpr MorseWell well{0.49, 1 / 3.84, 1.5};
  const auto relax = [](Doublet& cells, double depth, const std::string& begun) {
    cells.relax(depth, 4000, 0.05);
    const Doublet::Face face = cells.face();
    const double contact = std::numbers::pi * std::pow(cells.contact_radius(), 2);
    std::cout << depth << "e-6 J/m2, begun " << begun << ": contact " << contact << " um2, energy "
              << cells.membrane_energy() - depth * contact << "e-18 J, off the plane " << face.rms << " um, sigmoid "
              << face.sigmoid << ", bulge " << face.bulge << std::endl;
  };
  Doublet from_stronger(shape, laws, well, 0.06);
  for (const double depth : {2.4, 1.0, 0.5, 0.2, 0.1}) {
    Doublet straight(shape, laws, well, 0), bent(shape, laws, well, 0.06);
    relax(straight, depth, "straight");
    relax(bent, depth, "bent");
    relax(from_stronger, depth, "from the stronger one");
  }
}
