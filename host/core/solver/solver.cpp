#include "solver.hpp"

#include <numbers>

#include "core/membrane/area_correction.hpp"
#include "core/membrane/motion.hpp"
#include "core/membrane/stiffness.hpp"

namespace rouleau::solver {

namespace {

std::shared_ptr<const plugin::ModelInstance> make_model(const plan::PlannedModel& model,
                                                        const plugin::ModelSetting& setting) {
  return std::make_shared<const plugin::ModelInstance>(*model.manifest, model.parameters.values, setting);
}

}  // namespace

template <class T>
Solver<T>::Solver(const plan::Plan& plan, int stage, membrane::Membranes& membranes)
    : setting_(&plan.stages[static_cast<std::size_t>(stage)]),
      membranes_(membranes),
      fluid_(setting_->fluid_setting(*plan.scene, plan.has_cells, plan.viscosity_contrast),
             make_model(plan.collision, setting_->model_setting(plan.scene->fluid.inertia))) {
  if (plan.has_cells) {
    plan_cell_passes(plan);
    plan_spreading(plan);
  }
  plan_advance();
}

/// What the immersed boundary does wrong, and the scene wants put right.
template <class T>
void Solver<T>::start(Solver* former) {
  double faster = 0;  // what the membranes' last displacement is worth in the new time step
  if (setting_->stage->start == scene::WallStart::developed) {
    // Couette and Poiseuille flow, y from the middle of the channel.
    const double half_height = fluid_.setting().ny / 2.0, middle = half_height - 0.5, rate = setting_->shear_rate;
    const double curvature = setting_->body_force_x / ((setting_->tau - 0.5) / 3);
    fluid_.set_profile(
        [&](double y) {
          const double s = y - middle;
          return rate * s + curvature * (half_height * half_height - s * s) / 2;
        },
        [&](double y) { return rate - curvature * (y - middle); });
  } else if (former != nullptr) {
    faster = setting_->stage->density_factor / former->setting_->stage->density_factor;
    fluid_.take_over(former->fluid_, faster);
  }
  for (auto* velocity : {&membranes_.velocity_x, &membranes_.velocity_y}) {
    for (double& v : *velocity) v *= faster;
  }
}

template <class T>
void Solver<T>::plan_corrections(const plan::Plan& plan, const std::vector<membrane::MembraneLaws>& laws) {
  const scene::Scene& scene = *plan.scene;
  if (scene.numerics.slip_correction) {
    const coupling::KernelKind kernel = coupling::kernel_named(scene.numerics.kernel).kind;
    std::vector<coupling::SlipCorrection::Type> types;
    for (std::size_t t = 0; t < scene.cell_types.size(); ++t) {
      const double ratio = scene.cell_types[t].interior_viscosity / scene.fluid.viscosity;
      coupling::SlipCorrection::Type type{coupling::slip_constants(kernel, ratio), 0, 0};
      for (const auto& law : laws[t]) {
        type.stretching_stiffness += membrane::stretching_stiffness(*law);
        type.bending_stiffness += membrane::bending_stiffness(*law);
      }
      types.push_back(type);
    }
    slip_correction_ =
        std::make_unique<coupling::SlipCorrection>(membranes_, std::move(types), (setting_->tau - 0.5) / 3);
  }
  keeps_areas_ = scene.numerics.area_correction;
  if (keeps_areas_) membranes_.area_leakage.resize(membranes_.cells.size(), 0.0);  // earlier stages' leakage stays
}

template <class T>
void Solver<T>::find_slight_energy(const std::vector<membrane::MembraneLaws>& laws) {
  constexpr double strain = 1e-3;
  for (const membrane::CellRange& cell : membranes_.cells) {
    const double curvature = strain * 2 * std::numbers::pi / cell.rest_perimeter;  // of a circle that bends by as much
    double density = 0;
    for (const auto& law : laws[static_cast<std::size_t>(cell.type)]) {
      density += (membrane::stretching_stiffness(*law) * strain * strain +
                  membrane::bending_stiffness(*law) * curvature * curvature) /
                 2;
    }
    slight_energy_ += density * cell.rest_perimeter;
  }
}

/// Passes over cells: each worker has its own cells, and what it reads of others lies behind a barrier.
template <class T>
void Solver<T>::plan_cell_passes(const plan::Plan& plan) {
  membranes_.largest_step.assign(membranes_.cells.size(), 0.0);
  const scene::Scene& scene = *plan.scene;
  const int nx = scene.domain.nodes[0], ny = scene.domain.nodes[1];
  const plugin::ModelSetting setting = setting_->model_setting(scene.fluid.inertia);

  std::vector<membrane::MembraneLaws> laws(plan.membranes.size());
  for (std::size_t type = 0; type < laws.size(); ++type) {
    for (const plan::PlannedModel& law : plan.membranes[type]) {
      if (law.active()) laws[type].push_back(make_model(law, setting));
    }
  }
  plan_corrections(plan, laws);
  find_slight_energy(laws);
  membrane_forces_ = std::make_unique<membrane::MembraneForces>(membranes_, std::move(laws));
  if (slip_correction_) membrane_forces_->set_slip(slip_correction_->constants());
  if (plan.semi_implicit) membrane_forces_->make_semi_implicit(membranes_, (setting_->tau - 0.5) / 3);
  membrane_forces_->keep_state(membranes_);
  const auto membrane = [this](Worker worker) {
    membrane_forces_->run(worker, membranes_);
    if (slip_correction_) slip_correction_->couple(worker, membranes_);
  };

  std::vector<double> viscosity_ratio;
  for (const scene::CellType& type : scene.cell_types) {
    viscosity_ratio.push_back(type.interior_viscosity / scene.fluid.viscosity);
  }
  const bool corrected = slip_correction_ != nullptr;
  indicator_ = std::make_unique<coupling::Indicator<T>>(
      membranes_, std::move(viscosity_ratio),
      corrected ? coupling::ViscosityMean::harmonic : coupling::ViscosityMean::arithmetic,
      corrected ? slip_correction_->largest_shift() : 0.0, 1 / setting_->tau, nx, ny, scene.domain.periodic_y);
  indicator_name_ = plan.viscosity_contrast ? "indicator" : "activity";
  const auto cover = [this](Worker worker) {
    indicator_->measure(worker, membranes_);
    indicator_->cover(worker, membranes_);
  };
  const auto complete = [this](Worker worker) { slip_correction_->complete(worker, membranes_); };
  if (!plan.has_interactions) {
    forces_.push_back({"membrane", membrane, Meeting::none});
    if (corrected) forces_.push_back({"corrections", complete, Meeting::none});
    forces_.push_back({indicator_name_, cover});
    return;
  }

  std::vector<contact::Potential> potentials;
  for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
    if (plan.interactions[i].active()) {
      potentials.push_back({scene.interactions[i].between, make_model(plan.interactions[i], setting)});
    }
  }
  const membrane::PeriodicBox box{static_cast<double>(nx), scene.domain.periodic_y ? static_cast<double>(ny) : 0.0};
  interaction_forces_ = std::make_unique<contact::InteractionForces>(membranes_, std::move(potentials), box);
  interaction_forces_->keep_state(membranes_);
  const auto interaction = [this](int phase) {
    return [this, phase](Worker worker) { interaction_forces_->run(worker, phase, membranes_); };
  };
  // What a worker does for its own cells stands where it would otherwise wait for the others.
  static_assert(contact::InteractionForces::phases == 3);
  forces_.push_back({"interaction", interaction(0), Meeting::announce});
  forces_.push_back({"membrane", membrane, Meeting::await});
  forces_.push_back({"interaction", interaction(1), Meeting::announce});
  forces_.push_back({indicator_name_, cover, Meeting::await});
  forces_.push_back({"interaction", interaction(2), corrected ? Meeting::none : Meeting::all});
  if (corrected) forces_.push_back({"corrections", complete});
}

