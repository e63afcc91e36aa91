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

  /// The torque per joint (N m) that acts after this command. The next command being unknown, a
  /// delay below two periods is that of a command that stays.
  const std::vector<double>& after(const std::vector<double>& command);

 private:
  double period_;
  bool is_needed_;
  std::vector<std::vector<RefinementInstance>> refinements_;  ///< per joint
  std::vector<Eigen::ArrayXd> commands_;                      ///< per joint, the latest last
  std::vector<double> acting_;
};

}  // namespace cablefit
