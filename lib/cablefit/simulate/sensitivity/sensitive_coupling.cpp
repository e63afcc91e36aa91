#include "cablefit/simulate/sensitivity/sensitive_coupling.hpp"

#include <algorithm>

namespace cablefit {

SensitiveCoupling::SensitiveCoupling(const Model& model,
                                     const std::vector<ModelParameter>& parameters,
                                     const std::vector<int>& columns)
    : n_joints_(model.joints.size()),
      n_axes_(model.rigid ? n_joints_ : 2 * n_joints_),
      is_rigid_(model.rigid),
      load_(model.rig.load) {
  stiffness_column_.assign(n_joints_, -1);
  zero_column_.assign(n_joints_, -1);
  stiffness_.assign(n_axes_ * n_axes_, 0.0);
  gradient_.assign(n_axes_, 0.0);
  if (!is_rigid_) transmission_ = model.transmission;
  for (const Cable& cable : transmission_.cables) {
    strands_.push_back({0, 0, std::vector<int>(cable.coefficients.size(), -1), -1});
  }
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const ModelParameter& p = parameters[k];
    const auto joint = static_cast<std::size_t>(p.joint);
    if (p.kind == ParameterKind::stiffness) stiffness_column_[joint] = columns[k];
    if (p.kind == ParameterKind::encoder_zero) zero_column_[joint] = columns[k];
    if (p.kind == ParameterKind::coefficient)
      strands_[p.cable].coefficient_column[p.index] = columns[k];
    if (p.kind == ParameterKind::elongation) strands_[p.cable].elongation_column = columns[k];
  }
  update(model);
}

void SensitiveCoupling::update(const Model& model) {
  if (is_rigid_) return;
  theta_0_.assign(n_joints_, 0.0);
  for (std::size_t k = 0; k < static_cast<std::size_t>(model.transmission.theta_0.size()); ++k)
    theta_0_[k] = model.transmission.theta_0[static_cast<Eigen::Index>(k)];
  transmission_.linear_stiffness = model.transmission.linear_stiffness;
  shift_.clear();
  for (std::size_t i = 0; i < strands_.size(); ++i) {
    transmission_.cables[i].coefficients = model.transmission.cables[i].coefficients;
    transmission_.cables[i].initial_elongation = model.transmission.cables[i].initial_elongation;
    shift_.push_back(transmission_.cables[i].shift());
  }
}

// F = -f dl/dx, because the cable's energy is the integral of f dl.
void SensitiveCoupling::add_cable(std::size_t i, const double* position, double* force) {
  const Cable& cable = transmission_.cables[i];
  const Strand& strand = strands_[i];
  double l = shift_[i];
  for (std::size_t k = 0; k < n_joints_; ++k) {
    const double motor = position[n_joints_ + k] - theta_0_[k];
    l += cable.motor_map[k].displacement(motor) - cable.link_map[k].displacement(position[k]);
  }
  if (!(l > 0)) return;
  std::array<double, kMaxCableOrder> basis, slope;  // NOLINT(*-member-init): filled here
  cable.law->basis(cable.shape(), l, basis.data());
  cable.law->slope(cable.shape(), l, slope.data());
  double f = 0, df = 0;
  for (std::size_t j = 0; j < cable.coefficients.size(); ++j) {
    f += cable.coefficients[j] * basis[j];
    df += cable.coefficients[j] * slope[j];
  }
  for (std::size_t k = 0; k < n_joints_; ++k) {
    const double motor = position[n_joints_ + k] - theta_0_[k];
    gradient_[k] = -cable.link_map[k].radius(position[k]);
    gradient_[n_joints_ + k] = cable.motor_map[k].radius(motor);
    stiffness_[k * n_axes_ + k] += f * cable.link_map[k].radius_slope(position[k]);
    const double bend = f * cable.motor_map[k].radius_slope(motor);
    stiffness_[(n_joints_ + k) * n_axes_ + n_joints_ + k] -= bend;
    if (zero_column_[k] >= 0 && bend != 0)
      entries_.push_back({n_joints_ + k, zero_column_[k], bend});
  }
  for (std::size_t a = 0; a < n_axes_; ++a) {
    force[a] -= f * gradient_[a];
    for (std::size_t b = 0; b < n_axes_; ++b)
      stiffness_[a * n_axes_ + b] -= df * gradient_[a] * gradient_[b];
    for (std::size_t k = 0; k < n_joints_; ++k)
      if (zero_column_[k] >= 0)
        entries_.push_back({a, zero_column_[k], df * gradient_[a] * gradient_[n_joints_ + k]});
    for (std::size_t j = 0; j < cable.coefficients.size(); ++j)
      if (strand.coefficient_column[j] >= 0)
        entries_.push_back({a, strand.coefficient_column[j], -basis[j] * gradient_[a]});
    if (strand.elongation_column >= 0)
      entries_.push_back({a, strand.elongation_column, -df * gradient_[a]});
  }
}

void SensitiveCoupling::add_spring(std::size_t joint, const double* position, double* force) {
  const std::size_t link = joint, motor = n_joints_ + joint;
  const double k = transmission_.linear_stiffness[static_cast<Eigen::Index>(joint)];
  const double stretch = position[motor] - theta_0_[joint] - position[link];
  force[link] += k * stretch;
  force[motor] -= k * stretch;
  stiffness_[link * n_axes_ + link] -= k;
  stiffness_[link * n_axes_ + motor] += k;
  stiffness_[motor * n_axes_ + link] += k;
  stiffness_[motor * n_axes_ + motor] -= k;
  if (stiffness_column_[joint] >= 0) {
    entries_.push_back({link, stiffness_column_[joint], stretch});
    entries_.push_back({motor, stiffness_column_[joint], -stretch});
  }
  if (zero_column_[joint] >= 0) {
    entries_.push_back({link, zero_column_[joint], -k});
    entries_.push_back({motor, zero_column_[joint], k});
  }
}

void SensitiveCoupling::add_load(const double* position, double* force) {
  if (!load_.law) return;
  for (std::size_t k = 0; k < n_joints_; ++k) {
    force[k] += load_.law->torque(load_.parameters, position[k]);
    if (load_.law->slope)
      stiffness_[k * n_axes_ + k] += load_.law->slope(load_.parameters, position[k]);
  }
}

void SensitiveCoupling::evaluate(const double* position, double* force) {
  std::fill(stiffness_.begin(), stiffness_.end(), 0.0);
  std::fill(force, force + n_axes_, 0.0);
  entries_.clear();
  add_load(position, force);
  if (is_rigid_) return;
  for (std::size_t i = 0; i < strands_.size(); ++i) add_cable(i, position, force);
  for (std::size_t k = 0; strands_.empty() && k < n_joints_; ++k) add_spring(k, position, force);
}

}  // namespace cablefit