/// Passes over rows: each worker has its own rows and collides them afterwards. Only where y is periodic do the rows of
/// one worker have images in the halo of another.
template <class T>
void Solver<T>::plan_spreading(const plan::Plan& plan) {
  const fluid::FluidSetting& fluid = fluid_.setting();
  coupling_ = std::make_unique<coupling::Coupling<T>>(coupling::kernel_named(plan.scene->numerics.kernel).kind,
                                                      fluid.nx, fluid.ny, fluid.periodic_y);
  coupling_->reserve(membranes_);
  locate(Worker{});
  forces_.push_back({indicator_name_,
                     [this](Worker worker) {
                       if (!indicator_->due()) return;
                       indicator_->update(worker, membranes_, fluid_.relaxation_rate(), fluid_.activity());
                     },
                     Meeting::none});
  const Meeting images = fluid.periodic_y ? Meeting::all : Meeting::none;
  forces_.push_back({"spread", [this](Worker worker) { fluid_.clear_force(worker); }, images});
  const membrane::NodeVectors node_force = slip_correction_ ? slip_correction_->forces() : membranes_.forces();
  forces_.push_back(
      {"spread", [this, node_force](Worker worker) { coupling_->spread(worker, node_force, fluid_.force()); }, images});
  forces_.push_back({"spread", [this](Worker worker) { fluid_.fold_force(worker); }, Meeting::none});
}

template <class T>
void Solver<T>::plan_advance() {
  advance_.push_back({"fluid", [this](Worker worker) { fluid_.step(worker); }});
  const auto end_step = [this](Worker worker) {
    if (worker.first()) fluid_.end_step();
  };
  if (!coupling_) {
    advance_.push_back({"fluid", end_step});
    return;
  }
  // The forces of the next step begin with the same cells; their first barrier serves these passes too.
  advance_.push_back({"interpolate",
                      [this, end_step](Worker worker) {
                        end_step(worker);
                        coupling_->interpolate(worker, membranes_, fluid_.force());
                      },
                      Meeting::none});
  if (slip_correction_ || keeps_areas_) {
    advance_.push_back({"corrections",
                        [this](Worker worker) {
                          if (slip_correction_) slip_correction_->correct(worker, membranes_);
                          if (keeps_areas_) membrane::keep_areas(worker, membranes_);
                        },
                        Meeting::none});
  }
  advance_.push_back({"move",
                      [this](Worker worker) {
                        membrane::move_nodes(worker, membranes_);
                        locate(worker);
                      },
                      Meeting::none});
}

/// Pass over cells: where the nodes touch the lattice.
template <class T>
void Solver<T>::locate(Worker worker) {
  if (slip_correction_) slip_correction_->measure(worker, membranes_);
  coupling_->locate(worker, membranes_, slip_correction_ ? slip_correction_->positions() : membranes_.positions());
}

template <class T>
void Solver<T>::tensions(std::vector<double>& tension) const {
  membrane_forces_->tensions(membranes_, tension);
}

template class Solver<float>;
template class Solver<double>;

}  // namespace rouleau::solver
