// Forces within a membrane: potentials between parts of it that are far from each other along the outline.
#pragma once

#include <string>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/ranks.hpp"
#include "core/membrane/membranes.hpp"
#include "core/model/model.hpp"

namespace rouleau::core {

/// A potential between the parts of each cell of a type.
struct SelfInteraction {
  int type;
  Potential potential;
};

/// Node i with rest weight Lb, at distance r of the closest point of those segments of its own cell that are at least
/// pi/2 cutoffs away along the outline at rest (half a circle that is a cutoff wide): energy Lb/2 phi(r), force Lb/2 f(r)
/// along the connecting line, the reaction shared by the segment's ends, as between two cells. Which segments these are
/// never changes, so that forces are the exact gradient. A flat membrane, and a round one wider than the cutoff, do
/// nothing to themselves (docs: physics, interaction).
class SelfContacts {
 public:
  /// Throws std::invalid_argument for potentials that remember, or read a velocity.
  SelfContacts(const Membranes& membranes, std::vector<SelfInteraction> interactions);

  /// Pass over cells: adds to the forces. Nothing is kept from step to step.
  void run(Worker worker, Membranes& membranes);

  /// Energy at the present positions, of all ranks' cells. Not a pass.
  [[nodiscard]] double energy(const Membranes& membranes, const Ranks<2>& ranks = {}) const;
  /// A potential that acts but tells no energy; empty: none.
  [[nodiscard]] std::string without_energy() const;

 private:
  /// Of a node: the segments that it may touch are [begin, end), counted on past the last one to the first again.
  struct Reach {
    int begin, end;
  };
  struct Kind {
    double cutoff;
    bool energy;
    std::vector<Reach> reach;  ///< of the nodes of a cell
  };
  /// Consecutive segments and a circle that holds them.
  struct Block {
    int first, end;  ///< segments
    double x, y, radius;
  };
  /// The closest allowed point to each node of a cell, then those within the cutoff.
  struct Contacts {
    std::vector<Block> blocks;
    std::vector<double> square, toward_x, toward_y, place;  ///< of the nodes; toward them from there
    std::vector<int> closest;                               ///< segment, counted in its cell
    std::vector<int> node;                                  ///< of the contacts, counted in its cell
    std::vector<double> distance, law;
    int count = 0;
  };
  void find(std::size_t interaction, int cell, const Membranes& membranes, Contacts& contacts) const;
  void measure(std::size_t interaction, int cell, const Membranes& membranes, bool energy, Contacts& contacts) const;

  std::vector<SelfInteraction> interactions_;
  std::vector<Kind> kinds_;
  WorkerScratch<Contacts> contacts_;
};

}  // namespace rouleau::core
