// Forces between cells and walls in three dimensions: potentials integrated over the part of a surface that is near a wall.
#pragma once

#include <string>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/ranks.hpp"
#include "core/surface/surfaces.hpp"
#include "wall_contacts.hpp"

namespace rouleau::core {

/// Node i with rest area A at distance r of a wall: energy A phi(r), force A f(r) away from the wall (WallContacts, in two
/// dimensions). Walls lie across y and z. The wall takes the reaction, normal to itself.
class SurfaceWallContacts {
 public:
  /// Throws std::invalid_argument without walls, and for potentials of more than the distance.
  SurfaceWallContacts(std::vector<WallInteraction> interactions, const Domain<3>& domain);

  /// Pass over cells: adds to the forces. A cell that no wall is near of costs a look at where its nodes lie.
  void run(Worker worker, Surfaces& surfaces);

  /// Energy at the present positions. Not a pass.
  [[nodiscard]] double energy(const Surfaces& surfaces, const Ranks<3>& ranks = {}) const;
  /// What the walls across y together do to all cells, along y. Not a pass.
  [[nodiscard]] double net_force(const Surfaces& surfaces) const;
  /// A potential that acts but tells no energy; empty: none.
  [[nodiscard]] std::string without_energy() const;

 private:
  struct Wall {
    int axis;
    double place, outward;  ///< of its surface; 1 where the fluid lies above it, -1 below
  };
  /// Nodes of a cell within a cutoff of one wall, and the potential's force or energy for each.
  struct Contacts {
    std::vector<int> node;
    std::vector<double> distance, law;
  };
  void measure(std::size_t interaction, int cell, const Wall& wall, const Surfaces& surfaces, bool energy,
               Contacts& contacts) const;
  /// Calls act(cell, wall, contacts) for each interaction of a range of cells with each wall.
  template <class Act>
  void for_each(Range cells, const Surfaces& surfaces, bool energy, Contacts& contacts, Act act) const;

  std::vector<WallInteraction> interactions_;
  std::vector<double> cutoffs_;
  std::vector<Wall> walls_;
};

}  // namespace rouleau::core
