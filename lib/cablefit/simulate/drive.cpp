#include "cablefit/simulate/drive.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr double kMostSteps = 1000;  // per row: bounds the work on a log of a few rows a second

bool is_whole(double value) { return std::abs(value - std::round(value)) < 1e-6; }

double controller_period(const Model& model, const SimulationInput& input) {
  const double period = model.rig.controller->period;
  return period > 0 ? period : input.period;
}

/// Resolution of a joint's motor encoder: "theta2" when given, else "theta".
double theta_quantum(const Rig& rig, std::size_t joint) {
  for (const std::string& name : {"theta" + std::to_string(joint + 1), std::string("theta")}) {
    const auto sensor = rig.sensors.find(name);
    if (sensor != rig.sensors.end() && sensor->second.quantum) return *sensor->second.quantum;
  }
  return 0.0;
}

double first_difference(const Eigen::ArrayXXd& table, Eigen::Index joint) {
  return table.rows() > 1 ? table(1, joint) - table(0, joint) : 0.0;
}

double first_value(const Eigen::ArrayXXd& table, Eigen::Index joint) {
  return table.rows() > 0 ? table(0, joint) : 0.0;
}

}  // namespace

Clock make_clock(const Model& model, const SimulationInput& input,
                 const SimulationOptions& options) {
  const auto least = std::clamp(std::ceil(input.period / options.step - 1e-6), 1.0, kMostSteps);
  double n = least;
  if (options.closed_loop) {
    const double commands_per_row = input.period / controller_period(model, input);
    while (n < 2 * least && !is_whole(n / commands_per_row)) ++n;
    if (!is_whole(n / commands_per_row)) n = least;
  }
  return {static_cast<Eigen::Index>(n), input.period / n};
}

double between_rows(const Eigen::ArrayXXd& table, Eigen::Index row, double fraction,
                    Eigen::Index joint) {
  const Eigen::Index next = std::min(row + 1, table.rows() - 1);
  return table(row, joint) + fraction * (table(next, joint) - table(row, joint));
}

ReplayDrive::ReplayDrive(const Model& model, const SimulationOptions& options, const Clock& clock)
    : hold_(options.hold_torque),
      steps_per_row_(static_cast<double>(clock.steps_per_row)),
      tau_(model.joints.size()) {}

const std::vector<double>& ReplayDrive::torque(Eigen::Index row, Eigen::Index step,
                                               const std::vector<double>& /*theta*/) {
  return interpolate(row, hold_ ? 0.0 : (static_cast<double>(step) + 0.5) / steps_per_row_);
}

const std::vector<double>& ReplayDrive::torque_at(Eigen::Index row,
                                                  const std::vector<double>& /*theta*/) {
  return interpolate(row, 0.0);
}

const std::vector<double>& ReplayDrive::interpolate(Eigen::Index row, double fraction) {
  for (std::size_t k = 0; k < tau_.size(); ++k) {
    tau_[k] = between_rows(block_->tau, row, fraction, static_cast<Eigen::Index>(k));
  }
  return tau_;
}

ControllerDrive::ControllerDrive(const Model& model, const SimulationInput& start,
                                 const Clock& clock)
    : controller_(*model.rig.controller),
      period_(controller_period(model, start)),
      steps_per_row_(static_cast<double>(clock.steps_per_row)),
      steps_per_command_(period_ / clock.h),
      tau_(model.joints.size()),
      drive_(model, period_) {
  for (std::size_t k = 0; k < tau_.size(); ++k) {
    const auto joint = static_cast<Eigen::Index>(k);
    quantum_.push_back(theta_quantum(model.rig, k));
    const double position = start.theta0.size() ? start.theta0[joint] : 0.0;
    const double velocity = start.thetad0.size() ? start.thetad0[joint] : 0.0;
    const double reference_rate = first_difference(start.theta_ref, joint) / start.period;
    const double reference = first_value(start.theta_ref, joint) - period_ * reference_rate;
    memory_.push_back({reference - measured(position - period_ * velocity, k), reference,
                       reference_rate, 0, first_value(start.theta_ref, joint)});
  }
}

double ControllerDrive::measured(double theta, std::size_t joint) const {
  const double quantum = quantum_[joint];
  return quantum > 0 ? quantum * std::round(theta / quantum) : theta;
}

const std::vector<double>& ControllerDrive::torque(Eigen::Index row, Eigen::Index step,
                                                   const std::vector<double>& theta) {
  const double now =
      (rows_before_ + static_cast<double>(row)) * steps_per_row_ + static_cast<double>(step);
  if (now >= next_command_) command(row, step, theta);
  if (!drive_.is_needed()) return tau_;
  const double middle = now + 0.5 - (n_commands_ - 1) * steps_per_command_;
  return drive_.at(middle / steps_per_command_);
}

void ControllerDrive::end(Eigen::Index n_rows) {
  block_ = nullptr;
  rows_before_ += static_cast<double>(n_rows);
}

void ControllerDrive::command(Eigen::Index row, Eigen::Index step,
                              const std::vector<double>& theta) {
  ++n_commands_;
  next_command_ = std::round(n_commands_ * steps_per_command_);
  const double fraction = static_cast<double>(step) / steps_per_row_;
  for (std::size_t k = 0; k < tau_.size(); ++k) {
    const auto joint = static_cast<Eigen::Index>(k);
    const Controller& law = controller_.of(k);
    Memory& last = memory_[k];
    const double reference = between_rows(block_->theta_ref, row, fraction, joint);
    const double error = reference - measured(theta[k], k);
    const double reference_rate = (reference - last.reference) / period_;
    const double feed = law.feed_position * (reference - last.first_reference) +
                        law.feed_velocity * reference_rate +
                        law.feed_acceleration * (reference_rate - last.reference_rate) / period_;
    const double tau =
        law.kp * error + law.ki * last.integral + law.kd * ((error - last.error) / period_) + feed;
    if (std::abs(tau) < law.limit) last.integral += period_ * error;  // no wind-up
    last.error = error;
    last.reference = reference;
    last.reference_rate = reference_rate;
    tau_[k] = std::clamp(tau, -law.limit, law.limit);
  }
  if (drive_.is_needed()) drive_.command(tau_);
}

}  // namespace cablefit
