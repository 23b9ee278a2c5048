// Cells from CSV and HDF5 files.
#include "scene/cell_rows.hpp"

#include <hdf5.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "base/error.hpp"
#include "scratch_folder.hpp"

using namespace rouleau;
using namespace rouleau::scene;
using Catch::Matchers::Contains;
using namespace std::string_literals;

namespace {

std::vector<CellType> types(const std::vector<std::string>& names) {
  std::vector<CellType> result;
  for (const std::string& name : names) result.push_back({name, Circle{4e-6}, 40, 1e-3, {}});
  return result;
}

std::vector<CellPlacement> read(const std::string& text, const std::vector<std::string>& names = {"rbc", "capsule"}) {
  const test::ScratchFolder folder;
  return read_cell_table(folder.write("cells.csv", text), types(names), units::Units(), "/cells");
}

/// What an error says of the file: "line:column", and its words.
std::pair<std::string, std::string> fault(const std::string& text,
                                          const std::vector<std::string>& names = {"rbc", "capsule"}) {
  try {
    (void)read(text, names);
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    return {std::to_string(error.place().line) + ':' + std::to_string(error.place().column), error.what()};
  }
  return {};
}

}  // namespace

TEST_CASE("cells of a table have the units of its header, and know their lines") {
  const auto cells = read("type,x_um,y_m,angle_deg\nrbc,1.5,2e-6,90\r\n\ncapsule, -3 ,0,0");
  REQUIRE(cells.size() == 2);
  CHECK(cells[0].type == 0);
  CHECK(cells[0].center.x() == Approx(1.5e-6));
  CHECK(cells[0].center.y() == 2e-6);
  CHECK(cells[0].angle == Approx(std::acos(0.0)));
  CHECK(cells[0].line == 2);
  CHECK(cells[1].type == 1);
  CHECK(cells[1].center.x() == Approx(-3e-6));
  CHECK(cells[1].line == 4);
  CHECK(cells[1].pointer == "/cells");
}

TEST_CASE("a table needs neither a type where there is one only, nor angles, and columns stand in any order") {
  const auto cells = read("colour,y_nm,x_m\nred,500,1e-6\n", {"rbc"});
  REQUIRE(cells.size() == 1);
  CHECK(cells[0].type == 0);
  CHECK(cells[0].angle == 0);
  CHECK(cells[0].center.x() == 1e-6);
  CHECK(cells[0].center.y() == Approx(5e-7));
}

TEST_CASE("a table without types takes the one that is given, and one with types takes none") {
  const test::ScratchFolder folder;
  const auto all = types({"rbc", "capsule"});
  const auto file = folder.write("cells.csv", "x_um,y_um\n1,2\n");
  CHECK(read_cell_table(file, all, units::Units(), "/cells", 1).at(0).type == 1);
  const auto typed = folder.write("typed.csv", "x_um,y_um,type\n1,2,rbc\n");
  CHECK_THROWS_WITH(read_cell_table(typed, all, units::Units(), "/cells", 1),
                    Contains("typed.csv:1:11") && Contains("leave one of them out"));
}

