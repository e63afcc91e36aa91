// Friction of cables over the pulleys of the joints that they pass. Cable i runs over the pulley of
// joint k at the speed
//   v_ik = sum over joints j >= k of r_ij qd_j          (r_ij: its link radii, m)
// against the link before, and what is behind the pulley has mu T_i sgn(v_ik) less of the tension
// T_i: capstan friction (Euler 1769; Kaneko et al. 1991) to first order in mu, in the sense of
// virtual work. Joints are passed in the order of the rig.
#pragma once

#include <span>
#include <vector>

#include "cablefit/model/cables.hpp"

namespace cablefit {

/// Of a cable that passes links of several joints.
bool rubs_on_path(const Cable& cable);

class PathFriction {
 public:
  PathFriction() = default;
  /// `cables`: with the link maps of the same joints, by which the calls below count; those with a
  /// map of two joints are left out.
  /// `reversal`: m, after which 63 % of the friction has turned (Dahl 1968), so that cables at rest
  /// stick in a simulation; 0: it turns at once. None rubs at the beginning.
  PathFriction(std::vector<Cable> cables, double reversal);

  /// No cable passes links of several joints: this is friction of the joints themselves.
  bool is_empty() const { return paths_.empty(); }

  /// The links move at `qd` (rad/s) for h (s) from `q` on (rad); one per joint.
  void advance(std::span<const double> q, std::span<const double> qd, double h);
  /// N m that oppose the motion of link `joint` (from 0), per unit of mu. `tension`: N, per cable.
  double on_link(std::size_t joint, std::span<const double> q,
                 std::span<const double> tension) const;

 private:
  /// A pulley that a cable passes.
  struct Pulley {
    std::size_t joint = 0;
    double sign = 0;  ///< -1 .. 1: sgn(v_ik) after a short way
  };
  struct Path {
    std::size_t cable = 0;
    std::vector<Pulley> pulleys;  ///< from the base on
  };

  std::vector<Cable> cables_;
  double reversal_ = 0;
  std::vector<Path> paths_;
};

}  // namespace cablefit
