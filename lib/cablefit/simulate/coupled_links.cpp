#include "cablefit/simulate/coupled_links.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

/// Half a step on, by what it changed in the step before; no further than to rest.
double middle_of(double velocity, double change) {
  const double middle = velocity + 0.5 * change;
  return middle * velocity > 0 ? middle : velocity;
}

}  // namespace

CoupledLinks::CoupledLinks(const Arm& arm, const std::vector<Estimate>& base,
                           const std::vector<Axis>& links)
    : n_(links.size()),
      arm_(arm_dynamics(arm, base)),
      friction_(n_),
      levels_(n_),
      impulses_(n_),
      torque_(n_),
      inertia_(n_),
      matrix_(n_ * n_),
      right_(n_),
      moved_(n_),
      middle_(n_),
      change_(n_) {
  for (const Axis& link : links) own_.push_back(link.friction());
}

void CoupledLinks::start(const double* q, const double* qd) {
  arm_.evaluate(q, qd);
  std::fill(inertia_.begin(), inertia_.end(), 0.0);
  std::copy_n(arm_.mass(), n_ * n_, matrix_.begin());
  is_sane_ = factorise(matrix_.data(), n_);
}

void CoupledLinks::push(std::size_t joint, double torque, const Axis::Extra& extra) {
  torque_[joint] = torque - own_[joint].constant;
  inertia_[joint] = extra.inertia;
  CoupledFriction::Law& level = levels_[joint];
  level.up = std::max(own_[joint].level + extra.up, 0.0);
  level.down = std::max(own_[joint].level + extra.down, 0.0);
}

void CoupledLinks::advance(const double* q, double* qd, double h) {
  for (std::size_t k = 0; k < n_; ++k) middle_[k] = middle_of(qd[k], change_[k]);
  arm_.evaluate(q, middle_.data());
  std::copy_n(qd, n_, change_.begin());
  double left = h;
  for (std::size_t stops = 0; left > 0 && stops < 3 * n_; ++stops)
    left = advance_until_stop(qd, left);
  if (left > 0) advance_to_end(qd, left);
  for (std::size_t k = 0; k < n_; ++k) change_[k] = qd[k] - change_[k];
}

double CoupledLinks::net_torque(std::size_t joint, double velocity) const {
  return torque_[joint] - arm_.bias()[joint] - own_[joint].damping * velocity;
}

void CoupledLinks::fill_matrix(double time) {
  std::copy_n(arm_.mass(), n_ * n_, matrix_.begin());
  for (std::size_t k = 0; k < n_; ++k)
    matrix_[k * (n_ + 1)] += inertia_[k] + 0.5 * time * own_[k].damping;
}

double CoupledLinks::advance_until_stop(double* qd, double time) {
  fill_matrix(time);
  for (std::size_t k = 0; k < n_; ++k) {
    const CoupledFriction::Law& level = levels_[k];
    const double sliding = qd[k] > 0 ? level.up : qd[k] < 0 ? -level.down : 0;
    right_[k] = time * (net_torque(k, qd[k]) - sliding);
    impulses_[k] = {time * level.up, time * level.down, qd[k] == 0 && is_dry(k)};
  }
  if (!friction_.solve(matrix_.data(), right_.data(), impulses_.data(), moved_.data())) {
    is_sane_ = false;
    return 0;
  }
  double way = 1;
  for (std::size_t k = 0; k < n_; ++k)
    if (comes_to_rest(k, qd)) way = std::min(way, -qd[k] / moved_[k]);
  for (std::size_t k = 0; k < n_; ++k) {
    const bool stops = comes_to_rest(k, qd) && -qd[k] / moved_[k] <= way;
    qd[k] = stops ? 0.0 : qd[k] + way * moved_[k];
  }
  return time * (1 - way);
}

void CoupledLinks::advance_to_end(double* qd, double time) {
  fill_matrix(time);
  for (std::size_t k = 0; k < n_; ++k) {
    right_[k] = time * net_torque(k, qd[k]);
    for (std::size_t j = 0; j < n_; ++j) right_[k] += matrix_[n_ * k + j] * qd[j];
    impulses_[k] = {time * levels_[k].up, time * levels_[k].down, is_dry(k)};
  }
  is_sane_ = friction_.solve(matrix_.data(), right_.data(), impulses_.data(), qd) && is_sane_;
}

}  // namespace cablefit