TEST_CASE("a table is the same in the dialects of spreadsheets and programs") {
  const auto plain = read("type,x_um,y_um,angle_deg\nrbc,8,6,90\nrbc,20.5,8.25,0\ncapsule,30,20,0\n");
  const std::string rows = "rbc;8;6;90\r\nrbc;20,5;8,25;0\r\ncapsule;30;20;0\r\n";
  const std::string utf8 = "type,x_um,y_um,angle_deg\nrbc,8,6,90\nrbc,20.5,8.25,0\ncapsule,30,20,0\n";
  std::string little = "\xFF\xFE", big = "\xFE\xFF";
  for (const char c : utf8) little += {c, '\0'}, big += {'\0', c};
  for (const std::string& text :
       {"\"type\",\"x_um\",\"y_um\",\"angle_deg\"\n\"rbc\",8,6,90\n\"rbc\",20.5,8.25,0\n\"capsule\" ,\"30\",20,0\n"s,
        "type;x_um;y_um;angle_deg\r\n" + rows, "sep=;\r\ntype;x_um;y_um;angle_deg\r\n" + rows + ";;;\r\n",
        "type\tx_um\ty_um\tangle_deg\nrbc\t8\t6\t90\nrbc\t20,5\t8,25\t0\ncapsule\t30\t20\t0\n"s,
        "type,\tx_um,\ty_um,\tangle_deg\nrbc,\t8,\t6,\t90\nrbc,\t20.5,\t8.25,\t0\ncapsule,\t30,\t20,\t0\n"s,
        "# positions, measured\n# at 20 C\ntype,x_um,y_um,angle_deg\nrbc,8,6,90\n # \n   \nrbc,20.5,8.25,0\n"
        "capsule,30,20,0"s,
        "Type,X_um,Y_um,ANGLE_deg\nrbc,+8.000e+00,6.,90\nrbc,2.05e1,8.25,0\ncapsule,30,20,0\n"s,
        "type,x_um,y_um,angle_deg\rrbc,8,6,90\rrbc,20.5,8.25,0\rcapsule,30,20,0\r"s,
        "type,x_um,y_um,angle_deg,\nrbc,8,6,90,\nrbc,20.5,8.25,0,\ncapsule,30,20,0,\n"s,
        "name;type;x_um;y_um;angle_deg\n\"a; \"\"b\"\"\";rbc;8;6;90\nc;rbc;20.5;8.25;0\n;capsule;30;20;0\n"s,
        "\xEF\xBB\xBF\"type\",x_um,y_um,angle_deg\nrbc,8,6,90\nrbc,20.5,8.25,0\ncapsule,30,20,0\n"s, little, big}) {
    CAPTURE(text);
    const auto cells = read(text);
    REQUIRE(cells.size() == plain.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      CHECK(cells[i].type == plain[i].type);
      CHECK(cells[i].center == plain[i].center);
      CHECK(cells[i].angle == plain[i].angle);
    }
  }
  // As numpy writes a header.
  CHECK(read("# x_um,y_um\n1.5,2\n3,4\n", {"rbc"}).at(1).line == 3);
}

TEST_CASE("what cannot be read for certain is not guessed") {
  const auto says = [](const std::string& text, const std::string& place, const std::string& words) {
    const auto [where, what] = fault(text);
    CAPTURE(text);
    CHECK(where == place);
    CHECK_THAT(what, Contains(words));
  };
  says("type x_um y_um\nrbc 1 2\n", "1:1", "separate the columns by commas");
  says("type|x_um|y_um\nrbc|1|2\n", "1:1", "separate the columns by commas");
  says("type;x_um;y_um\nrbc;1.234,5;2\n", "2:5", "has a ','");
  says("type;x_um;y_um\nrbc;1,5;2\nrbc;1;2.5\n", "3:7", "has a '.'");
  says("type\tx_um\ty_um\nrbc\t1,234\t2\n", "2:5", "thousands");
  says("type,x_um,y_um\nrbc,\"1,234\",2\n", "2:5", "no number");
  says("type,x_um,y_um\nrbc,8,5,6\n", "2:9", "4 entries");
  says("type,x_um,y_um\nrbc,\"8,6\n", "2:5", "not closed");
  says("type,x_um,y_um\n\"rbc\"x,8,6\n", "2:6", "follows the quotation mark");
  says("Type,X_UM,y_um\nrbc,8,6\n", "1:6", "UM");
  says("X_um,type,x_um,y_um\n1,rbc,8,6\n", "1:11", "both x");
  says("type,x [um],y [um]\nrbc,1,2\n", "1:1", "no column x");
  says(std::string("t\0y\0", 4), "0:0", "NUL");
  says("# only a comment\n", "0:0", "names the columns");
}

TEST_CASE("of the table of a run the last step counts") {
  const auto cells = read(
      "step,time_s,strain,cell,type,x_m,y_m,angle_rad\n0,0,0,0,rbc,1e-6,1e-6,0\n0,0,0,1,rbc,9e-6,1e-6,0\n"
      "70,1,0,0,rbc,2e-6,1e-6,0.5\n70,1,0,1,capsule,8e-6,1e-6,0\n");
  REQUIRE(cells.size() == 2);
  CHECK(cells[0].center.x() == 2e-6);
  CHECK(cells[0].angle == 0.5);
  CHECK(cells[1].type == 1);
}

