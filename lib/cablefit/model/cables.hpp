// Cable laws: force of one cable against its elongation. A cable only pulls: a slack cable (l <= 0)
// gives no force (Fichera & Grossard 2017, (4)). To add a law: one file, one line in cables.cpp.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cablefit {

/// Largest order of any law: a bound for small fixed arrays, far above what data can tell apart.
inline constexpr int kMaxCableOrder = 9;

/// Linear conditions under which a cable only pulls up to some elongation: rows * coefficients >= 0
/// imply k(l) = f(l)/l >= 0 there, (5) and (16).
struct PullConditions {
  Eigen::MatrixXd rows;  ///< conditions x coefficients
  Eigen::VectorXd at;    ///< elongation that each one speaks of, or is closest to
};

/// A law that is linear in its coefficients: f(l) = sum_j coefficient_j * basis_j(l) for l > 0.
struct CableLaw {
  std::string_view name;
  std::string_view equation;
  std::string_view source;
  /// Largest order this law has, at most kMaxCableOrder.
  int max_order;
  /// Number of coefficients of a law of this order (order >= 1), at most kMaxCableOrder.
  int (*n_coefficients)(int order);
  /// basis_j(l) for one elongation, l > 0; writes n_coefficients(order) values.
  void (*basis)(int order, double l, double* values);
  /// d basis_j / dl.
  void (*slope)(int order, double l, double* values);
  /// Conditions for 0 <= l <= longest.
  PullConditions (*pull_conditions)(int order, double longest);
};

std::span<const CableLaw> cable_laws();
const CableLaw& find_cable_law(std::string_view name);

/// One cable: its law, coefficients and initial elongation, and how its elongation follows from the
/// joints: l = sum_k motor_radius_k theta_k - link_radius_k q_k + l_o. In joint space (the paper's
/// (30)) radii are +1 for cable 1 and -1 for cable 2 and the coefficients are N m/rad^j.
struct Cable {
  std::string name;
  const CableLaw* law = nullptr;
  int order = 2;
  std::vector<double> coefficients;  ///< N/m^j, or N m/rad^j in joint space
  double initial_elongation = 0;     ///< l_o, m or rad
  Eigen::VectorXd motor_radius;      ///< one per joint, signed, m (joint space: +-1)
  Eigen::VectorXd link_radius;       ///< one per joint, signed, m (joint space: +-1)

  /// Tension (N; joint space N m) at this elongation; 0 when slack.
  double force(double l) const;
  /// df/dl; 0 when slack.
  double stiffness(double l) const;
  /// The paper's k(l) = f(l)/l, what (5) and (16) want non-negative.
  double secant(double l) const;

  int n_coefficients() const { return law->n_coefficients(order); }
};

/// Names and units of a cable's parameters in results. Joint space: "K1_0" in N m/rad, "K1_1" in
/// N m/rad^2; cable space: "k[left]_0" in N/m, "k[left]_1" in N/m^2. Elongation: "l_o[left]".
std::string coefficient_name(const Cable& cable, int index, bool cable_space);
std::string coefficient_unit(int index, bool cable_space);
std::string elongation_name(const Cable& cable);
std::string_view elongation_unit(bool cable_space);

/// The elastic transmission of a rig: all cables, or the classical linear spring (2), (29).
struct Transmission {
  int n_joints = 1;
  std::vector<Cable> cables;
  /// Linear model: stiffness per joint (N m/rad); used when `cables` is empty.
  Eigen::VectorXd linear_stiffness;
  /// Encoder zero of the deflection per joint: l uses theta - theta_0 (rad). Stage 1 estimates it.
  /// Empty: 0.
  Eigen::VectorXd theta_0;

  /// theta_0, n_joints long.
  Eigen::VectorXd encoder_zero() const;

  /// Elongation of each cable, l = g - h + l_o (4c). Sizes: q, theta n_joints; result n_cables.
  Eigen::VectorXd elongations(const Eigen::VectorXd& q, const Eigen::VectorXd& theta) const;
  /// tau_elas_l = P f and tau_elas_m = S f (8a)-(8b), n_joints each, N m.
  void torques(const Eigen::VectorXd& q, const Eigen::VectorXd& theta, Eigen::VectorXd& link,
               Eigen::VectorXd& motor) const;
};

/// The paper's rig: one joint, two antagonist cables named "1" and "2" in joint space, same order.
Transmission antagonist_pair(int order);
/// One such pair per joint; the cables of joint k (from 1) are named 2k-1 and 2k.
Transmission antagonist_pairs(int n_joints, int order);

}  // namespace cablefit
