#include "passages.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "core/geometry/formulas.hpp"
#include "core/geometry/region.hpp"
#include "scene/lattice.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::shape {

namespace {

using core::Vec;

/// Of the domain's size: as meshes are joined where they end (core/geometry/border.cpp), and files of single precision
/// round coordinates to less.
constexpr double one_place = 1e-6;

/// Runs of fluid nodes along x, joined to those beside them; each knows how many periods it lies from its parent.
class Pools {
 public:
  /// `at_end`: whether it begins or ends at the lower and the upper opening.
  int add(double nodes, const std::array<bool, 2>& at_end) {
    runs_.push_back({static_cast<int>(runs_.size()), 0, nodes, false, at_end});
    return static_cast<int>(runs_.size()) - 1;
  }
  /// Run b with run a, where a way from a to b goes over `periods` ends of the domain.
  void join(int a, int b, int periods) {
    const auto [of_a, at_a] = root(a);
    const auto [of_b, at_b] = root(b);
    if (of_a == of_b) {
      runs_[of_a].goes_on = runs_[of_a].goes_on || at_b != at_a + periods;
      return;
    }
    const auto [kept, gone] = std::minmax(of_a, of_b);
    const int way = at_a + periods - at_b;  // from the root of a to that of b
    runs_[gone].parent = kept;
    runs_[gone].periods = kept == of_a ? way : -way;
    runs_[kept].nodes += runs_[gone].nodes;
    runs_[kept].goes_on = runs_[kept].goes_on || runs_[gone].goes_on;
    for (const int end : {0, 1}) runs_[kept].at_end[end] = runs_[kept].at_end[end] || runs_[gone].at_end[end];
  }
  /// First run of a pool, and how many periods it is from there.
  std::pair<int, int> root(int run) {
    int last = run, all = 0;
    for (; runs_[last].parent != last; last = runs_[last].parent) all += runs_[last].periods;
    for (int at = run, left = all; runs_[at].parent != at;) {
      const int next = runs_[at].parent, periods = runs_[at].periods;
      runs_[at].parent = last, runs_[at].periods = left;
      left -= periods, at = next;
    }
    return {last, all};
  }
  [[nodiscard]] int count() const { return static_cast<int>(runs_.size()); }
  [[nodiscard]] double nodes(int root) const { return runs_[root].nodes; }
  [[nodiscard]] bool goes_on(int root) const {
    return runs_[root].goes_on || (runs_[root].at_end[0] && runs_[root].at_end[1]);
  }

 private:
  struct Run {
    int parent, periods;
    double nodes;
    bool goes_on;  ///< of a pool: it comes again after a period
    std::array<bool, 2> at_end;
  };
  std::vector<Run> runs_;
};

template <int D>
class Survey {
  using Node = std::array<int, D>;

 public:
  Survey(core::RegionPointer<D> region, const core::Domain<D>& domain)
      : domain_(domain),
        shapes_(std::move(region)),
        region_(core::intersection<D>({shapes_, core::between_walls(domain)})),
        touching_(one_place * *std::ranges::max_element(domain.size)) {
    long below = 1;
    for (int k = 0; k < D; ++k) stride_[k] = std::exchange(below, below * domain.size[k]);
    int count = 1;
    for (int k = 0; k < D; ++k) count *= 3;
    for (int i = count / 2 + 1; i < count; ++i) {
      Node& way = ways_.emplace_back();
      for (int k = 0, rest = i; k < D; ++k, rest /= 3) way[k] = rest % 3 - 1;
    }
    layer_.resize(stride_[D - 1]);
    open_nodes.resize(static_cast<std::size_t>(domain.size[domain.flow_axis()]));
    for (Node node{}; node[D - 1] < domain.size[D - 1]; ++node[D - 1]) add_layer(node[D - 1]);
    if (domain.periodic[D - 1]) {
      std::swap(layer_, last_layer_);
      layer_ = first_layer_;
      join_layers(domain.size[D - 1] - 1);
    }
  }

