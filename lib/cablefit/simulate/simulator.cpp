#include "cablefit/simulate/simulator.hpp"

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

std::unique_ptr<Drive> make_drive(const Model& model, const SimulationInput& input,
                                  const SimulationOptions& options, const Clock& clock) {
  if (options.closed_loop) return std::make_unique<PdDrive>(model, input, clock);
  return std::make_unique<ReplayDrive>(input, options, clock);
}

/// The log's load torque, linear between rows; 0 when the rig has a law of q or there is no column.
class LoadColumn {
 public:
  LoadColumn(const Model& model, const SimulationInput& input, const Clock& clock)
      : table_(input.tau_load),
        is_used_(input.tau_load.size() > 0 &&
                 (!model.rig.load.law || model.rig.load.law->from_column)),
        steps_per_row_(static_cast<double>(clock.steps_per_row)),
        torque_(model.joints.size(), 0.0) {}

  const std::vector<double>& at(Eigen::Index row, Eigen::Index step) {
    if (!is_used_) return torque_;
    const double fraction = (static_cast<double>(step) + 0.5) / steps_per_row_;
    for (std::size_t k = 0; k < torque_.size(); ++k) {
      torque_[k] = between_rows(table_, row, fraction, static_cast<Eigen::Index>(k));
    }
    return torque_;
  }

 private:
  const Eigen::ArrayXXd& table_;
  bool is_used_;
  double steps_per_row_;
  std::vector<double> torque_;
};

void record_torque(const std::vector<double>& tau, Eigen::Index row, SimulationResult* result) {
  for (std::size_t k = 0; k < tau.size(); ++k) {
    result->tau(row, static_cast<Eigen::Index>(k)) = tau[k];
  }
}

}  // namespace

SimulationResult simulate(const Model& model, const SimulationInput& input,
                          const SimulationOptions& options) {
  if (options.closed_loop && !model.rig.controller) {
    throw input_error({model.rig.path}, "no controller for a closed-loop simulation",
                      "add \"controller\" to the rig file, or replay the measured torque");
  }
  assert(input.period > 0 && options.step > 0);
  const Eigen::Index n_rows = (options.closed_loop ? input.theta_ref : input.tau).rows();
  const auto n_joints = static_cast<Eigen::Index>(model.joints.size());
  const auto n_cables =
      static_cast<Eigen::Index>(model.rigid ? 0 : model.transmission.cables.size());

  const Clock clock = make_clock(model, input, options);
  Plant plant(model, input, options.link_blocked);
  LoadColumn load(model, input, clock);
  SimulationResult result = nothing_yet(n_rows, n_joints, n_cables);
  if (n_rows == 0) return result;
  const std::unique_ptr<Drive> drive = make_drive(model, input, options, clock);

  for (Eigen::Index row = 0; row < n_rows; ++row) {
    if (!plant.is_sane()) {
      result.diverged_at = row;
      return result;
    }
    plant.record(row, &result);
    record_torque(drive->torque_at(row, plant.theta()), row, &result);
    if (row == n_rows - 1) break;
    for (Eigen::Index step = 0; step < clock.steps_per_row; ++step) {
      const std::vector<double>& tau = drive->torque(row, step, plant.theta());
      plant.step(tau.data(), load.at(row, step).data(), clock.h);
    }
  }
  return result;
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
