// What a drive makes of a controller's commands, by the refinements of a model that correct logged
// torques: delays, limits, dead bands. Internal to the simulator.
#pragma once

#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

class ActingTorque {
 public:
  /// `period`: between commands, s.
  ActingTorque(const Model& model, double period);

  /// False: every command acts as it is, and there is nothing to ask.
  bool is_needed() const { return is_needed_; }
  /// A command per joint (N m), held over the period that begins now.
  void command(const std::vector<double>& tau);
  /// The torque per joint that acts a `fraction` (0 .. 1) of the period later.
  const std::vector<double>& at(double fraction);

 private:
  bool is_needed_;
  Eigen::Index n_parts_;  ///< of a period, in which delays are resolved
  double part_;           ///< s
  std::vector<std::vector<EffectInstance>> refinements_;  ///< per joint
  std::vector<Eigen::ArrayXd> held_;  ///< per joint: commands by parts, to the period's end
  Eigen::ArrayXXd parts_;             ///< parts of the period x joints: what acts
  std::vector<double> acting_;
};

}  // namespace cablefit