  /// Between walls that face each other, where the way neither widens on one side alone nor ends.
  [[nodiscard]] std::pair<double, long> narrowest() const {
    std::pair<double, long> least{std::numeric_limits<double>::infinity(), -1};
    for (const auto& [node, ridge] : ridges_)
      if (ridge.width > touching_ && std::pair(ridge.width, node) < least && leads_on(node, ridge))
        least = {ridge.width, node};
    return least;
  }
  [[nodiscard]] Node node_of(long number) const {
    Node node;
    for (int k = 0; k < D; number /= domain_.size[k++]) node[k] = static_cast<int>(number % domain_.size[k]);
    return node;
  }
  Pools pools;
  std::vector<long> first_of_run;     ///< nodes
  std::vector<double> open_nodes;     ///< at each place along the flow axis
  double beside_walls = 0;            ///< nodes within a spacing of the region's border
  double unseen = 0;                  ///< thickness of the thickest wall that a link between nodes of fluid crosses
  Vec<D> unseen_at = Vec<D>::Zero();  ///< in it

 private:
  struct Place {
    double value;
    Vec<D> gradient;
  };
  /// Between two nodes, of which one is nearest to one wall and the other to another one across.
  struct Ridge {
    double width;
    Vec<D> across;
  };
  using Runs = std::vector<std::array<int, 3>>;  ///< first node, behind the last, number among pools

  void add_layer(int level) {
    std::swap(layer_, last_layer_);
    layer_.resize(stride_[D - 1]);
    std::swap(rows_, last_rows_);
    rows_.assign(stride_[D - 1] / domain_.size[0], {});
    for (long i = 0; i < stride_[D - 1]; ++i) {
      Node node = node_of(i);
      node[D - 1] = level;
      Vec<D> place;
      for (int k = 0; k < D; ++k) place[k] = node[k];
      const core::Distance<D> found = region_->distance(place);
      layer_[i] = {found.value, found.gradient};
      if (found.value > 0 && found.value < 1 && shapes_->distance(place).value < 1) ++beside_walls;
    }
    for (long row = 0; row < static_cast<long>(rows_.size()); ++row) add_row(row, level);
    for (int k = 1; k + 1 < D; ++k) join_along(k);
    add_ridges(level, layer_, layer_, 0);
    if (level > 0) join_layers(level - 1);
    if (level == 0) first_layer_ = layer_, first_rows_ = rows_;
  }

  void add_row(long row, int level) {
    const int size = domain_.size[0], open = domain_.open_axis;
    const int at = open == D - 1 ? level : static_cast<int>(row);  // along an open axis across x
    const auto is_fluid = [&](int x) { return layer_[row * size + x].value > 0; };
    for (int x = 0; x < size; ++x) {
      if (!is_fluid(x)) continue;
      const int begin = x;
      while (x < size && is_fluid(x)) ++x;
      first_of_run.push_back(level * stride_[D - 1] + row * size + begin);
      const int first = open == 0 ? begin : at, last = open == 0 ? x - 1 : at;
      rows_[row].push_back(
          {begin, x, pools.add(x - begin, {open >= 0 && first == 0, open >= 0 && last == domain_.size[open] - 1})});
    }
    for (int x = 0; x < size; ++x) open_nodes[static_cast<std::size_t>(open > 0 ? at : x)] += is_fluid(x) ? 1 : 0;
    if (domain_.periodic[0] && !rows_[row].empty() && is_fluid(0) && is_fluid(size - 1))
      pools.join(rows_[row].back()[2], rows_[row].front()[2], open > 0 ? 0 : 1);
  }

  void join_rows(const Runs& a, const Runs& b) {
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
      if (a[i][0] < b[j][1] && b[j][0] < a[i][1]) pools.join(a[i][2], b[j][2], 0);
      ++(a[i][1] < b[j][1] ? i : j);
    }
  }

