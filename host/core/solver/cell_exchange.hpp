// What ranks tell each other of their cells.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <type_traits>
#include <vector>

#include "core/contact/interactions.hpp"
#include "core/membrane/displacement_watch.hpp"
#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"
#include "ghost_cells.hpp"
#include "schedule.hpp"

namespace rouleau::core {

/// The messages of a step about cells, and those with which cells are handed on and looked at. Each call is
/// one worker's, between two barriers, and all ranks make the same calls.
template <int D>
class CellExchange {
 public:
  using Cells = std::conditional_t<D == 2, Membranes, Surfaces>;

  /// `ghosts`: what this rank's part in the cells is. `velocities`: ghosts' are wanted, too.
  CellExchange(GhostCells<D> ghosts, bool velocities);

  /// The node of the lattice below a membrane node: the rank with this one interpolates the other's velocity.
  using Base = std::function<std::array<int, D>(int node)>;
  /// What messages are about.
  struct Parts {
    Cells& cells;
    Interactions<D>* interactions;  ///< null: none
    DisplacementWatch& viscosity;
    std::array<double*, D> force;  ///< what is spread: a component along each axis for every node
    Base base;
    std::function<bool()> escaped;  ///< whether a node of own cells has left the domain
  };
  /// Tasks of schedule.hpp that are messages about cells; nothing for others. Between the two halves of one lies no
  /// other message.
  void run(Task task, const Parts& parts);
  /// Takes positions that are still on their way, before ranks speak of something else between two steps. Other workers
  /// may have begun with the next one.
  void receive_positions(Cells& cells, DisplacementWatch& viscosity);
  /// At the last send_positions: whether a node has left the domain, on any rank.
  [[nodiscard]] bool escaped() const { return escaped_; }
  /// And whether it has given this rank cells that it did not own before.
  [[nodiscard]] bool took_over() const { return took_over_; }
  /// And whether there are cells that this rank does not know any more.
  [[nodiscard]] bool lost_sight() const { return lost_sight_; }
  /// Cells of this rank that another one is to see, and of that one's that this one is.
  struct Sight {
    std::vector<int> mine, theirs;
  };
  /// Where these cells are, by rank, and how far they moved in the last step. All ranks together.
  void show_places(Cells& cells, const std::map<int, Sight>& sights) const;
  [[nodiscard]] const GhostCells<D>& ghosts() const { return ghosts_; }
  /// The boxes of all cells as they are now, on all ranks.
  [[nodiscard]] std::vector<BoundingBox<D>> boxes_of_all(const Cells& cells) const;
  /// Hands the cells on to their next owners, and shows them, with the watch's memory, to those who have to know them
  /// then. What this rank will not know any more may be forgotten. No step can be taken after it.
  void pass_on(Cells& cells, DisplacementWatch& watch, const GhostCells<D>& next);

 private:
  /// After the nodes have moved: what owners have found of them, then positions and largest steps of ghosts. Says
  /// whether lists of cells that act on each other are out of date, if there are such lists (null: none), and whether a
  /// node has left the domain. New ghosts come with what the viscosity's watch remembers of them, and cells that change
  /// hands with all that is known of them.
  void send_positions(Cells& cells, DisplacementWatch& viscosity, DisplacementWatch* lists, bool escaped);
  /// What messages about positions are of.
  struct Shown {
    bool velocities;
    bool memory;  ///< of the viscosity's watch
  };
  template <class Message>
  static void transfer_positions(Cells& cells, DisplacementWatch& viscosity, const std::vector<int>& of_peer,
                                 Shown shown, Message& message);
  static void send_shown(const GhostCells<D>& ghosts, Cells& cells, DisplacementWatch& viscosity, Shown shown);
  static void receive_shown(const GhostCells<D>& ghosts, Cells& cells, DisplacementWatch& viscosity, Shown shown);
  /// The reactions of potentials, to the owners of the cells that they act on.
  void send_reactions(Interactions<D>& interactions) const;
  void receive_reactions(const Cells& cells, Interactions<D>& interactions) const;
  /// To those whose blocks they may reach.
  void send_forces(const Cells& cells, const std::array<double*, D>& force) const;
  void receive_forces(const Cells& cells, const std::array<double*, D>& force) const;
  /// From the ranks that have interpolated them to the owners.
  void send_velocities(Cells& cells, const Base& base) const;
  void receive_velocities(Cells& cells, const Base& base) const;
  template <class Message>
  static void transfer_forces(const Cells& cells, const std::array<double*, D>& force, const std::vector<int>& of_peer,
                              Message& message);
  template <class Message>
  void transfer_velocities(Cells& cells, const Base& base, int reader, const std::vector<int>& of_peer,
                           Message& message) const;
  void hand_over(Cells& cells, DisplacementWatch& viscosity,
                 const std::vector<typename GhostCells<D>::Handover>& handovers);

  Ranks<D> ranks_;
  GhostCells<D> ghosts_;
  bool velocities_;
  bool escaped_ = false, took_over_ = false, lost_sight_ = false;
  bool on_their_way_ = false;  // positions have been sent, and not been received
  bool with_memory_ = false;   // as those of new ghosts are
  std::vector<double> path_;   // of this rank's cells since boxes were compared: no node has a longer one
};

extern template class CellExchange<2>;
extern template class CellExchange<3>;

}  // namespace rouleau::core
