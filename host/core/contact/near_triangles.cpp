#include "near_triangles.hpp"

#include <algorithm>
#include <tuple>

namespace rouleau::core {

const std::vector<Eigen::AlignedBox3d>& TriangleBoxes::of(int cell) {
  std::vector<Eigen::AlignedBox3d>& boxes = of_cell_[cell];
  if (!boxes.empty()) return boxes;
  const Nodes nodes = surfaces_.nodes(cell);
  int triangle = 0;
  for (const auto& corners : surfaces_.type_of(cell).mesh.triangles()) {
    if (triangle++ % size == 0) boxes.emplace_back();
    for (const int corner : corners) boxes.back().extend(nodes[corner]);
  }
  return boxes;
}

void NearTriangles::add(const BoundingBox<3>& box, Image image, double reach, const Surfaces& surfaces,
                        const Domain<3>& domain, TriangleBoxes& boxes) {
  constexpr std::size_t patch_size = 16;
  const Vec<3> least(box.least.data()), most(box.most.data()), moved = moved_by(image.shift, domain);
  const Nodes nodes = surfaces.nodes(image.other);
  image.part = {patches_.size(), patches_.size(), {}};
  const auto& all = surfaces.type_of(image.other).mesh.triangles();
  const std::vector<Eigen::AlignedBox3d>& boxes_of_other = boxes.of(image.other);
  const Eigen::AlignedBox3d reached(least - moved - Vec<3>::Constant(reach), most - moved + Vec<3>::Constant(reach));
  const auto may_reach = [&](const Eigen::AlignedBox3d& some) {
    // No triangle has a larger radius than its box a diagonal.
    return some.squaredExteriorDistance(reached) <= 3 * (1 + 1e-9) * some.diagonal().squaredNorm() + 1e-9;
  };
  for (int triangle = 0; triangle < static_cast<int>(all.size()); ++triangle) {
    if (triangle % TriangleBoxes::size == 0 && !may_reach(boxes_of_other[triangle / TriangleBoxes::size])) {
      triangle += TriangleBoxes::size - 1;
      continue;
    }
    const auto& [i, j, k] = all[triangle];
    const Vec<3> a = nodes[i], b = nodes[j], c = nodes[k], center = (a + b + c) / 3, middle = center + moved;
    const double radius =
        std::sqrt(std::max({(a - center).squaredNorm(), (b - center).squaredNorm(), (c - center).squaredNorm()}));
    const Vec<3> around = Vec<3>::Constant(reach + radius);
    if (!Eigen::AlignedBox3d(least - around, most + around).contains(middle)) continue;
    if (image.part.end == image.part.begin || patches_.back().end - patches_.back().begin == patch_size) {
      patches_.push_back({triangles_.size(), triangles_.size(), {}});
      ++image.part.end;
    }
    triangles_.push_back({triangle, middle, radius, around[0]});
    ++patches_.back().end;
    patches_.back().reached.extend(Eigen::AlignedBox3d(middle - around, middle + around));
    image.part.reached.extend(patches_.back().reached);
  }
  if (image.part.end > image.part.begin) images_.push_back(std::move(image));
}

void NearTriangles::sort_images() {
  std::sort(images_.begin(), images_.end(),
            [](const Image& a, const Image& b) { return std::tie(a.other, a.shift) < std::tie(b.other, b.shift); });
}

void NearTriangles::choose(const Eigen::AlignedBox3d& box) {
  for (Image& image : images_) {
    image.near.clear();
    if (!image.part.reached.intersects(box)) continue;
    for (std::size_t p = image.part.begin; p < image.part.end; ++p) {
      if (patches_[p].reached.intersects(box)) image.near.push_back(patches_[p]);
    }
  }
}

}  // namespace rouleau::core
