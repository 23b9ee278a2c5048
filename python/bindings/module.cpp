// The compiled part of the Python package: rouleau._core, which python/rouleau/simulation.py shows to users.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "base/error.hpp"
#include "base/foreign_call.hpp"
#include "faults.hpp"
#include "observe/observables.hpp"
#include "simulation.hpp"
#include "units/lattice_units.hpp"

namespace py = pybind11;

namespace rouleau::python {

namespace {

namespace fs = std::filesystem;

/// (problem, remedy, file, pointer, line, column): what rouleau.errors makes a Fault of.
py::tuple fault(const Error& error) {
  const Place& place = error.place();
  return py::make_tuple(error.problem(), error.remedy().words, place.file, place.pointer, place.line, place.column);
}

[[noreturn]] void raise(const py::list& faults, int exit_code) {
  const py::object error = py::module_::import("rouleau.simulation").attr("_error")(faults, exit_code);
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
  throw py::error_already_set();
}

int exit_code_of(Cause cause) { return cause == Cause::bad_input ? 2 : cause == Cause::plugin_refused ? 3 : 4; }

/// Calls with the interpreter's lock; what the simulator throws becomes rouleau.Error.
template <class Call>
auto guarded(const Call& call) {
  py::list faults;
  int exit_code = 2;
  try {
    return call();
  } catch (const SeveralFaults& several) {
    for (const Error& error : several.faults()) faults.append(fault(error));
    exit_code = exit_code_of(several.cause());
  } catch (const Error& error) {
    faults.append(fault(error));
    exit_code = exit_code_of(error.cause());
  } catch (const Diverged& diverged) {
    const monitor::Failure& f = diverged.failure;
    faults.append(
        py::make_tuple(f.reason + " at step " + std::to_string(f.step) + ": " + f.message, f.remedy, "", "", 0, 0));
    exit_code = 1;
  } catch (const ForeignException& exception) {
    faults.append(py::make_tuple(exception.what(), "report it to the plugin's author", "", "", 0, 0));
    exit_code = 3;
  }
  raise(faults, exit_code);
}

/// What Python holds. Views of its arrays keep it alive, and with it the memory.
class Session {
 public:
  Session(const fs::path& scene, std::vector<std::string> overrides, std::vector<fs::path> plugins) {
    simulation_ = guarded([&] {
      const py::gil_scoped_release other_threads_may_run;
      return make_simulation({scene, std::move(overrides), std::move(plugins)});
    });
  }