  /// Rows of the layer.
  void join_along(int axis) {
    for (long i = 0; i < stride_[D - 1]; i += domain_.size[0]) {
      const long at = i / stride_[axis] % domain_.size[axis];
      const bool last = at + 1 == domain_.size[axis];
      if (last && !domain_.periodic[axis]) continue;
      const long next = last ? i - at * stride_[axis] : i + stride_[axis];
      join_rows(rows_[i / domain_.size[0]], rows_[next / domain_.size[0]]);
    }
  }

  /// From nodes of a layer at a level to those of the same one (`up`: 0) or the next (1), each pair once.
  void add_ridges(int level, const std::vector<Place>& from, const std::vector<Place>& to, int up) {
    for (const Node& way : ways_) {
      if (way[D - 1] != up) continue;
      for (long i = 0; i < stride_[D - 1]; ++i) {
        long there = 0;
        for (int k = 0; k + 1 < D && there >= 0; ++k) {
          const int next = domain_.wrapped(k, static_cast<int>(i / stride_[k] % domain_.size[k]) + way[k]);
          there = next < 0 ? -1 : there + next * stride_[k];
        }
        if (there >= 0) add_ridge(level * stride_[D - 1] + i, from[i], to[there], way);
      }
    }
  }

  /// The last layer, at a level, with this one.
  void join_layers(int level) {
    const std::vector<Runs>& rows = level + 1 == domain_.size[D - 1] ? first_rows_ : rows_;
    const std::vector<Runs>& below = level + 1 == domain_.size[D - 1] ? rows_ : last_rows_;
    add_ridges(level, last_layer_, layer_, 1);
    for (std::size_t row = 0; row < rows.size(); ++row) join_rows(below[row], rows[row]);
  }

  void add_ridge(long node, const Place& a, const Place& b, const Node& way) {
    constexpr double facing = -0.8;  // of walls at less than 37 degrees
    if (!(a.gradient.dot(b.gradient) < facing)) return;
    const Vec<D> across = (a.gradient - b.gradient) / 2;
    double between = 0;
    for (int k = 0; k < D; ++k) between += way[k] * across[k];
    const double width = a.value + b.value + between;
    if (a.value > 0 && b.value > 0 && -width > std::max(unseen, touching_)) add_unseen(node, a, b, way, -width);
    if (between <= 0 || width > widest_told) return;
    const auto [known, is_new] = ridges_.try_emplace(node, Ridge{width, across.normalized()});
    if (!is_new && width < known->second.width) known->second = {width, across.normalized()};
  }

  /// Not at the tips of wedges of more than 8 degrees, which are thin by nature. Where regions are joined a distance
  /// may be too short: then the way is open.
  void add_unseen(long node, const Place& a, const Place& b, const Node& way, double thickness) {
    constexpr double parallel = -0.99;
    Vec<D> along, place;
    const Node from = node_of(node);
    for (int k = 0; k < D; ++k) along[k] = way[k], place[k] = from[k];
    if (along.squaredNorm() > 2 || a.gradient.dot(b.gradient) > parallel) return;  // links lead no farther
    place += (a.value + thickness / 2) / (a.value + thickness + b.value) * along;
    if (region_->distance(place).value < 0) unseen = thickness, unseen_at = place;
  }

  [[nodiscard]] bool leads_on(long number, const Ridge& ridge) const {
    constexpr double even = 0.995, aside = 0.7;
    const Node node = node_of(number);
    std::vector<Vec<D>> ways;
    int count = 1;
    for (int k = 0; k < D; ++k) count *= 3;
    for (int i = 0; i < count; ++i) {
      Vec<D> way;
      long there = 0;
      for (int k = 0, rest = i; k < D; ++k, rest /= 3) {
        way[k] = rest % 3 - 1;
        const int to = domain_.wrapped(k, node[k] + rest % 3 - 1);
        there = to < 0 || there < 0 ? -1 : there + to * stride_[k];
      }
      if (there < 0 || !(std::abs(way.dot(ridge.across)) < aside * way.norm())) continue;
      const auto beside = ridges_.find(there);
      if (beside == ridges_.end()) continue;
      if (beside->second.width < even * ridge.width) return false;
      ways.push_back(way.normalized());
    }
    return !ways.empty() && std::ranges::all_of(ways, [&](const Vec<D>& way) {
      return std::ranges::any_of(ways, [&](const Vec<D>& other) { return way.dot(other) < -0.5; });
    });
  }