TEST_CASE("a fault of a table names line, column, value and remedy") {
  using Says = std::pair<std::string, std::string>;
  const auto is = [](const Says& found, const std::string& place, const std::string& a, const std::string& b) {
    CAPTURE(found.second);
    CHECK(found.first == place);
    CHECK_THAT(found.second, Contains(a) && Contains(b));
  };
  is(fault("type,x_um,y_um\nrbc,1,2\nrbc,1,two\n"), "3:7", "\"two\" is no number", "y_um");
  is(fault("type,x_um,y_um\nrbc,1e\n"), "2:5", "2 entries", "3");
  is(fault("type,x_um,y_um\nrbc,1,2,\n"), "2:9", "4 entries", "3");
  is(fault("type,x_um,y_um\nrcb,1,2\n"), "2:1", "did you mean \"rbc\"?", "cell_types has: rbc, capsule");
  is(fault("type,x_um,y_um\nrbc,1,2e7\n"), "2:7", "\"2e7\" um is out of range", "1e+06");
  is(fault("type,x_um,y_um\nrbc,nan,2\n"), "2:5", "\"nan\" is no number", "x_um");
  is(fault("type,x,y_um\nrbc,1,2\n"), "1:6", "has no unit", "x_um");
  is(fault("type,x_s,y_um\nrbc,1,2\n"), "1:6", "a time", "m");
  is(fault("type,x_um,x_m,y_um\nrbc,1,2,3\n"), "1:11", "both x", "leave one");
  is(fault("type,type,x_um,y_um\nrbc,rbc,2,3\n"), "1:6", "there twice", "leave one");
  is(fault("type,x_um\nrbc,1\n"), "1:1", "no column y with its unit\n", "y_um");
  is(fault("type,x_um,yum\nrbc,1,1\n"), "1:1", "did you mean \"yum\"?", "y_um");
  is(fault("x_um,y_um\n1,2\n"), "1:1", "no column \"type\"", "rbc, capsule");
  is(fault("step,type,x_um,y_um\n7,rbc,1,2\n3,rbc,1,2\n"), "3:1", "comes after step 7", "sort");
  is(fault("type,x_um,y_um\n"), "0:0", "no cells", "header");
  is(fault(""), "0:0", "empty", "type,x_um,y_um,angle_deg");
  CHECK_THROWS_AS(read_cell_table("/nowhere/cells.csv", types({"rbc"}), units::Units(), "/cells"), Error);
}

TEST_CASE("in three dimensions a table has places along z and axes") {
  const auto cells = read("x_um,y_um,z_um,axis_x,axis_y,axis_z,angle_deg\n1,2,3,0,3,4,90\n", {"rbc"});
  REQUIRE(cells.size() == 1);
  CHECK(cells[0].center.z() == Approx(3e-6));
  REQUIRE(cells[0].axis);
  CHECK((*cells[0].axis - Eigen::Vector3d(0, 0.6, 0.8)).norm() < 1e-15);
  CHECK(fault("type,x_um,y_um,axis_x,axis_z\nrbc,1,2,0,1\n").second.find("no \"axis_y\"") != std::string::npos);
  CHECK_THAT(fault("type,x_um,y_um,axis_x,axis_y,axis_z\nrbc,1,2,0,0,0\n").second, Contains("has no direction"));
  CHECK(fault("type,x_um,y_um,axis_x,axis_y,axis_z\nrbc,1,2,0,up,0\n").first == "2:11");
}

namespace {

/// A file of datasets of one dimension.
class Datasets {
 public:
  explicit Datasets(const std::filesystem::path& file)
      : file_(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {}
  Datasets(const Datasets&) = delete;
  Datasets& operator=(const Datasets&) = delete;
  ~Datasets() { H5Fclose(file_); }
  Datasets& add(const char* name, const std::vector<double>& values) {
    return add(name, H5T_NATIVE_DOUBLE, values.size(), values.data());
  }
  Datasets& add(const char* name, const std::vector<std::string>& values, bool variable) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, variable ? H5T_VARIABLE : 8);
    std::vector<const char*> words;
    std::string letters;
    for (const std::string& value : values) {
      words.push_back(value.c_str());
      letters += value + std::string(8 - value.size(), '\0');
    }
    add(name, type, values.size(), variable ? static_cast<const void*>(words.data()) : letters.data());
    H5Tclose(type);
    return *this;
  }
  Datasets& add(const char* name, hid_t type, hsize_t count, const void* values) {
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t dataset = H5Dcreate2(file_, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (count > 0) H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    H5Dclose(dataset);
    H5Sclose(space);
    return *this;
  }
  /// Numbers that lie in another file.
  void add_external(const char* name, hsize_t count, const std::string& elsewhere) {
    const hid_t space = H5Screate_simple(1, &count, nullptr), layout = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(layout, elsewhere.c_str(), 0, 8 * count);
    H5Dclose(H5Dcreate2(file_, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, layout, H5P_DEFAULT));
    H5Pclose(layout);
    H5Sclose(space);
  }

 private:
  hid_t file_;
};

}  // namespace

