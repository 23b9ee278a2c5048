#include "solver.hpp"

#include <algorithm>
#include <cmath>

namespace rouleau::host {

namespace {

std::shared_ptr<const ModelInstance> make_model(const PlannedModel& model, const ModelSetting& setting) {
  return std::make_shared<const ModelInstance>(*model.manifest, model.parameters.values, setting);
}

}  // namespace

template <class T>
Solver<T>::Solver(const Plan& plan, int stage, Membranes& membranes)
    : setting_(&plan.stages[static_cast<std::size_t>(stage)]),
      membranes_(membranes),
      fluid_(setting_->fluid_setting(*plan.scene, plan.has_cells, plan.viscosity_contrast),
             make_model(plan.collision, setting_->model_setting(plan.scene->fluid.inertia))) {
  if (plan.has_cells) plan_forces(plan);
  plan_advance();
}

template <class T>
void Solver<T>::plan_forces(const Plan& plan) {
  const Scene& scene = *plan.scene;
  const int nx = scene.domain.nodes[0], ny = scene.domain.nodes[1];
  const ModelSetting setting = setting_->model_setting(scene.fluid.inertia);
  cell_step_.resize(membranes_.cells.size());
  const auto pass = [this](const char* name, std::function<void(Worker)> run) {
    forces_.push_back({name, std::move(run)});
  };

  std::vector<MembraneLaws> laws(plan.membranes.size());
  for (std::size_t type = 0; type < laws.size(); ++type) {
    for (const PlannedModel& law : plan.membranes[type]) {
      if (law.active()) laws[type].push_back(make_model(law, setting));
    }
  }
  membrane_forces_ = std::make_unique<MembraneForces>(membranes_, std::move(laws));
  pass("membrane", [this](Worker worker) { membrane_forces_->run(worker, membranes_); });

  if (plan.has_interactions) {
    std::vector<Potential> potentials;
    for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
      if (plan.interactions[i].active()) {
        potentials.push_back({scene.interactions[i].between, make_model(plan.interactions[i], setting)});
      }
    }
    const PeriodicBox box{static_cast<double>(nx), scene.domain.periodic_y ? static_cast<double>(ny) : 0.0};
    interaction_forces_ = std::make_unique<InteractionForces>(membranes_, std::move(potentials), box);
    for (int phase = 0; phase < InteractionForces::phases; ++phase) {
      pass("interaction", [this, phase](Worker worker) { interaction_forces_->run(worker, phase, membranes_); });
    }
  }

  std::vector<double> viscosity_ratio;
  for (const CellType& type : scene.cell_types) {
    viscosity_ratio.push_back(type.interior_viscosity / scene.fluid.viscosity);
  }
  indicator_ = std::make_unique<Indicator<T>>(membranes_, std::move(viscosity_ratio), 1 / setting_->tau, nx, ny,
                                              scene.domain.periodic_y);
  pass(plan.viscosity_contrast ? "indicator" : "activity", [this](Worker worker) {
    if (indicator_->due()) indicator_->update(worker, membranes_, fluid_.relaxation_rate(), fluid_.activity());
  });

  coupling_ = std::make_unique<Coupling<T>>(nx, ny, scene.domain.periodic_y);
  coupling_->reserve(membranes_);
  pass("spread", [this](Worker worker) {
    fluid_.clear_force(worker);
    coupling_->locate(worker, membranes_);
  });
  pass("spread", [this](Worker worker) { coupling_->spread(worker, membranes_, fluid_.force()); });
  pass("spread", [this](Worker worker) { fluid_.fold_force(worker); });
}

template <class T>
void Solver<T>::plan_advance() {
  advance_.push_back({"fluid", [this](Worker worker) { fluid_.step(worker); }});
  if (coupling_) {
    advance_.push_back({"interpolate", [this](Worker worker) {
                          if (worker.first()) fluid_.end_step();
                          coupling_->interpolate(worker, membranes_, fluid_.force());
                        }});
    advance_.push_back({"move", [this](Worker worker) { move(worker); }});
  } else {
    advance_.push_back({"fluid", [this](Worker worker) {
                          if (worker.first()) fluid_.end_step();
                        }});
  }
}

template <class T>
void Solver<T>::move(Worker worker) {
  const Range cells = worker.share(static_cast<int>(membranes_.cells.size()));
  for (int c = cells.begin; c < cells.end; ++c) {
    const CellRange& cell = membranes_.cells[static_cast<std::size_t>(c)];
    StepResult& result = cell_step_[static_cast<std::size_t>(c)];
    result = {};
    for (int i = cell.first; i < cell.end(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      membranes_.x[k] += membranes_.velocity_x[k];
      membranes_.y[k] += membranes_.velocity_y[k];
      const double step2 =
          membranes_.velocity_x[k] * membranes_.velocity_x[k] + membranes_.velocity_y[k] * membranes_.velocity_y[k];
      // Written so that a step that is no number counts as the largest.
      if (!(step2 <= result.largest_step)) result = {step2, i};
    }
  }
  indicator_->measure(worker, membranes_);
}

template <class T>
StepResult Solver<T>::last_step() const {
  StepResult most;
  for (const StepResult& step : cell_step_) {
    if (!(step.largest_step <= most.largest_step)) most = step;
    if (std::isnan(most.largest_step)) break;
  }
  return {std::sqrt(most.largest_step), most.node};
}

template <class T>
void Solver<T>::tensions(std::vector<double>& tension) const {
  membrane_forces_->tensions(membranes_, tension);
}

template class Solver<float>;
template class Solver<double>;

}  // namespace rouleau::host
