#include "frames_xdmf.hpp"

#include <sstream>

#include "tables.hpp"

namespace rouleau::files {

std::string frame_path(std::size_t frame) {
  std::string digits = std::to_string(frame);
  if (digits.size() < 6) digits.insert(0, 6 - digits.size(), '0');
  return "/frames/" + digits;
}

namespace {

struct Item {
  const char* type;  ///< Int or Float
  int precision;     ///< bytes
};

std::string data_item(const std::string& dimensions, Item item, const std::string& dataset) {
  return "<DataItem Dimensions=\"" + dimensions + "\" NumberType=\"" + item.type + "\" Precision=\"" +
         std::to_string(item.precision) + "\" Format=\"HDF\">" + dataset + "</DataItem>";
}

std::string attribute(const std::string& name, const std::string& kind, const std::string& item,
                      const std::string& center = "Node") {
  return "        <Attribute Name=\"" + name + "\" AttributeType=\"" + kind + "\" Center=\"" + center + "\">" + item +
         "</Attribute>\n";
}

/// XDMF has no place for units that ParaView would show; names stand on its colour bars and in its tables.
std::string shown_name(const std::string& dataset) {
  if (dataset == "tension") return "tension (N/m)";
  if (dataset == "curvature") return "curvature (1/m)";
  if (dataset == "velocity") return "velocity (m/s)";
  if (dataset == "density") return "density deviation";
  if (dataset == "viscosity") return "viscosity (Pa s)";
  if (dataset == "vorticity") return "vorticity (1/s)";
  if (dataset == observe::shear_stress) return "wall shear stress (Pa)";
  return dataset;
}

std::string begin_grid(const std::string& name, double time) {
  return "      <Grid Name=\"" + name + "\" GridType=\"Uniform\">\n        <Time Value=\"" + to_text(time) + "\"/>\n";
}

std::string membranes(const FrameRecord& frame, const std::string& group) {
  const std::string n = std::to_string(frame.nodes), cells = std::to_string(frame.cells);
  std::string text = begin_grid("membranes", frame.time);
  if (frame.surfaces) {
    const std::string triangles = std::to_string(frame.connectivity / 3);
    text += "        <Topology TopologyType=\"Triangle\" NumberOfElements=\"" + triangles + "\">" +
            data_item(triangles + " 3", {"Int", 4}, group + "/triangles") + "</Topology>\n";
  } else if (frame.uniform) {
    const std::string per_cell = std::to_string(frame.connectivity / frame.cells);
    text += "        <Topology TopologyType=\"Polyline\" NumberOfElements=\"" + cells + "\" NodesPerElement=\"" +
            per_cell + "\">" + data_item(cells + " " + per_cell, {"Int", 4}, group + "/connectivity") + "</Topology>\n";
  } else {
    text += "        <Topology TopologyType=\"Mixed\" NumberOfElements=\"" + cells + "\">" +
            data_item(std::to_string(frame.connectivity), {"Int", 4}, group + "/connectivity") + "</Topology>\n";
  }
  text += std::string("        <Geometry GeometryType=\"") + (frame.surfaces ? "XYZ" : "XY") + "\">" +
          data_item(n + (frame.surfaces ? " 3" : " 2"), {"Float", 8}, group + "/points") + "</Geometry>\n";
  text += attribute(shown_name("tension"), "Scalar", data_item(n, {"Float", 8}, group + "/tension"));
  if (frame.surfaces)
    text += attribute(shown_name("curvature"), "Scalar", data_item(n, {"Float", 8}, group + "/curvature"));
  text += attribute("cell", "Scalar", data_item(n, {"Int", 4}, group + "/cell"));
  text += attribute("aggregate", "Scalar", data_item(n, {"Int", 4}, group + "/aggregate"));
  return text + "      </Grid>\n";
}

std::string fields(const FrameRecord& frame, const std::string& group, const FieldGrid& grid) {
  // In two dimensions one layer of a 3-D mesh: ParaView lays a 2DCoRectMesh into the y-z plane, across the membranes.
  // Slowest index first.
  const bool space = grid.nodes.size() == 3;
  std::vector<int> nodes = grid.nodes;
  nodes.resize(3, 1);
  const std::string shape = std::to_string(nodes[2]) + " " + std::to_string(nodes[1]) + " " + std::to_string(nodes[0]);
  const auto triple = [](std::vector<double> along, double rest) {
    along.resize(3, rest);
    return "<DataItem Dimensions=\"3\" NumberType=\"Float\" Precision=\"8\" Format=\"XML\">" + to_text(along[2]) + " " +
           to_text(along[1]) + " " + to_text(along[0]) + "</DataItem>";
  };
  std::string text = begin_grid("fields", frame.time);
  text += "        <Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"" + shape + "\"/>\n";
  text += "        <Geometry GeometryType=\"ORIGIN_DXDYDZ\">" + triple(grid.origin, 0) +
          triple(grid.spacing, grid.spacing[0]) + "</Geometry>\n";
  for (const auto& name : frame.fields) {
    const bool vector = name == "velocity" || (name == "vorticity" && space);
    text += attribute(shown_name(name), vector ? "Vector" : "Scalar",
                      data_item(shape + (vector ? " 3" : ""), {"Float", grid.bytes}, group + "/" + name));
  }
  return text + "      </Grid>\n";
}

/// Segments, or in three dimensions triangles: at all times, or in a frame, with what there is on them.
std::string wall_grid(const WallBorder& walls, const std::string& group, const FrameRecord* frame = nullptr,
                      const std::string& on_walls = {}) {
  const auto grid = [&](const std::string& topology, std::size_t facets, const std::string& facets_name,
                        const std::string& geometry, std::size_t points, const std::string& points_name) {
    if (facets == 0) return std::string();
    const std::string columns = ' ' + std::to_string(geometry.size()), count = std::to_string(facets);
    std::string begin = "    <Grid Name=\"walls\" GridType=\"Uniform\">\n", values;
    if (frame != nullptr) {
      begin = begin_grid("walls", frame->time);
      values = attribute(shown_name(observe::shear_stress), "Vector",
                         data_item(count + " 3", {"Float", 8}, on_walls + observe::shear_stress), "Cell");
    }
    return begin + "        <Topology TopologyType=" + topology + " NumberOfElements=\"" + count + "\">" +
           data_item(count + columns, {"Int", 4}, group + facets_name) +
           "</Topology>\n        <Geometry GeometryType=\"" + geometry + "\">" +
           data_item(std::to_string(points) + columns, {"Float", 8}, group + points_name) + "</Geometry>\n" + values +
           "    </Grid>\n";
  };
  std::string surface =
      grid("\"Triangle\"", walls.triangles.size(), "/triangles", "XYZ", walls.points.size(), "/points");
  if (!surface.empty()) return surface;
  return grid("\"Polyline\" NodesPerElement=\"2\"", walls.segments.size(), "/segments", "XY", walls.corners.size(),
              "/corners");
}

}  // namespace

std::string xdmf_text(const std::vector<FrameRecord>& frames, const std::string& h5, const FieldGrid& grid,
                      const WallBorder& walls) {
  std::ostringstream membrane_grids, field_grids, wall_grids;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string path = h5 + ":" + frame_path(i);
    if (frames[i].cells > 0) membrane_grids << membranes(frames[i], path + "/membranes");
    if (!frames[i].fields.empty()) field_grids << fields(frames[i], path + "/fields", grid);
    if (frames[i].sheared_walls) wall_grids << wall_grid(walls, h5 + ":/walls", &frames[i], path + "/walls/");
  }
  std::string text = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n";
  const auto collection = [&](const char* name, const std::string& grids) {
    if (grids.empty()) return;
    text += std::string("    <Grid Name=\"") + name + "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n" +
            grids + "    </Grid>\n";
  };
  collection("membranes", membrane_grids.str());
  collection("fields", field_grids.str());
  collection("wall shear stress", wall_grids.str());
  text += wall_grid(walls, h5 + ":/walls");
  return text + "  </Domain>\n</Xdmf>\n";
}

}  // namespace rouleau::files
