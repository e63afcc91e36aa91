// Smooth motion of a recording, and which rows of the equations it gives. Internal to refine/.
//
// Every signal is smoothed by one kernel S, nonlinear columns are formed from that, and then all
// columns and both left sides go through one kernel F (parallel filtering; Gautier & Poignet 2001),
// so that a smoothed switch of friction stands against an equally smoothed torque.
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
  Eigen::Index every = 2;   ///< samples from one evaluation of a candidate to the next
  double period = 1e-3;     ///< s, of these samples
  double row_period() const { return static_cast<double>(stride) * period; }  ///< s, row to row
  double least_speed_theta = 0, least_speed_q = 0;  ///< rad/s; slower rows are at rest
  double least_speed_blocked = 0;                   ///< of theta, while the link is blocked
};

/// In widths of the columns' kernel. Rows at this distance show of slow signals what denser ones
/// show, and of the edges of fast ones nearly that. A candidate is evaluated more often than the
/// kernel alone needs: noise of accelerations would fold into its columns.
inline constexpr double kRowSpacing = 1.6, kEvaluationSpacing = 0.5;

/// Samples from row to row, a multiple of `every`.
Eigen::Index stride_for(double columns, double period, Eigen::Index every);

/// For a recording of this period (s): the widths above, wider where the sampling is coarse.
Smoothing smoothing_for(double period);
/// The same for a stretch of another period: kernels as wide where that is sampled finely enough,
/// rows and evaluations as far apart.
Smoothing suited(const Smoothing& smoothing, double period);

/// How often a candidate is evaluated. `coarse`, once per row, is enough to choose among many;
/// noise of the speed folds into such columns, so that they are not for a fit.
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
  Eigen::ArrayXXd links, links_d, links_dd;     ///< of all joints, samples x joints; or none
  Eigen::Index size() const { return theta.size(); }
};

/// How late a logged torque acts on average, as a share of the time between samples: half of what
/// the drive holds it, 0 where it does not.
double torque_lateness(const Rig& rig, double period);

/// `late`: see torque_lateness.
SmoothMotion smooth_motion_of(const Recording& recording, double t0, double late,
                              const Smoothing& smoothing);

/// Only its tau, at every so many of the samples. Fewer than all: 0 within the kernel of the ends.
Eigen::ArrayXd smooth_torque(const Recording& recording, double late, const Smoothing& smoothing,
                             Eigen::Index every = 1);

/// Samples at which an equation has a row, multiples of the stride: far enough from the ends, and
/// no rest of the own axis within reach of the kernel.
std::vector<Eigen::Index> moving_rows(const Eigen::ArrayXd& speed, double least_speed,
                                      double period, const Smoothing& smoothing);

/// What the model's cables do at every sample, beside the motion.
std::vector<JointState> joint_states(const SmoothMotion& motion, const Model& model);

/// What all but the largest hundredth of the values stay below; 0 without values.
double most_of(std::vector<double> values);

}  // namespace cablefit