  core::Domain<D> domain_;
  core::RegionPointer<D> shapes_, region_;
  double touching_;         ///< walls nearer than so many spacings touch
  std::vector<Node> ways_;  ///< to half of the nodes around one, those that follow it
  std::array<long, D> stride_{};
  std::vector<Place> layer_, last_layer_, first_layer_;
  std::vector<Runs> rows_, last_rows_, first_rows_;
  std::unordered_map<long, Ridge> ridges_;
};

template <int D>
scene::Passages surveyed(const scene::Scene& scene) {
  const core::RegionPointer<D> region = scene::fluid_region<D>(scene);
  Survey<D> survey(region, scene::lattice_domain<D>(scene));
  const double spacing = scene::lattice_spacing(scene);
  const auto place_of = [&](long number) {
    const auto node = survey.node_of(number);
    scene::Vector place = scene::Vector::filled(D, 0);
    for (int k = 0; k < D; ++k) place[k] = units::coordinate(node[k], spacing);
    return place;
  };
  scene::Passages found;
  found.unseen.thickness = survey.unseen;
  if (survey.unseen > 0) {
    found.unseen.at = scene::Vector::filled(D, 0);
    for (int k = 0; k < D; ++k) found.unseen.at[k] = (survey.unseen_at[k] + 0.5) * spacing;
  }
  // On a coarse lattice narrow passages hide between nodes: they are looked for on a finer one.
  constexpr double many = 1 << 20;
  int finer = 1;
  while (finer < 4 && scene.domain.node_count() * std::pow(finer + 1, D) <= many) ++finer;
  core::Domain<D> domain = scene::lattice_domain<D>(scene);
  for (int& nodes : domain.size) nodes *= finer;
  const Survey<D> fine(core::magnified<D>(region, finer, Vec<D>::Constant(0.5 * finer - 0.5)), domain.in_one_block());
  if (const auto [narrowest, at] = fine.narrowest(); at >= 0) {
    found.narrowest = narrowest / finer;
    const auto node = fine.node_of(at);
    found.narrowest_at = scene::Vector::filled(D, 0);
    for (int k = 0; k < D; ++k) found.narrowest_at[k] = units::coordinate(node[k], spacing / finer);
  }
  double all = 0;
  int largest = -1;
  found.through = false;
  for (int run = 0; run < survey.pools.count(); ++run) {
    if (survey.pools.root(run).first != run) continue;
    all += survey.pools.nodes(run);
    found.through = found.through || survey.pools.goes_on(run);
    if (largest < 0 || survey.pools.nodes(run) > survey.pools.nodes(largest)) largest = run;
  }
  if (largest >= 0) found.apart = all - survey.pools.nodes(largest);
  for (int run = 0; run < survey.pools.count() && found.apart > 0; ++run) {
    if (survey.pools.root(run).first == largest) continue;
    found.apart_at = place_of(survey.first_of_run[run]);
    break;
  }
  found.beside_walls = survey.beside_walls;
  const double of_node = std::pow(spacing, D - 1);
  found.open = {survey.open_nodes.front() * of_node, survey.open_nodes.back() * of_node};
  found.least_open = *std::ranges::min_element(survey.open_nodes) * of_node;
  return found;
}

}  // namespace

void survey_walls(scene::Scene& scene, const std::shared_ptr<const scene::Passages>& known) {
  if (!scene.domain.has_shapes() || scene.domain.node_count() > most_surveyed) return;
  scene.domain.passages = known;
  if (known) return;
  scene::in_dimension(scene.domain.dimension(), [&]<int D>(std::integral_constant<int, D>) {
    scene.domain.passages = std::make_shared<const scene::Passages>(surveyed<D>(scene));
  });
}

}  // namespace rouleau::shape
