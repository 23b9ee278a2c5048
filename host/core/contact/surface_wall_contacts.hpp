// Forces between cells and walls in three dimensions: potentials integrated over the part of a surface that is near a wall.
#pragma once

#include <string>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/ranks.hpp"
#include "core/surface/surfaces.hpp"
#include "surface_law.hpp"
#include "wall_contacts.hpp"

namespace rouleau::core {

/// Node i with rest area A at distance r of a wall: energy A phi(r), force A f(r) away from the wall (WallContacts, in two
/// dimensions). Walls lie across y and z, or are a tube along x around the middle of the domain. The wall takes the reaction, normal to itself.
class SurfaceWallContacts {
 public:
  /// Adds what potentials remember to `surfaces.wall_contacts`, as far as it is not there from an earlier stage. tube_radius:
  /// in place of the domain's walls; 0: none. Throws std::invalid_argument without walls, and for potentials that read how
  /// surfaces slide.
  SurfaceWallContacts(Surfaces& surfaces, const std::vector<WallInteraction>& interactions, const Domain<3>& domain,
                      double tube_radius = 0);

  /// Pass over cells: adds to the forces, and advances the state of the contacts by one step. A cell that no wall is near of
  /// costs a look at where its nodes lie.
  void run(Worker worker, Surfaces& surfaces);

  /// Energy at the present positions, of all ranks' cells. Not a pass.
  [[nodiscard]] double energy(const Surfaces& surfaces, const Ranks<3>& ranks = {}) const;
  /// What the walls together do to all cells, along y or z. Not a pass.
  [[nodiscard]] double net_force(const Surfaces& surfaces, const Ranks<3>& ranks = {}, int axis = 1) const;
  /// A potential that acts but tells no energy; empty: none.
  [[nodiscard]] std::string without_energy() const;

 private:
  struct Wall {
    int axis;               ///< that it lies across; 0: a tube
    double place, outward;  ///< of its surface; 1 where the fluid lies above it, -1 below. Of a tube: its radius
  };
  /// Nodes of a cell within a cutoff of one wall, the direction away from it, and the potential's force or energy.
  struct Contacts {
    std::vector<int> node;
    std::vector<double> away_y, away_z, law;
    SurfaceLawInputs inputs;
  };
  /// `next`: as SurfaceLaw has it.
  void measure(const SurfaceLaw& law, int cell, int wall, const Surfaces& surfaces, bool energy,
               std::vector<ContactState>* next, Contacts& contacts) const;
  /// Calls act() for each interaction of a cell with each wall, if there are contacts.
  template <class Act>
  void for_each(int cell, const Surfaces& surfaces, bool energy, std::vector<ContactState>* next, Contacts& contacts,
                Act act) const;
  template <class Value>
  double sum_over(const Surfaces& surfaces, bool energy, const Ranks<3>& ranks, Value value) const;

  struct OfType {
    int type;
    SurfaceLaw law;
  };
  std::vector<OfType> laws_;
  bool remembers_ = false;
  std::vector<Wall> walls_;
  double middle_[2];  ///< of the domain, along y and z
};

}  // namespace rouleau::core
