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

/// A table from one of its rows on to the next.
class FromRow {
 public:
  explicit FromRow(std::size_t n_joints) : from_(n_joints), change_(n_joints) {}
  void begin(const Eigen::ArrayXXd& table, Eigen::Index row) {
    is_there_ = table.size() > 0;
    if (!is_there_) return;
    const Eigen::Index next = std::min(row + 1, table.rows() - 1);
    for (std::size_t k = 0; k < from_.size(); ++k) {
      from_[k] = table(row, static_cast<Eigen::Index>(k));
      change_[k] = table(next, static_cast<Eigen::Index>(k)) - from_[k];
    }
  }
  bool is_there() const { return is_there_; }
  /// `fraction`: of the way to the next row.
  void add(double fraction, std::vector<double>& to) const {
    if (!is_there_) return;
    for (std::size_t k = 0; k < to.size(); ++k) to[k] += from_[k] + fraction * change_[k];
  }

 private:
  bool is_there_ = false;
  std::vector<double> from_, change_;
};

/// Torques that do not depend on the state, linear between rows: the log's load on the link (none
/// when the rig has a law of q or there is no column) and the disturbances.
class OuterTorques {
 public:
  OuterTorques(const Model& model, const Clock& clock)
      : from_log_(!model.rig.load.law || model.rig.load.law->from_column),
        load_(model.joints.size()),
        on_link_(model.joints.size()),
        on_motor_(model.joints.size()),
        motor_(model.joints.size(), 0.0),
        link_(model.joints.size(), 0.0) {
    const auto steps = static_cast<double>(clock.steps_per_row);
    for (Eigen::Index step = 0; step < clock.steps_per_row; ++step)
      middle_.push_back((static_cast<double>(step) + 0.5) / steps);
  }

  /// The steps that follow are those of row `row`.
  void begin(const SimulationInput& block, Eigen::Index row) {
    if (from_log_) load_.begin(block.tau_load, row);
    on_link_.begin(block.link_disturbance, row);
    on_motor_.begin(block.motor_disturbance, row);
  }
  /// On the links, over step `step` of the row.
  const double* on_links(std::size_t step) {
    std::fill(link_.begin(), link_.end(), 0.0);
    load_.add(middle_[step], link_);
    on_link_.add(middle_[step], link_);
    return link_.data();
  }
  /// The same on the motors, which `drive` turns.
  const double* on_motors(std::size_t step, const std::vector<double>& drive) {
    if (!on_motor_.is_there()) return drive.data();
    std::copy(drive.begin(), drive.end(), motor_.begin());
    on_motor_.add(middle_[step], motor_);
    return motor_.data();
  }

 private:
  bool from_log_;
  FromRow load_, on_link_, on_motor_;
  std::vector<double> middle_;  ///< of the row's steps, as shares of it
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
    outer_.begin(block, row);
    for (Eigen::Index step = 0; step < clock_.steps_per_row; ++step) {
      const std::vector<double>& tau = drive_->torque(row, step, plant_.theta());
      const auto number = static_cast<std::size_t>(step);
      plant_.step(outer_.on_motors(number, tau), outer_.on_links(number), clock_.h);
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
