// Forces between cells and walls: potentials integrated over the part of a membrane that is near a wall.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "base/worker.hpp"
#include "contact_law.hpp"
#include "core/domain/domain.hpp"
#include "core/domain/ranks.hpp"
#include "core/domain/vec.hpp"
#include "core/geometry/near_border.hpp"
#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"

namespace rouleau::core {

/// A wall as a potential sees it: how far a place is from it, infinitely where it is for certain too far to matter, and
/// which way leads away from it.
template <int D>
struct Wall {
  int axis;                      ///< that a plane lies across; 0: what closes a region
  double place = 0, inward = 0;  ///< of a plane: along its axis; 1 where the fluid lies above it, -1 below
  std::shared_ptr<const NearBorder<D>> border = {};

  [[nodiscard]] Distance<D> operator()(const Vec<D>& at) const {
    if (axis == 0) return border->at(at).value_or(Distance<D>{INFINITY, Vec<D>::Zero()});
    return {inward * (at[axis] - place), inward * Vec<D>::Unit(axis)};
  }
};

/// Node i with rest measure w (in two dimensions a length, in three an area) at distance r of a wall: energy w phi(r),
/// force w f(r) away from the wall. At a contact of two cells the weight is w/2, for each of the two has nodes; a wall
/// has none, so that a membrane's own count whole (docs: physics, interaction). Walls lie across the axes that are not
/// periodic, each of its own; what closes a region is one wall with those planes: the nearest place of all counts.
/// Walls take the reaction, normal to themselves.
template <int D>
class WallContacts {
 public:
  using Cells = std::conditional_t<D == 2, Membranes, Surfaces>;

  /// Adds what potentials remember to `cells.wall_contacts`, as far as it is not there from an earlier stage.
  /// `region`: in which the fluid is, beside the domain's walls; null: all. Throws std::invalid_argument without walls,
  /// and for potentials that read how surfaces slide.
  WallContacts(Cells& cells, const std::vector<WallInteraction>& interactions, const Domain<D>& domain,
               RegionPointer<D> region = {});

  /// Before a step: so many after the setup's start.
  void set_time(double time) {
    for (OfType& of_type : laws_) of_type.law.set_time(time);
  }
  /// Pass over cells: adds to the forces, and advances the state of the contacts by one step.
  void run(Worker worker, Cells& cells) const;

  /// Energy at the present positions, of all ranks' cells. Not a pass.
  [[nodiscard]] double energy(const Cells& cells, const Ranks<D>& ranks = {}) const;
  /// What the walls together do to all cells, along an axis. Not a pass.
  [[nodiscard]] double net_force(const Cells& cells, const Ranks<D>& ranks = {}, int axis = 1) const;
  /// A potential that acts but tells no energy; empty: none.
  [[nodiscard]] std::string without_energy() const;

 private:
  /// Nodes of a cell within a cutoff of one wall, the direction away from it, and the potential's force or energy.
  struct Contacts {
    std::vector<int> node;
    std::vector<Vec<D>> away;
    ContactValues values;
    std::vector<double> law;
  };
  void find(const ContactLaw& law, int cell, int wall, const Cells& cells, Contacts& contacts) const;
  /// Calls act(node, weight, i) for the contacts i of a cell with all walls by all laws that act on it, when
  /// their force, or energy, is known. `next`: as ContactLaw has it.
  template <class Act>
  void for_each(int cell, const Cells& cells, bool energy, std::vector<ContactState>* next, Contacts& contacts,
                Act act) const;
  template <class Value>
  double sum_over(const Cells& cells, bool energy, const Ranks<D>& ranks, Value value) const;

  struct OfType {
    int type;
    ContactLaw law;
  };
  std::vector<OfType> laws_;
  bool remembers_ = false;
  std::vector<Wall<D>> walls_;
};

/// A node of a cell that has gone through what closes a region.
struct BeyondWall {
  int cell, node;
  double depth;  ///< spacings
};
/// Of this rank's cells the first one with such a node, and its deepest one. `border`: with any reach.
template <int D>
std::optional<BeyondWall> find_beyond_wall(const CellNodes& cells, const NearBorder<D>& border);

extern template class WallContacts<2>;
extern template class WallContacts<3>;

}  // namespace rouleau::core
