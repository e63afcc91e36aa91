#include "cablefit/dynamic/output_error/measured_stretch.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/simulate/start_state.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kFewestStretchRows = 16;

double at(const Eigen::ArrayXXd& table, Eigen::Index row, Eigen::Index joint) {
  return table.size() > 0 ? table(row, joint) : 0.0;
}

OutputErrorWindow window_of(const Model& model, const MeasuredStretch& stretch, Eigen::Index begin,
                            Eigen::Index n_rows) {
  const auto n_joints = static_cast<Eigen::Index>(model.joints.size());
  const bool by_column = !model.rig.load.law || model.rig.load.law->from_column;
  OutputErrorWindow w;
  w.period = stretch.period;
  w.t0 = stretch.t0 + static_cast<double>(begin) * stretch.period;
  w.hold_torque = stretch.hold_torque;
  w.n_rows = static_cast<std::size_t>(n_rows);
  w.n_axes = static_cast<std::size_t>(model.rigid ? n_joints : 2 * n_joints);
  for (Eigen::Index row = begin; row < begin + n_rows; ++row) {
    for (Eigen::Index k = 0; !model.rigid && k < n_joints; ++k) {
      w.position.push_back(stretch.q(row, k));
      w.held.push_back(0);
      w.sloping.push_back(by_column ? at(stretch.tau_load, row, k) : 0.0);
    }
    for (Eigen::Index k = 0; k < n_joints; ++k) {
      const double tau = at(stretch.tau, row, k);
      const double load = model.rigid && by_column ? at(stretch.tau_load, row, k) : 0.0;
      w.position.push_back(stretch.theta(row, k));
      w.held.push_back(stretch.hold_torque ? tau : 0.0);
      w.sloping.push_back(load + (stretch.hold_torque ? 0.0 : tau));
    }
  }
  return w;
}

void set_start(const Model& model, const MeasuredStretch& stretch, Eigen::Index row,
               const Eigen::VectorXd& position_sd, OutputErrorWindow& window) {
  const auto n_joints = static_cast<Eigen::Index>(model.joints.size());
  const auto add = [&](const Eigen::ArrayXXd& table, Eigen::Index joint, Eigen::Index axis) {
    const Eigen::ArrayXd column = table.col(joint);
    window.start_velocity.push_back(
        start_state(column, row, stretch.period, position_sd[axis]).velocity);
  };
  for (Eigen::Index k = 0; !model.rigid && k < n_joints; ++k) add(stretch.q, k, k);
  for (Eigen::Index k = 0; k < n_joints; ++k)
    add(stretch.theta, k, (model.rigid ? 0 : n_joints) + k);
}

}  // namespace

std::vector<OutputErrorWindow> cut_windows(const Model& model,
                                           const std::vector<MeasuredStretch>& stretches,
                                           double seconds, const Eigen::VectorXd& position_sd) {
  std::vector<OutputErrorWindow> windows;
  std::size_t number = 0;
  for (const MeasuredStretch& stretch : stretches) {
    const Eigen::Index n_rows = stretch.theta.rows();
    if (n_rows < kFewestStretchRows) continue;
    const double wanted = static_cast<double>(n_rows) * stretch.period / seconds;
    const auto n = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::llround(wanted)));
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Index begin = n_rows * i / n, end = n_rows * (i + 1) / n;
      windows.push_back(window_of(model, stretch, begin, end - begin));
      windows.back().first_number = number;
      set_start(model, stretch, begin, position_sd, windows.back());
      number += static_cast<std::size_t>(end - begin);
    }
  }
  return windows;
}

}  // namespace cablefit
