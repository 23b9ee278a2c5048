#include "section.hpp"

#include <Eigen/SparseLU>
#include <stdexcept>

namespace rouleau::core {

namespace {

/// The equations of the fluid nodes of a section: -(second derivatives of u) = force, u the walls' velocity at walls.
template <int D>
class SectionEquations {
 public:
  SectionEquations(const Domain<D>& domain, const SolidNodes<D>* solid, const WallVelocity& walls, int place)
      : domain_(domain), nodes_(domain), solid_(solid), walls_(walls), place_(place) {
    for (int i = 0; i < nodes_.count(); ++i) {
      number_.push_back(is_solid(node_of(i)) ? -1 : count_);
      count_ += number_.back() >= 0 ? 1 : 0;
    }
    of_walls_ = Eigen::VectorXd::Zero(count_);
    for (int i = 0; i < nodes_.count(); ++i)
      if (number_[static_cast<std::size_t>(i)] >= 0) add(i);
    if (!walled_) return;
    Eigen::SparseMatrix<double> matrix(count_, count_);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    factors_.compute(matrix);
    if (factors_.info() != Eigen::Success) throw std::runtime_error("the flow through a section was not found");
  }

  [[nodiscard]] Section solve() const {
    if (count_ == 0) throw std::invalid_argument("an opening leads into a wall: its section has no fluid");
    Eigen::VectorXd driven = Eigen::VectorXd::Constant(count_, INFINITY), dragged = of_walls_;
    if (walled_) driven = factors_.solve(Eigen::VectorXd::Ones(count_)), dragged = factors_.solve(of_walls_);
    Section section{.driven = {}, .dragged = {}, .mean_driven = driven.mean(), .mean_dragged = dragged.mean()};
    for (const int number : number_) {
      section.driven.push_back(number < 0 ? 0 : driven[number]);
      section.dragged.push_back(number < 0 ? 0 : dragged[number]);
    }
    return section;
  }

 private:
  using Node = std::array<int, D>;
  [[nodiscard]] Node node_of(int i) const { return nodes_.node(i, place_); }
  [[nodiscard]] bool is_solid(const Node& node) const { return solid_ != nullptr && solid_->at(node); }

  /// What lies beside a node: another one, or a wall at a share of the link.
  struct Beside {
    int node = -1;
    double share = 1, speed = 0;
  };
  [[nodiscard]] Beside beside(Node node, int axis, int way) const {
    constexpr double half_way = 0.5;  // to a plane at the domain's end
    Node to{};
    to[axis] = way;
    const int place = domain_.wrapped(axis, node[axis] + way);
    const double cut = solid_ != nullptr ? solid_->cut(node, to) : half_way;
    if (place < 0 && cut < half_way) return {.share = cut};
    if (place < 0) return {.share = half_way, .speed = axis != 1 ? 0 : way < 0 ? walls_.lower : walls_.upper};
    node[axis] = place;
    if (is_solid(node)) return {.share = cut};
    return {.node = number_[nodes_.number(node)]};
  }
  void add(int i) {
    const int number = number_[static_cast<std::size_t>(i)];
    double own = 0;
    for (int axis = 0; axis < D; ++axis) {
      if (axis == nodes_.axis()) continue;
      const Beside ends[] = {beside(node_of(i), axis, -1), beside(node_of(i), axis, 1)};
      const double span = (ends[0].share + ends[1].share) / 2;
      for (const Beside& end : ends) {
        const double factor = 1 / (end.share * span);
        own += factor;
        if (end.node >= 0) {
          entries_.emplace_back(number, end.node, -factor);
        } else {
          of_walls_[number] += factor * end.speed;
          walled_ = true;
        }
      }
    }
    entries_.emplace_back(number, number, own);
  }

  Domain<D> domain_;
  SectionNodes<D> nodes_;
  const SolidNodes<D>* solid_;
  WallVelocity walls_;
  int place_;
  std::vector<int> number_;  ///< of each node among the fluid's; -1 in the solid
  int count_ = 0;
  bool walled_ = false;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::VectorXd of_walls_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factors_;
};

}  // namespace

template <int D>
Section section_at(const Domain<D>& domain, const SolidNodes<D>* solid, const WallVelocity& walls, int place) {
  return SectionEquations<D>(domain, solid, walls, place).solve();
}

template Section section_at(const Domain<2>&, const SolidNodes<2>*, const WallVelocity&, int);
template Section section_at(const Domain<3>&, const SolidNodes<3>*, const WallVelocity&, int);

template <int D>
std::vector<int> parts_of_section(const Domain<D>& domain, int end,
                                  const std::function<bool(const std::array<int, D>&)>& is_fluid) {
  constexpr int solid = -1, unknown = -2;
  const SectionNodes<D> section(domain);
  const int place = end == 0 ? 0 : domain.size[section.axis()] - 1;
  std::vector<int> part(section.count());
  for (int i = 0; i < section.count(); ++i) part[i] = is_fluid(section.node(i, place)) ? unknown : solid;
  int count = 0;
  for (int first = 0; first < section.count(); ++first) {
    if (part[first] != unknown) continue;
    std::vector<int> reached{first};
    part[first] = count;
    while (!reached.empty()) {
      const auto node = section.node(reached.back(), place);
      reached.pop_back();
      for (int way = 0; way < 2 * D; ++way) {
        auto beside = node;
        const int k = way / 2;
        if (k == section.axis()) continue;
        beside[k] = domain.wrapped(k, node[k] + (way % 2 == 0 ? 1 : -1));
        if (beside[k] < 0) continue;
        const auto there = static_cast<int>(section.number(beside));
        if (part[there] != unknown) continue;
        part[there] = count;
        reached.push_back(there);
      }
    }
    ++count;
  }
  return part;
}

template <int D>
std::array<std::vector<int>, 2> parts_of_ends(const Domain<D>& domain, const SolidNodes<D>* solid) {
  const auto is_fluid = [solid](const std::array<int, D>& node) { return solid == nullptr || !solid->at(node); };
  return {parts_of_section<D>(domain, 0, is_fluid), parts_of_section<D>(domain, 1, is_fluid)};
}

template std::array<std::vector<int>, 2> parts_of_ends(const Domain<2>&, const SolidNodes<2>*);
template std::array<std::vector<int>, 2> parts_of_ends(const Domain<3>&, const SolidNodes<3>*);
template std::vector<int> parts_of_section<2>(const Domain<2>&, int,
                                              const std::function<bool(const std::array<int, 2>&)>&);
template std::vector<int> parts_of_section<3>(const Domain<3>&, int,
                                              const std::function<bool(const std::array<int, 3>&)>&);

}  // namespace rouleau::core
