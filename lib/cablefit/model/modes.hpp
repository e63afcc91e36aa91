// Functioning modes of a transmission, Fichera & Grossard 2017, section 2.4: force closure (12),
// all cables taut; force disclosure (13), at least one slack. Also the points where the mode
// changes, and whether the preload alone is in equilibrium, (8c). A cable is taut where l > 0.
// Positions in rad, theta as logged (theta_0 is subtracted here), torques in N m.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "cablefit/model/cables.hpp"

namespace cablefit {

enum class Mode { closure, disclosure };
std::string_view to_string(Mode mode);

using TautTable = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// Which cables are taut, n_samples x n_cables; q and theta: n_samples x n_joints.
TautTable taut_cables(const Transmission& transmission, const Eigen::MatrixXd& q,
                      const Eigen::MatrixXd& theta);
/// The mode of each row of such a table.
std::vector<Mode> modes(const TautTable& taut);

/// Elongation of a cable of a one-joint rig at the deflection phi (Transmission::deflections), with
/// the link in its reference position q_o.
double elongation_at(const Transmission& transmission, const Cable& cable, double phi);

/// Some cable has an initial elongation, so l_o is known. Otherwise slack points only state that
/// cables end at zero deflection.
bool is_preloaded(const Transmission& transmission);

/// Where a cable of a one-joint rig goes slack.
struct SlackPoint {
  std::size_t cable = 0;       ///< index into Transmission::cables
  double deflection = 0;       ///< phi
  double link = 0, motor = 0;  ///< tau_elas_l, tau_elas_m there
  bool slack_above = false;    ///< slack at larger deflections, else at smaller ones
};

/// Every change between taut and slack at deflections from `low` to `high`, with the link blocked
/// in its reference position: cable by cable, deflections ascending, exact to 1e-12 of the range. A
/// cable that changes twice within 1/400 of the range may be missed (with round pulleys a cable
/// changes once).
std::vector<SlackPoint> slack_points(const Transmission& transmission, double low, double high);

/// Modes over the positions of one joint, the others held.
struct ModeMap {
  Eigen::VectorXd q, theta;                 ///< the grid
  std::vector<Eigen::MatrixXd> elongation;  ///< l per cable, q.size() x theta.size()

  bool taut(std::size_t cable, Eigen::Index q_index, Eigen::Index theta_index) const {
    return elongation[cable](q_index, theta_index) > 0;
  }
  Mode mode(Eigen::Index q_index, Eigen::Index theta_index) const;
};

/// The map of `joint` (from 0). `pose` gives the positions of the other joints, n_joints each, its
/// theta as logged.
ModeMap mode_map(const Transmission& transmission, int joint, const Eigen::VectorXd& q,
                 const Eigen::VectorXd& theta, const ReferencePose& pose);

/// P f and S f in the reference pose: torques of the preload alone, 0 when it is in equilibrium
/// (8c). n_joints each.
struct PreloadTorques {
  Eigen::VectorXd link, motor;
};
/// N m; a smaller sum of cable torques is rounding, which differs between machines.
inline constexpr double kEquilibriumMet = 1e-9;
PreloadTorques preload_torques(const Transmission& transmission);

}  // namespace cablefit
