#include "cell_exchange.hpp"

#include <cstring>

#include "core/membrane/geometry.hpp"
#include "core/membrane/rounding.hpp"

namespace rouleau::core {

namespace {

class Packer {
 public:
  void put(const double* values, std::size_t count) {
    const std::size_t at = message_.size();
    message_.resize(at + count * sizeof(double));
    std::memcpy(message_.data() + at, values, count * sizeof(double));
  }
  void put(double value) { put(&value, 1); }
  [[nodiscard]] Message take() { return std::move(message_); }

 private:
  Message message_;
};

class Unpacker {
 public:
  explicit Unpacker(Message message) : message_(std::move(message)) {}
  void get(double* values, std::size_t count) {
    std::memcpy(values, message_.data() + at_, count * sizeof(double));
    at_ += count * sizeof(double);
  }

 private:
  Message message_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<int> CellExchange::owners_by_place(const Membranes& membranes, const Decomposition<2>& blocks) {
  const Domain<2> domain = blocks.domain(0);
  std::vector<int> owner;
  for (const CellRange& cell : membranes.cells) {
    const Bounds box = bounds(membranes, cell);
    const auto node = [&](int axis, double least, double most) {
      const int middle = floor_int((least + most) / 2 + 0.5);
      const int wrapped = domain.wrapped(axis, middle);
      return wrapped >= 0 ? wrapped : (middle < 0 ? 0 : domain.size[axis] - 1);
    };
    owner.push_back(box.usable() ? blocks.owner({node(0, box.x_min, box.x_max), node(1, box.y_min, box.y_max)}) : 0);
  }
  return owner;
}

template <class Function>
void CellExchange::send(Function pack) const {
  for (int to = 0; to < ranks_.blocks->ranks(); ++to) {
    if (to == rank()) continue;
    Packer packer;
    pack(to, packer);
    ranks_.transport->send(to, packer.take());
  }
}

template <class Function>
void CellExchange::receive(Function unpack) const {
  for (int from = 0; from < ranks_.blocks->ranks(); ++from) {
    if (from == rank()) continue;
    Unpacker unpacker(ranks_.transport->receive(from));
    unpack(from, unpacker);
  }
}

void CellExchange::share_positions(Membranes& membranes) const {
  std::vector<double>* const values[] = {&membranes.x, &membranes.y, &membranes.velocity_x, &membranes.velocity_y};
  send([&](int, Packer& message) {
    for (int c = 0; c < membranes.cell_count(); ++c) {
      const CellRange& cell = membranes.cells[c];
      if (owner_[c] != rank()) continue;
      for (const auto* array : values) message.put(array->data() + cell.first, static_cast<std::size_t>(cell.count));
      message.put(membranes.largest_step[c]);
    }
  });
  receive([&](int from, Unpacker& message) {
    for (int c = 0; c < membranes.cell_count(); ++c) {
      const CellRange& cell = membranes.cells[c];
      if (owner_[c] != from) continue;
      for (auto* array : values) message.get(array->data() + cell.first, static_cast<std::size_t>(cell.count));
      message.get(&membranes.largest_step[c], 1);
    }
  });
}

void CellExchange::share_reactions(InteractionForces& forces) const {
  const auto for_slices = [&](int actor, int target, auto function) {
    for (int c = 0; c < static_cast<int>(owner_.size()); ++c) {
      if (owner_[c] != actor) continue;
      forces.for_reactions(c, [&](int other, double* x, double* y, std::size_t count) {
        if (owner_[other] == target) function(x, count), function(y, count);
      });
    }
  };
  send([&](int to, Packer& message) {
    for_slices(rank(), to, [&](const double* values, std::size_t count) { message.put(values, count); });
  });
  receive([&](int from, Unpacker& message) {
    for_slices(from, rank(), [&](double* values, std::size_t count) { message.get(values, count); });
  });
}

void CellExchange::share_forces(const Membranes& membranes, double* force_x, double* force_y) const {
  const auto for_cells = [&](int of, auto function) {
    for (int c = 0; c < membranes.cell_count(); ++c) {
      if (owner_[c] != of) continue;
      const CellRange& cell = membranes.cells[c];
      for (double* force : {force_x, force_y}) function(force + cell.first, static_cast<std::size_t>(cell.count));
    }
  };
  send([&](int, Packer& message) {
    for_cells(rank(), [&](const double* values, std::size_t count) { message.put(values, count); });
  });
  receive([&](int from, Unpacker& message) {
    for_cells(from, [&](double* values, std::size_t count) { message.get(values, count); });
  });
}

void CellExchange::share_state(Membranes& membranes) const {
  const auto for_cells = [&](int of, auto& message, auto transfer) {
    for (int c = 0; c < membranes.cell_count(); ++c) {
      if (owner_[c] != of) continue;
      const CellRange& cell = membranes.cells[c];
      const auto of_nodes = [&](std::vector<double>& values) {
        transfer(message, values.data() + cell.first, static_cast<std::size_t>(cell.count));
      };
      of_nodes(membranes.force_x), of_nodes(membranes.force_y);
      for (ElementState& state : membranes.state) of_nodes(state.value);
      if (!membranes.area_leakage.empty()) transfer(message, &membranes.area_leakage[c], 1);
      for (ContactMemory* memory : {&membranes.contacts, &membranes.wall_contacts}) {
        if (memory->of_cell.empty()) continue;
        std::vector<ContactState>& contacts = memory->of_cell[c];
        double size = static_cast<double>(contacts.size());
        transfer(message, &size, 1);
        contacts.resize(static_cast<std::size_t>(size));
        for (ContactState& contact : contacts) {
          double place[4] = {static_cast<double>(contact.variable), 1.0 * contact.other, 1.0 * contact.shift.x,
                             1.0 * contact.shift.y};
          transfer(message, place, 4);
          contact.variable = static_cast<std::size_t>(place[0]);
          contact.other = static_cast<int>(place[1]);
          contact.shift = {static_cast<int>(place[2]), static_cast<int>(place[3])};
          contact.value.resize(static_cast<std::size_t>(cell.count));
          transfer(message, contact.value.data(), contact.value.size());
        }
      }
    }
  };
  send([&](int, Packer& message) {
    for_cells(rank(), message, [](Packer& to, const double* from, std::size_t count) { to.put(from, count); });
  });
  receive([&](int rank, Unpacker& message) {
    for_cells(rank, message, [](Unpacker& from, double* to, std::size_t count) { from.get(to, count); });
  });
}

void CellExchange::collect_velocities(Membranes& membranes,
                                      const std::function<std::array<int, 2>(int node)>& base) const {
  const auto for_nodes = [&](int owner, int reader, auto function) {
    const Box<2> block = ranks_.blocks->domain(reader).block;
    for (int c = 0; c < membranes.cell_count(); ++c) {
      if (owner_[c] != owner) continue;
      for (int i = membranes.cells[c].first; i < membranes.cells[c].end(); ++i) {
        if (!block.contains(base(i))) continue;
        function(&membranes.velocity_x[i]);
        function(&membranes.velocity_y[i]);
      }
    }
  };
  send([&](int to, Packer& message) { for_nodes(to, rank(), [&](const double* value) { message.put(*value); }); });
  receive([&](int from, Unpacker& message) { for_nodes(rank(), from, [&](double* value) { message.get(value, 1); }); });
}

}  // namespace rouleau::core
