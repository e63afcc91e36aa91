// Cable laws: force of one cable as a function of its elongation. A cable only pulls: a slack cable
// (l <= 0) gives no force (Fichera & Grossard 2017, (4)). To add a law: one file, one line in
// cables.cpp.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/model/pair_maps/side_maps.hpp"

namespace cablefit {

/// Largest order of any law: a bound for small fixed arrays, far above the order that data can
/// determine.
inline constexpr int kMaxCableOrder = 9;

/// Linear conditions under which a cable only pulls up to some elongation: rows * coefficients >= 0
/// imply k(l) = f(l)/l >= 0 there, (5) and (16).
struct PullConditions {
  Eigen::MatrixXd rows;  ///< conditions x coefficients
  Eigen::VectorXd at;    ///< elongation of each condition, or the nearest one
};

/// The fixed data of a law besides the elongation: never fitted linearly.
struct LawShape {
  int order = 2;
  double toe = 0;  ///< m (rad in joint space), > 0 for laws with a toe
};

/// A law that is linear in its coefficients: f(l) = sum_j coefficient_j * basis_j(l) for l > 0.
/// Each basis_j is 0 at l = 0, not negative and non-decreasing. It does not depend on the order: a
/// law of lower order is the same law with its last coefficients 0.
struct CableLaw {
  std::string_view name;
  std::string_view equation;
  std::string_view source;
  std::string_view coefficients;  ///< their meaning, and the sign that is physical
  /// Largest order of this law, at most kMaxCableOrder. The order of a polynomial is that of its
  /// force. For any law, more data can support a higher order.
  int max_order;
  bool has_toe;  ///< needs LawShape::toe (rig file "toe")
  /// Number of coefficients of a law of this order (order >= 1), at most kMaxCableOrder.
  int (*n_coefficients)(int order);
  /// The unit of coefficient j is force per length to this power.
  int (*length_power)(int index);
  /// basis_j(l) for one elongation, l > 0; writes n_coefficients(order) values.
  void (*basis)(const LawShape& shape, double l, double* values);
  /// d basis_j / dl.
  void (*slope)(const LawShape& shape, double l, double* values);
  /// Integral of basis_j from 0 to l: energy per unit coefficient, (6).
  void (*energy)(const LawShape& shape, double l, double* values);
  /// Conditions for 0 <= l <= longest.
  PullConditions (*pull_conditions)(const LawShape& shape, double longest);
};

std::span<const CableLaw> cable_laws();
const CableLaw& find_cable_law(std::string_view name);

/// One cable: its law, coefficients, initial elongation and routing. l = g(theta) - h(q) + l_o,
/// counted from the reference pose, where g and h are sums of maps of one joint and of two. In
/// joint space (the paper's (30)) the maps are +1 for cable 1 and -1 for cable 2, and the
/// coefficients are in N m/rad^j.
struct Cable {
  std::string name;
  const CableLaw* law = nullptr;
  int order = 2;
  double toe = 0;                          ///< see LawShape
  std::vector<double> coefficients;        ///< N/m^j, or N m/rad^j in joint space
  double initial_elongation = 0;           ///< l_o, m or rad
  std::vector<DisplacementMap> motor_map;  ///< g_k, one per joint, of theta_k - theta_0,k
  std::vector<DisplacementMap> link_map;   ///< h_k, one per joint, of q_k
  std::vector<PairMap> motor_pairs = {}, link_pairs = {};  ///< shares of g and h by two joints
  double reference_displacement = 0;  ///< g - h in the reference pose, where l = l_o

  /// g, of theta - theta_0, and h, of q.
  SideMaps motor_side() const { return {motor_map, motor_pairs}; }
  SideMaps link_side() const { return {link_map, link_pairs}; }
  bool has_pairs() const { return !motor_pairs.empty() || !link_pairs.empty(); }

  /// l at these positions, n_joints each; `theta` without the encoder zero.
  double elongation(const Eigen::VectorXd& q, const Eigen::VectorXd& theta) const;
  /// Column of S: dg/dtheta, m. Column of P: dh/dq, m.
  Eigen::VectorXd motor_radii(const Eigen::VectorXd& theta) const;
  Eigen::VectorXd link_radii(const Eigen::VectorXd& q) const;
  /// l with every map at 0: the constant added to g - h of the maps.
  double shift() const { return initial_elongation - reference_displacement; }

  /// Tension (N; joint space N m) at this elongation; 0 when slack.
  double force(double l) const;
  /// df/dl; 0 when slack.
  double stiffness(double l) const;
  /// The paper's k(l) = f(l)/l, non-negative by (5) and (16).
  double secant(double l) const;
  /// Elastic energy (6), J; 0 when slack.
  double energy(double l) const;

  /// Whether the joint (from 0) moves the cable, by its motor or its link.
  bool passes(std::size_t joint) const {
    return motor_side().passes(joint) || link_side().passes(joint);
  }

