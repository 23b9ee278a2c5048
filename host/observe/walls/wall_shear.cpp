#include "wall_shear.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

namespace rouleau::observe {

namespace {

constexpr double reach = 3;     // spacings
constexpr double beside = 1.4;  // from the wall: of a node without links into it
constexpr double most = 10;     // sum of the magnitudes of a fit's shares

/// Where the fluid's nodes about a place lie, seen from it, and how much they count.
template <int D>
struct NodesAround {
  std::vector<std::size_t> node;
  std::vector<core::Vec<D>> from_place;
  std::vector<double> weight;
};

template <int D>
NodesAround<D> nodes_around(const core::Vec<D>& place, const core::Vec<D>& normal, const core::Region<D>& region,
                            const core::Domain<D>& domain, const core::SolidNodes<D>& solid) {
  NodesAround<D> around;
  core::Box<D> box;
  for (int k = 0; k < D; ++k) {
    box.begin[k] = static_cast<int>(std::ceil(place[k] - reach));
    box.end[k] = static_cast<int>(std::floor(place[k] + reach)) + 1;
  }
  for (int i = 0; i < row_count(box); ++i) {
    const auto row = row_of(box, i);
    for (int x = box.begin[0]; x < box.end[0]; ++x) {
      std::size_t number = 0;
      std::array<int, D> node;
      core::Vec<D> from;
      bool there = true;
      for (int k = D - 1; k >= 0; --k) {
        const int at = k == 0 ? x : box.begin[k] + row[static_cast<std::size_t>(std::max(k - 1, 0))];
        node[k] = domain.wrapped(k, at), from[k] = at - place[k];
        there = there && node[k] >= 0;
        number = number * static_cast<std::size_t>(domain.size[k]) + static_cast<std::size_t>(node[k]);
      }
      const double share = 1 - from.squaredNorm() / (reach * reach);
      if (!there || share <= 0 || from.dot(normal) <= 0 || solid.at(node)) continue;
      around.node.push_back(number);
      around.from_place.push_back(from / reach);
      around.weight.push_back(share * std::min(1.0, region.distance(place + from).value / beside));
    }
  }
  return around;
}

/// Shares of the nodes in the value at the place, of a polynomial of that order; none where nodes do not tell it.
template <int D>
std::optional<Eigen::VectorXd> shares_of(const NodesAround<D>& around, int order) {
  const auto count = static_cast<Eigen::Index>(around.node.size());
  const Eigen::Index columns = order == 0 ? 1 : order == 1 ? 1 + D : 1 + D + D * (D + 1) / 2;
  if (count < columns) return {};
  const Eigen::VectorXd weight = Eigen::Map<const Eigen::VectorXd>(around.weight.data(), count);
  Eigen::MatrixXd terms(count, columns);
  for (Eigen::Index i = 0; i < count; ++i) {
    const core::Vec<D>& from = around.from_place[static_cast<std::size_t>(i)];
    Eigen::Index c = 0;
    terms(i, c++) = 1;
    for (int k = 0; k < D && c < columns; ++k) terms(i, c++) = from[k];
    for (int k = 0; k < D && c < columns; ++k)
      for (int l = k; l < D; ++l) terms(i, c++) = from[k] * from[l];
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> fit(weight.asDiagonal() * terms);
  if (fit.rank() < columns) return {};
  const Eigen::VectorXd shares = fit.solve(Eigen::MatrixXd(weight.asDiagonal())).row(0).transpose();
  if (!(shares.cwiseAbs().sum() < most)) return {};
  return shares;
}

}  // namespace

template <int D>
WallShear<D>::WallShear(const core::Region<D>& region, const core::Domain<D>& domain, const core::SolidNodes<D>& solid,
                        const std::vector<core::Vec<D>>& places) {
  for (const core::Vec<D>& given : places) {
    const core::Distance<D> wall = region.distance(given);
    const auto place = static_cast<int>(normals_.size());
    normals_.push_back(wall.gradient);
    const NodesAround<D> around =
        nodes_around<D>(given - wall.value * wall.gradient, wall.gradient, region, domain, solid);
    std::optional<Eigen::VectorXd> shares;
    for (int order = 2; order >= 0 && !shares; --order) shares = shares_of(around, order);
    for (std::size_t i = 0; shares && i < around.node.size(); ++i)
      terms_.push_back({around.node[i], place, static_cast<float>((*shares)[static_cast<Eigen::Index>(i)])});
  }
  std::stable_sort(terms_.begin(), terms_.end(), [](const Term& a, const Term& b) { return a.node < b.node; });
}

template <int D>
std::vector<core::Vec<D>> WallShear<D>::of(const core::AnyFluid<D>& fluid) const {
  using Matrix = Eigen::Matrix<double, D, D>;
  std::vector<Matrix> stresses(normals_.size(), Matrix::Zero());
  std::size_t begin = 0;
  auto term = terms_.begin();
  const auto bands = core::bands_of_all<D>(fluid.setting().domain.size, sizeof(core::Stress<D>));
  fluid.gather_stresses(bands, [&](int, const std::vector<core::Stress<D>>& band) {
    for (; term != terms_.end() && term->node < begin + band.size(); ++term) {
      Matrix& stress = stresses[static_cast<std::size_t>(term->place)];
      const core::Stress<D>& node = band[term->node - begin];
      for (int k = 0, c = 0; k < D; ++k)
        for (int l = k; l < D; ++l, ++c) stress(k, l) += term->share * node[static_cast<std::size_t>(c)];
    }
    begin += band.size();
  });
  std::vector<core::Vec<D>> shear;
  for (std::size_t i = 0; i < stresses.size(); ++i) {
    const core::Vec<D>& normal = normals_[i];
    const core::Vec<D> traction = stresses[i].template selfadjointView<Eigen::Upper>() * normal;
    shear.push_back(traction - traction.dot(normal) * normal);
  }
  return shear;
}

template class WallShear<2>;
template class WallShear<3>;

}  // namespace rouleau::observe
