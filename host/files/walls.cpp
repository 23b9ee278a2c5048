#include "walls.hpp"

#include <string>

#include "base/error.hpp"

namespace rouleau::files {

namespace {

template <std::size_t N>
void write_places(hdf5::File& file, const std::string& path, const std::vector<std::array<double, N>>& places) {
  file.write(path, {places.size(), N}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, places.data(), "m");
}

template <std::size_t N>
void write_facets(hdf5::File& file, const std::string& path, const std::vector<std::array<int, N>>& facets) {
  if (!facets.empty()) file.write(path, {facets.size(), N}, H5T_STD_I32LE, H5T_NATIVE_INT, facets.data(), "1");
}

template <std::size_t N>
std::vector<std::array<double, N>> read_places(const hdf5::File& file, const std::string& path) {
  const std::vector<double> values = file.read(path);
  std::vector<std::array<double, N>> places(values.size() / N);
  for (std::size_t i = 0; i < N * places.size(); ++i) places[i / N][i % N] = values[i];
  return places;
}

}  // namespace

void write_walls(hdf5::File& file, const WallBorder& walls) {
  if (walls.empty()) return;
  file.make_group("/walls");
  if (!walls.corners.empty()) {
    write_places(file, "/walls/corners", walls.corners);
    file.write("/walls/first", walls.first, "1");
    write_facets(file, "/walls/segments", walls.segments);
  }
  if (walls.triangles.empty()) return;
  write_places(file, "/walls/points", walls.points);
  write_facets(file, "/walls/triangles", walls.triangles);
}

bool write_on_walls(hdf5::File& file, const std::string& group, const std::vector<observe::Field>& fields) {
  bool there = false;
  for (const observe::Field& field : fields) {
    field.give([&](const std::vector<double>& values) {
      if (!there) file.make_group(group);
      there = true;
      const auto components = static_cast<hsize_t>(field.components);
      file.write(group + "/" + field.name, {values.size() / components, components}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                 values.data(), field.unit);
    });
  }
  return there;
}

WallBorder read_walls(const hdf5::File& file) {
  WallBorder walls;
  const auto require = [&](bool fits, const char* dataset) {
    if (!fits)
      throw Error(Cause::input_output, Place{file.path().string()},
                  std::string(dataset) + " does not fit the corners of /walls: the file is damaged; repeat the run");
  };
  if (file.has("/walls/corners")) {
    walls.corners = read_places<2>(file, "/walls/corners");
    walls.first.clear();
    for (const double first : file.read("/walls/first")) {
      require(first >= (walls.first.empty() ? 0 : walls.first.back()) && first <= double(walls.corners.size()),
              "/walls/first");
      walls.first.push_back(static_cast<int>(first));
    }
    require(!walls.first.empty(), "/walls/first");
  }
  const auto read_facets = [&](auto& facets, const char* dataset, std::size_t corners) {
    if (!file.has(dataset)) return;
    const std::vector<double> numbers = file.read(dataset);
    for (std::size_t i = 0, n = 0; i < numbers.size(); ++i) {
      require(numbers[i] >= 0 && numbers[i] < double(corners), dataset);
      if (n == 0) facets.emplace_back();
      facets.back()[n] = static_cast<int>(numbers[i]);
      n = (n + 1) % facets.back().size();
    }
  };
  if (file.has("/walls/points")) walls.points = read_places<3>(file, "/walls/points");
  read_facets(walls.segments, "/walls/segments", walls.corners.size());
  read_facets(walls.triangles, "/walls/triangles", walls.points.size());
  return walls;
}

}  // namespace rouleau::files