  int n_coefficients() const { return law->n_coefficients(order); }
  LawShape shape() const { return {order, toe}; }
};

/// Names and units of a cable's parameters in results. Joint space: "K1_0" in N m/rad, "K1_1" in
/// N m/rad^2; cable space: "k[left]_0" in N/m, "k[left]_1" in N/m^2. Elongation: "l_o[left]".
std::string coefficient_name(const Cable& cable, int index, bool cable_space);
std::string coefficient_unit(const CableLaw& law, int index, bool cable_space);
std::string elongation_name(const Cable& cable);
std::string_view elongation_unit(bool cable_space);

/// The elastic transmission of a rig: all cables, or the classical linear spring (2), (29).
struct Transmission {
  int n_joints = 1;
  std::vector<Cable> cables;
  /// Cables whose law the logs do not determine because they hardly load them. The torque is
  /// unknown where one of them is taut. refine leaves out those samples; all other commands treat
  /// such a cable as slack. A model file does not have their l_o.
  std::vector<Cable> idle_cables = {};
  /// Linear model: stiffness per joint (N m/rad, on the motor); used when `cables` is empty.
  Eigen::VectorXd linear_stiffness;
  /// Linear model: reduction N per joint, which classical_spring takes from the pulleys; empty: 1.
  Eigen::VectorXd linear_reduction;
  /// Encoder zero of the deflection per joint: l uses theta - theta_0 (rad). Stage 1 estimates it.
  /// Empty: 0.
  Eigen::VectorXd theta_0;
  /// The pose with l = l_o; set it by set_reference.
  ReferencePose reference;

  /// theta_0, n_joints long.
  Eigen::VectorXd encoder_zero() const;
  /// q_o and theta_o, n_joints long; theta_o is counted from the encoder zero.
  Eigen::VectorXd reference_q() const;
  Eigen::VectorXd reference_theta() const;

  /// N per joint: when the link turns by q and the motor by N q, no cable stretches. From the radii
  /// in the reference pose, sum(r_m r_l) / sum(r_m^2) over the joint's cables (least squares where
  /// they differ). 1 where motor and link have pulleys of one radius.
  Eigen::VectorXd reductions() const;
  /// phi = theta - theta_0 - N q of a joint (from 0), rad, sample by sample; theta and q are
  /// counted from the reference pose.
  Eigen::ArrayXd deflections(int joint, const Eigen::Ref<const Eigen::ArrayXd>& q,
                             const Eigen::Ref<const Eigen::ArrayXd>& theta) const;

  /// Elongation of each cable, l = g - h + l_o (4c). Sizes: q, theta n_joints; result n_cables.
  Eigen::VectorXd elongations(const Eigen::VectorXd& q, const Eigen::VectorXd& theta) const;
  /// Tension of each cable (4), N, n_cables.
  Eigen::VectorXd tensions(const Eigen::VectorXd& q, const Eigen::VectorXd& theta) const;
  /// P = -(d(g-h)/dq)^T and S = (d(g-h)/dtheta)^T, n_joints x n_cables, m. As g depends on theta
  /// alone and h on q alone, P depends on q and S on theta.
  Eigen::MatrixXd link_coupling(const Eigen::VectorXd& q) const;
  Eigen::MatrixXd motor_coupling(const Eigen::VectorXd& theta) const;
  /// tau_elas_l = P f and tau_elas_m = S f (8a)-(8b), n_joints each, N m. Linear model: N K phi and
  /// K phi, (2b)-(2c) with the reduction.
  void torques(const Eigen::VectorXd& q, const Eigen::VectorXd& theta, Eigen::VectorXd& link,
               Eigen::VectorXd& motor) const;
  /// Elastic energy U(q, theta) (6), (9), J: dU/dq = -tau_elas_l, dU/dtheta = tau_elas_m.
  double energy(const Eigen::VectorXd& q, const Eigen::VectorXd& theta) const;
};

/// The classical spring (2), (29) in place of these cables, with stiffness 0: tau_elas_m = K phi,
/// tau_elas_l = N K phi with phi = theta - theta_0 - N q.
Transmission classical_spring(const Transmission& cables);

/// The same cables with these coefficients, cable by cable.
Transmission with_coefficients(Transmission transmission, const Eigen::VectorXd& x);

/// Sets the pose in which every l = l_o.
void set_reference(Transmission& transmission, const ReferencePose& pose);

/// Of the cables' polynomials where nothing else is given: the paper's.
inline constexpr int kDefaultOrder = 2;

/// The paper's rig: one joint, two antagonist cables named "1" and "2" in joint space, same order.
Transmission antagonist_pair(int order);
/// One such pair per joint; the cables of joint k (from 1) are named 2k-1 and 2k.
Transmission antagonist_pairs(int n_joints, int order);

}  // namespace cablefit
