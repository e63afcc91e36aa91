// A Transmission laid out for the inner loop of the simulator: plain arrays, no allocation.
#pragma once

#include <array>
#include <vector>

#include "cablefit/model/cables.hpp"
#include "cablefit/model/effects.hpp"

namespace cablefit {

/// Of one cable at some positions.
struct Pull {
  double elongation = 0;  ///< m (joint space rad)
  double tension = 0;     ///< N (joint space N m)
};

class Coupling {
 public:
  explicit Coupling(const Transmission& transmission);

  std::size_t n_cables() const { return cables_.size(); }

  /// Of all cables at these positions (rad).
  void pull(const double* q, const double* theta, Pull* cables) const;
  /// tau_elas_l and tau_elas_m (N m, n_joints each) at the positions of `cables`.
  void torques(const double* q, const double* theta, const Pull* cables, double* link,
               double* motor) const;
  /// As set_elastic of effects.hpp, but for tau_elas, which `torques` gives.
  void look(std::size_t joint, const double* q, const double* theta, const Pull* cables,
            JointState& state) const;

 private:
  using LawFunction = void (*)(const LawShape& shape, double l, double* values);
  struct Strand {
    LawFunction basis = nullptr, slope = nullptr;
    LawShape shape = {};
    int n_coefficients = 0;
    std::array<double, kMaxCableOrder> coefficients = {};
    double slack = 0;             ///< l where every map is 0
    std::size_t first_joint = 0;  ///< into the radii below
    std::size_t maps = 0;         ///< into the maps below
    bool round = false;           ///< all its pulleys are round
  };

  /// theta - theta_0 of a joint.
  auto turned(const double* theta) const {
    return [this, theta](std::size_t k) { return theta[k] - theta_0_[k]; };
  }
  /// phi of the linear model, Transmission::deflections.
  double deflection(std::size_t joint, const double* q, const double* theta) const;
  /// sum_j coefficient_j values_j at elongation l; 0 when slack.
  static double combine(const Strand& strand, LawFunction values_of, double l);
  double stretch(const Strand& strand, const double* q, const double* theta) const;
  /// The same by the maps.
  double elongation(const Strand& strand, const double* q, const double* theta) const;
  /// Adds one cable's torques with its radii at these positions.
  void add_by_maps(const Strand& strand, double force, const double* q, const double* theta,
                   double* link, double* motor) const;

  std::size_t n_joints_;
  std::vector<Strand> cables_;
  std::vector<double> motor_radius_, link_radius_;    ///< [cable][joint], of round pulleys
  std::vector<Cable> maps_;                           ///< per cable, for its g and h
  std::vector<double> theta_0_;                       ///< per joint
  std::vector<double> stiffness_, reduction_, rest_;  ///< linear model, per joint
};

inline double Coupling::deflection(std::size_t joint, const double* q, const double* theta) const {
  return theta[joint] - rest_[joint] - reduction_[joint] * q[joint];
}

inline double Coupling::stretch(const Strand& strand, const double* q, const double* theta) const {
  if (!strand.round) return elongation(strand, q, theta);
  double l = strand.slack;
  const double* motor_radius = motor_radius_.data() + strand.first_joint;
  const double* link_radius = link_radius_.data() + strand.first_joint;
  for (std::size_t k = 0; k < n_joints_; ++k)
    l += motor_radius[k] * theta[k] - link_radius[k] * q[k];
  return l;
}

inline double Coupling::combine(const Strand& strand, LawFunction values_of, double l) {
  if (!(l > 0)) return 0.0;
  std::array<double, kMaxCableOrder> values;  // NOLINT(*-member-init): filled by the next call
  values_of(strand.shape, l, values.data());
  // The first apart: a pair of them, loaded at once, would wait until both stores are through.
  double sum = strand.coefficients[0] * values[0];
  for (std::size_t j = 1; j < static_cast<std::size_t>(strand.n_coefficients); ++j) {
    sum += strand.coefficients[j] * values[j];
  }
  return sum;
}

inline void Coupling::pull(const double* q, const double* theta, Pull* cables) const {
  for (std::size_t i = 0; i < cables_.size(); ++i) {
    cables[i].elongation = stretch(cables_[i], q, theta);
    cables[i].tension = combine(cables_[i], cables_[i].basis, cables[i].elongation);
  }
}

inline void Coupling::torques(const double* q, const double* theta, const Pull* cables,
                              double* link, double* motor) const {
  for (std::size_t k = 0; k < stiffness_.size(); ++k) {
    motor[k] = stiffness_[k] * deflection(k, q, theta);
    link[k] = reduction_[k] * motor[k];
  }
  if (cables_.empty()) return;
  for (std::size_t k = 0; k < n_joints_; ++k) link[k] = motor[k] = 0.0;
  for (std::size_t i = 0; i < cables_.size(); ++i) {
    const double f = cables[i].tension;
    if (!cables_[i].round) {
      add_by_maps(cables_[i], f, q, theta, link, motor);
      continue;
    }
    for (std::size_t k = 0; k < n_joints_; ++k) {
      link[k] += f * link_radius_[cables_[i].first_joint + k];
      motor[k] += f * motor_radius_[cables_[i].first_joint + k];
    }
  }
}

}  // namespace cablefit
