// Smooth motion of a recording, and the rows of the equations that it gives. Internal to refine/.
//
// One kernel S smooths every signal, and nonlinear columns are computed from the result. Then one
// kernel F smooths all columns and both left sides (parallel filtering; Gautier & Poignet 2001), so
// that a reversal of friction and the torque are smoothed equally.
#pragma once

#include <vector>

#include "cablefit/model/effects.hpp"
#include "cablefit/refine/rows/kernel.hpp"
#include "cablefit/refine/rows/stretches.hpp"

namespace cablefit {

/// Widths of the kernels, s.
struct Smoothing {
  double signals = 2.5e-3, columns = 5e-3;
  Eigen::Index stride = 8;  ///< samples from row to row
  Eigen::Index every = 2;   ///< samples between two evaluations of a candidate
  double period = 1e-3;     ///< s, of these samples
  double row_period() const { return static_cast<double>(stride) * period; }  ///< s, between rows
  double least_speed_theta = 0, least_speed_q = 0;  ///< rad/s; slower rows are at rest
  double least_speed_blocked = 0;                   ///< of theta, while the link is blocked
};

/// In widths of the columns' kernel. Rows at this distance contain nearly all information of denser
/// rows, even on the edges of fast signals. A candidate is evaluated more often than the kernel
/// alone requires: otherwise noise of accelerations would alias into its columns.
inline constexpr double kRowSpacing = 1.6, kEvaluationSpacing = 0.5;

/// Samples between rows, a multiple of `every`.
Eigen::Index stride_for(double columns, double period, Eigen::Index every);

/// For a recording of this period (s): the default widths, wider where the sampling is coarse.
Smoothing smoothing_for(double period);
/// The smoothing for a stretch of another period: the same kernel widths where the sampling is fine
/// enough, and the same distance of rows and evaluations.
Smoothing suited(const Smoothing& smoothing, double period);

/// How often a candidate is evaluated. `coarse`, once per row, is sufficient to choose among many
/// candidates. It is not sufficient for a fit, because noise of the speed aliases into such
/// columns.
enum class Evaluation { fine, coarse };

enum class RowKind { link, motor, blocked };
inline constexpr std::size_t kRowKinds = 3;
std::string_view to_string(RowKind kind);

/// Motion of a stretch at its full rate, n samples each.
struct SmoothMotion {
  double t0 = 0, period = 0;
  Eigen::ArrayXd q, qd, qdd, theta, thetad, thetadd;
  Eigen::ArrayXd tau, tau_load;                 ///< smoothed; tau at the time it acts
  Eigen::ArrayXd q_direction, theta_direction;  ///< -1, 0, 1
  Eigen::ArrayXXd others;                       ///< see Recording; smoothed
  Eigen::ArrayXXd links, links_d;               ///< of linked joints, samples x joints; or none
  Eigen::ArrayXXd links_dd;                     ///< of an arm
  Eigen::Index size() const { return theta.size(); }
};

/// Mean delay of a logged torque, as a share of the sample period: half of the time for which the
/// drive holds it, 0 without a hold.
double torque_lateness(const Rig& rig, double period);

/// `late`: see torque_lateness. `of_arm`: with the accelerations of all links.
SmoothMotion smooth_motion_of(const Recording& recording, double t0, double late,
                              const Smoothing& smoothing, bool of_arm);

/// Only tau, at every `every`-th sample. With `every` above 1 it is 0 within the kernel of the
/// ends.
Eigen::ArrayXd smooth_torque(const Recording& recording, double late, const Smoothing& smoothing,
                             Eigen::Index every = 1);

/// Samples at which an equation has a row, multiples of the stride: far enough from the ends, and
/// without rest of the own axis within reach of the kernel.
std::vector<Eigen::Index> moving_rows(const Eigen::ArrayXd& speed, double least_speed,
                                      double period, const Smoothing& smoothing);

/// States of the model's cables at every sample, with the motion.
std::vector<JointState> joint_states(const SmoothMotion& motion, const Model& model,
                                     const Smoothing& smoothing);

/// 99 % quantile of the values; 0 without values.
double most_of(std::vector<double> values);

}  // namespace cablefit
