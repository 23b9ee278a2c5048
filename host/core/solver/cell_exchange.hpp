// What ranks tell each other of their cells.
#pragma once

#include <array>
#include <functional>
#include <type_traits>
#include <vector>

#include "core/contact/interaction_forces.hpp"
#include "core/contact/surface_interactions.hpp"
#include "core/membrane/displacement_watch.hpp"
#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"
#include "ghost_cells.hpp"

namespace rouleau::core {

/// The messages of a step about cells, and those with which all ranks get to know everything of all of them. Each call is
/// one worker's, between two barriers, and all ranks make the same calls.
template <int D>
class CellExchange {
 public:
  using Cells = std::conditional_t<D == 2, Membranes, Surfaces>;
  using Interactions = std::conditional_t<D == 2, InteractionForces, SurfaceInteractions>;

  /// Sets what this rank's part in the cells is, all of which it knows to begin with. `owner`: empty: by place.
  /// `velocities`: ghosts' are wanted, too.
  CellExchange(const Ranks<D>& ranks, Cells& cells, std::vector<int> owner, GhostReach reach, bool velocities);

  /// After the nodes have moved: what owners have found of them, then positions and largest steps of ghosts. Sets whether
  /// lists of cells that act on each other are out of date, if there are such lists (null: none), and returns whether a
  /// node has left the domain, on any rank. New ghosts come with what the viscosity's watch remembers of them, and cells
  /// that change hands with all that is known of them.
  bool share_positions(Cells& cells, DisplacementWatch& viscosity, DisplacementWatch* lists, bool escaped);
  /// Whether the last share_positions() has given this rank cells that it did not own before.
  [[nodiscard]] bool took_over() const { return took_over_; }
  // Messages in two halves, with no other message between them.
  /// The reactions of potentials, to the owners of the cells that they act on.
  void send_reactions(Interactions& interactions) const;
  void receive_reactions(const Cells& cells, Interactions& interactions) const;
  /// A component along each axis for every node, to those whose blocks it may reach.
  void send_forces(const Cells& cells, const std::array<double*, D>& force) const;
  void receive_forces(const Cells& cells, const std::array<double*, D>& force) const;
  /// Velocities from the ranks that have interpolated them to the owners. `base(node)`: the node of the lattice below a
  /// node, whose rank is the one.
  using Base = std::function<std::array<int, D>(int node)>;
  void send_velocities(Cells& cells, const Base& base) const;
  void receive_velocities(Cells& cells, const Base& base) const;
  /// All of all cells, to all ranks: positions, velocities, forces, what laws and potentials remember, leaked areas, and
  /// the watch's memory. Until the next share_positions() every rank knows every cell.
  void share_state(Cells& cells, DisplacementWatch& watch) const;

 private:
  class Packer;
  class Unpacker;
  using Vectors = std::array<std::vector<double>*, D>;
  static Vectors places(Cells& cells);
  static Vectors velocities(Cells& cells);
  static Vectors forces(Cells& cells);
  void set_parts(Cells& cells) const;
  [[nodiscard]] std::vector<BoundingBox<D>> boxes_of_all(const Cells& cells) const;
  template <class Message>
  static void transfer_forces(const Cells& cells, const std::array<double*, D>& force, const std::vector<int>& of_peer,
                              Message& message);
  template <class Message>
  void transfer_velocities(Cells& cells, const Base& base, int reader, const std::vector<int>& of_peer,
                           Message& message) const;
  /// All that a step wants to know of one cell.
  template <class Transfer>
  void transfer_motion(Cells& cells, int cell, Transfer transfer) const;
  template <class Transfer>
  static void transfer_memory(Cells& cells, DisplacementWatch& watch, int cell, Transfer transfer);
  template <class Transfer>
  static void transfer_state(Cells& cells, int cell, Transfer transfer);
  /// All that there is.
  template <class Transfer>
  static void transfer_cell(Cells& cells, DisplacementWatch& watch, int cell, Transfer transfer);
  void hand_over(Cells& cells, DisplacementWatch& viscosity, const std::vector<BoundingBox<D>>& boxes);

  Ranks<D> ranks_;
  GhostCells<D> ghosts_;
  bool velocities_;
  bool took_over_ = false;
  std::vector<double> path_;  // of this rank's cells since boxes were compared: no node has a longer one
};

extern template class CellExchange<2>;
extern template class CellExchange<3>;

}  // namespace rouleau::core
