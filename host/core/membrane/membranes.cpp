#include "membranes.hpp"

namespace rouleau::core {

RestShape make_rest_shape(std::vector<double> x, std::vector<double> y, double prestretch) {
  RestShape shape;
  shape.x = std::move(x);
  shape.y = std::move(y);
  const std::size_t count = shape.x.size();
  const auto dx = [&](std::size_t i) { return shape.x[(i + 1) % count] - shape.x[i]; };
  const auto dy = [&](std::size_t i) { return shape.y[(i + 1) % count] - shape.y[i]; };
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    shape.rest_length.push_back(std::sqrt(dx(i) * dx(i) + dy(i) * dy(i)) / prestretch);
    shape.rest_perimeter += shape.rest_length.back();
    shape.rest_area += (shape.x[i] * shape.y[next] - shape.y[i] * shape.x[next]) / 2;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = (i + count - 1) % count;
    const double sine = dx(before) * dy(i) - dy(before) * dx(i), cosine = dx(before) * dx(i) + dy(before) * dy(i);
    shape.rest_weight.push_back((shape.rest_length[before] + shape.rest_length[i]) / 2);
    shape.rest_curvature.push_back(std::atan2(sine, cosine) / shape.rest_weight.back());
  }
  return shape;
}

RestShape created_as(const RestShape& first, RestShape rest) {
  rest.x = first.x;
  rest.y = first.y;
  rest.rest_area = first.rest_area;
  rest.rest_perimeter = first.rest_perimeter;
  return rest;
}

void add_cell(Membranes& membranes, int type, double x, double y, double angle) {
  const RestShape& shape = *membranes.types.at(type);
  membranes.cells.push_back({{.first = membranes.node_count(), .count = static_cast<int>(shape.x.size())},
                             type,
                             shape.rest_area,
                             shape.rest_perimeter});
  const double c = std::cos(angle), s = std::sin(angle);
  for (std::size_t i = 0; i < shape.x.size(); ++i) {
    membranes.position[0].push_back(x + c * shape.x[i] - s * shape.y[i]);
    membranes.position[1].push_back(y + s * shape.x[i] + c * shape.y[i]);
  }
  membranes.resize_to_positions();
}

}  // namespace rouleau::core
