// Forces between cells and walls: potentials integrated over the part of a membrane that is near a wall.
#pragma once

#include <string>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/domain.hpp"
#include "core/domain/ranks.hpp"
#include "core/membrane/membranes.hpp"
#include "core/model/model.hpp"

namespace rouleau::core {

/// A potential between the cells of a type and both walls.
struct WallInteraction {
  int type;
  Potential potential;
};

/// Node i with rest weight Lb at distance r of a wall: energy Lb phi(r), force Lb f(r) away from the wall. At a contact
/// of two cells the weight is Lb/2, for each of the two has nodes; a wall has none, so that a membrane's own count whole
/// (docs: physics, interaction). The wall takes the reaction, normal to itself.
class WallContacts {
 public:
  /// Adds what potentials remember to `membranes.wall_contacts`, as far as it is not there from an earlier stage. Throws
  /// std::invalid_argument without walls, and for potentials that read how surfaces slide.
  WallContacts(Membranes& membranes, std::vector<WallInteraction> interactions, const Domain<2>& domain);

  /// Pass over cells: adds to force_y, and advances the state of the contacts by one step. A cell that no wall is near of costs a look at how high its nodes lie.
  void run(Worker worker, Membranes& membranes);

  /// Energy at the present positions, of all ranks' cells. Not a pass.
  [[nodiscard]] double energy(const Membranes& membranes, const Ranks<2>& ranks = {}) const;
  /// What both walls together do to all cells, along y: along x they do nothing. Not a pass.
  [[nodiscard]] double net_force(const Membranes& membranes, const Ranks<2>& ranks = {}) const;
  /// A potential that acts but tells no energy; empty: none.
  [[nodiscard]] std::string without_energy() const;

 private:
  /// The nodes of a cell within a cutoff of a wall, in structure of arrays; one within that of both is there twice.
  struct Contacts {
    std::vector<int> node;
    std::vector<double> distance;
    std::vector<double> outward;          // 1 at the lower wall, -1 at the upper
    std::vector<double> normal_velocity;  // d distance / dt
    std::vector<double> law;              // force or energy of the potential
    std::vector<double> state, fresh;     // of the contacts, all variables; of the cell's nodes
    int count = 0;                        // arrays may be longer
  };
  /// Of one interaction, found by asking its potential once.
  struct Traits {
    double cutoff;
    bool normal_velocity, energy;
  };
  void find(int cell, double cutoff, const Membranes& membranes, Contacts& contacts) const;
  /// The force after one step of the state, or force or energy to look at.
  enum class Wanted { step, force, energy };
  /// Finds the contacts of a cell with the walls and sets their `law` to what is wanted, `state` to what it becomes.
  void measure(std::size_t interaction, int cell, const Membranes& membranes, Wanted wanted, Contacts& contacts) const;
  void remember(std::size_t interaction, int cell, Membranes& membranes, Contacts& contacts) const;

  std::vector<WallInteraction> interactions_;
  std::vector<Traits> traits_;
  std::vector<std::vector<std::size_t>> variables_;  // of the interactions, in ContactMemory::variables
  double lower_, upper_;                             // where the walls are
  WorkerScratch<Contacts> contacts_;
};

}  // namespace rouleau::core
