#include "cablefit/simulate/simulator.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>

#include "cablefit/base/error.hpp"
#include "cablefit/simulate/drive.hpp"
#include "cablefit/simulate/plant.hpp"

namespace cablefit {
namespace {

SimulationResult nothing_yet(Eigen::Index rows, Eigen::Index n_joints, Eigen::Index n_cables) {
  const auto none = std::numeric_limits<double>::quiet_NaN();
  const Eigen::ArrayXXd per_joint = Eigen::ArrayXXd::Constant(rows, n_joints, none);
  SimulationResult result;
  result.q = result.theta = result.qd = result.thetad = result.tau = per_joint;
  result.tension = Eigen::ArrayXXd::Constant(rows, n_cables, none);
  return result;
}

std::unique_ptr<Drive> make_drive(const Model& model, const SimulationInput& start,
                                  const SimulationOptions& options, const Clock& clock) {
  if (options.closed_loop) return std::make_unique<ControllerDrive>(model, start, clock);
  return std::make_unique<ReplayDrive>(model, options, clock);
}

/// Torques that do not depend on the state, linear between rows: the log's load on the link (none
/// when the rig has a law of q or there is no column) and the disturbances.
class OuterTorques {
 public:
  OuterTorques(const Model& model, const Clock& clock)
      : from_log_(!model.rig.load.law || model.rig.load.law->from_column),
        steps_per_row_(static_cast<double>(clock.steps_per_row)),
        motor_(model.joints.size(), 0.0),
        link_(model.joints.size(), 0.0) {}

  /// On the links, over step `step` of row `row`.
  const double* on_links(const SimulationInput& block, Eigen::Index row, Eigen::Index step) {
    std::fill(link_.begin(), link_.end(), 0.0);
    if (from_log_) add(block.tau_load, row, step, link_);
    add(block.link_disturbance, row, step, link_);
    return link_.data();
  }
  /// The same on the motors, which `drive` turns.
  const double* on_motors(const SimulationInput& block, Eigen::Index row, Eigen::Index step,
                          const std::vector<double>& drive) {
    if (block.motor_disturbance.size() == 0) return drive.data();
    motor_ = drive;
    add(block.motor_disturbance, row, step, motor_);
    return motor_.data();
  }

 private:
  void add(const Eigen::ArrayXXd& table, Eigen::Index row, Eigen::Index step,
           std::vector<double>& to) const {
    if (table.size() == 0) return;
    const double fraction = (static_cast<double>(step) + 0.5) / steps_per_row_;
    for (std::size_t k = 0; k < to.size(); ++k)
      to[k] += between_rows(table, row, fraction, static_cast<Eigen::Index>(k));
  }

  bool from_log_;
  double steps_per_row_;
  std::vector<double> motor_, link_;
};

void record_torque(const std::vector<double>& tau, Eigen::Index row, SimulationResult* result) {
  for (std::size_t k = 0; k < tau.size(); ++k) {
    result->tau(row, static_cast<Eigen::Index>(k)) = tau[k];
  }
}

Eigen::Index n_rows_of(const SimulationInput& input, const SimulationOptions& options) {
  return (options.closed_loop ? input.theta_ref : input.tau).rows();
}

}  // namespace

class Simulation::State {
 public:
  State(const Model& model, const SimulationInput& start, const SimulationOptions& options)
      : options_(options),
        n_joints_(static_cast<Eigen::Index>(model.joints.size())),
        n_cables_(static_cast<Eigen::Index>(model.rigid ? 0 : model.transmission.cables.size())),
        clock_(make_clock(model, start, options)),
        plant_(model, start, options.link_blocked),
        outer_(model, clock_),
        drive_(make_drive(model, start, options, clock_)) {}

  void take_history(const State& before) { plant_.take_history(before.plant_); }

  SimulationResult run(const SimulationInput& block, Eigen::Index n_rows) {
    SimulationResult result = nothing_yet(n_rows, n_joints_, n_cables_);
    const Eigen::Index last = n_rows_of(block, options_) - 1;
    drive_->begin(block);
    for (Eigen::Index row = 0; row < n_rows; ++row) {
      if (!plant_.is_sane()) {
        result.diverged_at = row;
        return result;
      }
      plant_.record(row, &result);
      record_torque(drive_->torque_at(row, plant_.theta()), row, &result);
      if (row < last) step_on(block, row);
    }
    drive_->end(n_rows);
    return result;
  }

 private:
  void step_on(const SimulationInput& block, Eigen::Index row) {
    for (Eigen::Index step = 0; step < clock_.steps_per_row; ++step) {
      const std::vector<double>& tau = drive_->torque(row, step, plant_.theta());
      plant_.step(outer_.on_motors(block, row, step, tau), outer_.on_links(block, row, step),
                  clock_.h);
    }
  }

  SimulationOptions options_;
  Eigen::Index n_joints_, n_cables_;
  Clock clock_;
  Plant plant_;
  OuterTorques outer_;
  std::unique_ptr<Drive> drive_;
};

Simulation::Simulation(const Model& model, const SimulationInput& start,
                       const SimulationOptions& options) {
  if (options.closed_loop && !model.rig.controller) {
    throw input_error({model.rig.path}, "no controller for a closed-loop simulation",
                      "add \"controller\" to the rig file, or replay the measured torque");
  }
  assert(start.period > 0 && options.step > 0);
  state_ = std::make_unique<State>(model, start, options);
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::take_history(const Simulation& before) { state_->take_history(*before.state_); }

SimulationResult Simulation::run(const SimulationInput& block, Eigen::Index n_rows) {
  return state_->run(block, n_rows);
}

SimulationResult simulate(const Model& model, const SimulationInput& input,
                          const SimulationOptions& options) {
  const Eigen::Index n_rows = n_rows_of(input, options);
  return Simulation(model, input, options).run(input, n_rows);
}

Gap gap(const Eigen::Ref<const Eigen::ArrayXd>& measured,
        const Eigen::Ref<const Eigen::ArrayXd>& simulated) {
  assert(measured.size() == simulated.size() && measured.size() > 0);
  const Eigen::ArrayXd error = simulated - measured;
  const double spread = std::sqrt((measured - measured.mean()).square().mean());
  Gap result;
  result.rms = std::sqrt(error.square().mean());
  result.max_abs = error.abs().maxCoeff();
  result.relative = result.rms / spread;
  return result;
}

}  // namespace cablefit
