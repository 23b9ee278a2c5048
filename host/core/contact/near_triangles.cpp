#include "near_triangles.hpp"

#include <algorithm>
#include <tuple>

namespace rouleau::core {

void NearTriangles::add(const BoundingBox<3>& box, Image image, double reach, const Surfaces& surfaces,
                        const Domain<3>& domain) {
  constexpr std::size_t patch_size = 16;
  const Vec<3> least(box.least.data()), most(box.most.data()), moved = moved_by(image.shift, domain);
  const Nodes nodes = surfaces.nodes(image.other);
  image.part = {patches_.size(), patches_.size(), {}};
  int number = 0;
  for (const auto& [i, j, k] : surfaces.type_of(image.other).mesh.triangles()) {
    const int triangle = number++;
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
    for (std::size_t p = image.part.begin; p < image.part.end; ++p)
      if (patches_[p].reached.intersects(box)) image.near.push_back(patches_[p]);
  }
}

}  // namespace rouleau::core