TEST_CASE("cells of HDF5 datasets are those of a CSV file with the same columns") {
  const test::ScratchFolder folder;
  const auto all = types({"rbc", "capsule"});
  const auto csv =
      read_cell_table(folder.write("cells.csv",
                                   "step,type,x_um,y_um,z_um,axis_x,axis_y,axis_z,angle_deg\n1,rbc,9,9,9,1,0,0,0\n"
                                   "2,rbc,1.5,2.25,3,0,1,2,30\n2,capsule,4,5,6,1,0,0,-45\n"),
                      all, units::Units(), "/cells");
  for (const bool variable : {true, false}) {
    const auto file = folder.path() / "cells.h5";
    Datasets(file)
        .add("step", {1, 2, 2})
        .add("type", {"rbc", "rbc", "capsule"}, variable)
        .add("x_um", {9, 1.5, 4})
        .add("y_um", {9, 2.25, 5})
        .add("z_um", {9, 3, 6})
        .add("axis_x", {1, 0, 1})
        .add("axis_y", {0, 1, 0})
        .add("axis_z", {0, 2, 0})
        .add("angle_deg", {0, 30, -45})
        .add("colour", {"red", "red", "blue"}, variable);
    const auto cells = read_cell_table(file, all, units::Units(), "/cells");
    REQUIRE(cells.size() == csv.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      CHECK(cells[i].type == csv[i].type);
      CHECK(cells[i].center == csv[i].center);
      CHECK(cells[i].axis == csv[i].axis);
      CHECK(cells[i].angle == csv[i].angle);
      CHECK(cells[i].line == static_cast<int>(i) + 2);
    }
  }
}

TEST_CASE("a fault of HDF5 datasets names file, dataset, row, value and remedy") {
  const test::ScratchFolder folder;
  const auto file = folder.path() / "cells.h5";
  const auto says = [&](const std::function<void(Datasets&)>& fill) -> std::string {
    {
      Datasets datasets(file);
      fill(datasets);
    }
    try {
      (void)read_cell_table(file, types({"rbc", "capsule"}), units::Units(), "/cells");
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  const auto with = [&](const std::vector<std::string>& names, const std::vector<double>& x,
                        const std::vector<double>& y) {
    return says([&](Datasets& to) { to.add("type", names, true).add("x_um", x).add("y_um", y); });
  };
  CHECK(with({"rbc", "rbc"}, {1, 9}, {2, 2}).empty());
  CHECK_THAT(with({"rbc", "rcb"}, {1, 9}, {2, 2}),
             Contains("cells.h5") && Contains("\"type\", row 2") && Contains("did you mean \"rbc\"?"));
  CHECK_THAT(with({"rbc", "rbc"}, {1, std::nan("")}, {2, 2}), Contains("\"x_um\", row 2") && Contains("no number"));
  CHECK_THAT(with({"rbc", "rbc"}, {1, 9}, {2e7, 2}),
             Contains("\"y_um\", row 1") && Contains("\"20000000\" um is out of range"));
  CHECK_THAT(with({"rbc", "rbc"}, {1, 9}, {2}),
             Contains("it has 2 values, and others have 1") || Contains("it has 1 values, and others have 2"));
  CHECK_THAT(with({}, {}, {}), Contains("no cells"));
  CHECK_THAT(says([](Datasets& to) { to.add("x_um", {1}); }), Contains("no column y") && Contains("x_um"));
  CHECK_THAT(says([](Datasets& to) { to.add("x_um", {1}).add("y_s", {1}); }), Contains("a time"));
  CHECK_THAT(says([](Datasets& to) { to.add("x_um", {1}).add("y_um", {1}).add("type", {1}); }),
             Contains("no names of cell types"));
  CHECK_THAT(says([](Datasets& to) { to.add("x_um", {"a"}, true).add("y_um", {1}).add("type", {"rbc"}, true); }),
             Contains("no numbers"));
  // Cut off.
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  CHECK_THROWS_AS(read_cell_table(file, types({"rbc"}), units::Units(), "/cells"), Error);
  // Values of another file.
  {
    const std::string secret = folder.write("secret", std::string(16, 's')).string();
    Datasets datasets(file);
    datasets.add("y_um", {1, 2});
    datasets.add_external("x_um", 2, secret);
  }
  CHECK_THROWS_WITH(read_cell_table(file, types({"rbc"}), units::Units(), "/cells"),
                    Contains("takes its values from other files"));
}