  /// Looks for signals every so often, so that Ctrl-C ends it between two steps.
  long step(long count, int threads) {
    long taken = 0, piece = 16;
    while (taken < count) {
      const auto start = std::chrono::steady_clock::now();
      const long wanted = std::min(piece, count - taken);
      const long done = guarded([&] {
        const py::gil_scoped_release other_threads_may_run;
        return simulation_->step(wanted, threads);
      });
      taken += done;
      if (done < wanted) break;
      const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
      if (passed.count() < 0.05) piece *= 2;
      if (passed.count() > 0.2) piece = std::max(1L, piece / 2);
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    return taken;
  }

  Simulation& simulation() { return *simulation_; }

 private:
  std::unique_ptr<Simulation> simulation_;
};

/// The components of a vector at all nodes; in two dimensions the last has none.
using Components = std::array<std::vector<double>*, 3>;
Components places(core::CellNodes& nodes) { return {&nodes.position[0], &nodes.position[1], &nodes.position[2]}; }
Components velocities(core::CellNodes& nodes) { return {&nodes.velocity[0], &nodes.velocity[1], &nodes.velocity[2]}; }
Components forces(core::CellNodes& nodes) { return {&nodes.force[0], &nodes.force[1], &nodes.force[2]}; }

/// Nodes times two, of two arrays that lie anywhere: one step along the second axis leads from the one to the other.
py::array pairs(const py::object& owner, const Components& of) {
  const auto apart = reinterpret_cast<char*>(of[1]->data()) - reinterpret_cast<char*>(of[0]->data());
  return {py::dtype::of<double>(),
          {static_cast<py::ssize_t>(of[0]->size()), py::ssize_t{2}},
          {static_cast<py::ssize_t>(sizeof(double)), static_cast<py::ssize_t>(apart)},
          of[0]->data(),
          owner};
}

/// In two dimensions a view, in three a copy: three arrays that lie anywhere have no common step.
py::array shown(const py::object& owner, bool in_space, const Components& of) {
  py::array array;
  if (!in_space) {
    array = pairs(owner, of);
  } else {
    py::array_t<double> copy({static_cast<py::ssize_t>(of[0]->size()), py::ssize_t{3}});
    auto to = copy.mutable_unchecked<2>();
    for (py::ssize_t i = 0; i < to.shape(0); ++i) {
      for (py::ssize_t k = 0; k < 3; ++k) to(i, k) = (*of[k])[static_cast<std::size_t>(i)];
    }
    array = copy;
  }
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// What asks `callback` for forces, and adds them.
std::function<void()> asking(const py::object& callback, Simulation& simulation) {
  core::CellNodes& nodes = simulation.nodes();
  if (!simulation.in_space()) {
    // The view that the callback may write to keeps nothing alive: the session that holds it does.
    return [callback, force = pairs(py::none(), forces(nodes))] {
      const py::gil_scoped_acquire interpreter;
      callback(force);
    };
  }
  return [callback, &nodes] {
    const py::gil_scoped_acquire interpreter;
    py::array_t<double> added({static_cast<py::ssize_t>(nodes.position[0].size()), py::ssize_t{3}});
    std::fill_n(added.mutable_data(), added.size(), 0.0);
    callback(added);
    const auto from = added.unchecked<2>();
    const Components to = forces(nodes);
    for (py::ssize_t i = 0; i < from.shape(0); ++i) {
      for (py::ssize_t k = 0; k < 3; ++k) (*to[k])[static_cast<std::size_t>(i)] += from(i, k);
    }
  };
}

py::array_t<double> array_of(const std::vector<double>& values, std::vector<py::ssize_t> shape) {
  py::array_t<double> array(std::move(shape));
  std::copy(values.begin(), values.end(), array.mutable_data());
  return array;
}

py::dict fluid(Session& session) {
  const FluidFields fields = guarded([&] { return session.simulation().fluid(); });
  py::dict result;
  std::vector<py::ssize_t> shape(fields.size.rbegin(), fields.size.rend());
  result["density"] = array_of(fields.density, shape);
  shape.push_back(static_cast<py::ssize_t>(fields.size.size()));
  result["velocity"] = array_of(fields.velocity, shape);
  return result;
}

/// The rows of cells.csv for the present state, as columns.
py::dict cells(Session& session) {
  const observe::Snapshot snapshot = guarded([&] { return session.simulation().observe(); });
  const observe::Table& table = observe::table("cells");
  py::dict columns;
  for (const observe::Observable& observable : table.observables) columns[observable.column().c_str()] = py::list();
  table.for_each_row(snapshot, [&](const observe::Row& row) {
    for (const observe::Observable& observable : table.observables) {
      const observe::Value value = observable.value(row);
      py::object shown = py::none();
      if (const auto* number = std::get_if<double>(&value)) shown = py::float_(*number);
      if (const auto* integer = std::get_if<long>(&value)) shown = py::int_(*integer);
      if (const auto* truth = std::get_if<bool>(&value)) shown = py::bool_(*truth);
      if (const auto* text = std::get_if<std::string>(&value)) shown = py::str(*text);
      columns[observable.column().c_str()].cast<py::list>().append(shown);
    }
  });
  return columns;
}

py::dict stage(Session& session) {
  Simulation& simulation = session.simulation();
  const scene::StageSetting& setting = simulation.stage();
  py::dict result;
  result["name"] = setting.stage->name;
  result["index"] = setting.index;
  result["most_steps"] = setting.max_steps;
  result["length"] = setting.units.length;
  result["time"] = setting.units.time;
  const double tension = setting.units.unit(units::dimension::tension);
  result["force"] = simulation.in_space() ? tension * setting.units.length : tension;
  return result;
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of rouleau; rouleau.Simulation is what to use.";
  prepare_process();
  py::class_<Session>(module, "Session")
      .def(py::init(
          [](const std::string& scene, std::vector<std::string> overrides, const std::vector<std::string>& plugins) {
            return std::make_unique<Session>(scene, std::move(overrides),
                                             std::vector<fs::path>(plugins.begin(), plugins.end()));
          }))
      .def("step", &Session::step)
      .def("code_of_the_scene", [](Session& session) { return session.simulation().code_of_the_scene(); })
      .def("positions",
           [](const py::object& self) {
             Simulation& simulation = self.cast<Session&>().simulation();
             return shown(self, simulation.in_space(), places(simulation.nodes()));
           })
      .def("velocities",
           [](const py::object& self) {
             Simulation& simulation = self.cast<Session&>().simulation();
             return shown(self, simulation.in_space(), velocities(simulation.nodes()));
           })
      .def("forces",
           [](const py::object& self) {
             Simulation& simulation = self.cast<Session&>().simulation();
             guarded([&] { simulation.compute_forces(); });
             return shown(self, simulation.in_space(), forces(simulation.nodes()));
           })
      .def("cell_nodes",
           [](Session& session) {
             const core::CellNodes& nodes = session.simulation().nodes();
             std::vector<std::pair<long, long>> ranges;
             for (int c = 0; c < nodes.cell_count(); ++c) {
               const core::CellRange& cell = nodes.cells[c];
               ranges.emplace_back(cell.first, nodes.knows(c) ? cell.end() : cell.first);
             }
             return ranges;
           })
      .def("set_force",
           [](Session& session, const py::object& callback) {
             Simulation& simulation = session.simulation();
             guarded([&] {
               simulation.set_force(callback.is_none() ? std::function<void()>{} : asking(callback, simulation));
             });
           })
      .def("fluid", &fluid)
      .def("cells", &cells)
      .def("stage", &stage)
      .def("save",
           [](Session& session, const std::string& folder) { guarded([&] { session.simulation().save(folder); }); })
      .def("restore",
           [](Session& session, const std::string& folder) { guarded([&] { session.simulation().restore(folder); }); })
      .def_property_readonly("done", [](Session& session) { return session.simulation().done(); })
      .def_property_readonly("steps", [](Session& session) { return session.simulation().steps(); })
      .def_property_readonly("time", [](Session& session) { return session.simulation().time(); })
      .def_property_readonly("strain", [](Session& session) { return session.simulation().strain(); });
}

}  // namespace rouleau::python
