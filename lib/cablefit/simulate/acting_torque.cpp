#include "cablefit/simulate/acting_torque.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/simulate/corrections.hpp"

namespace cablefit {
namespace {

constexpr double kLongestDelay = 0.02;  // s, see refinements.hpp

}  // namespace

ActingTorque::ActingTorque(const Model& model, double period)
    : period_(period), is_needed_(corrects(model)), commands_(model.joints.size()) {
  for (const JointModel& joint : model.joints) refinements_.push_back(joint.refinements);
}

const std::vector<double>& ActingTorque::after(const std::vector<double>& command) {
  if (!is_needed_) return command;
  acting_ = command;
  for (std::size_t k = 0; k < command.size(); ++k) {
    Eigen::ArrayXd& last = commands_[k];
    if (last.size() == 0) {
      const auto rows = static_cast<Eigen::Index>(std::ceil(kLongestDelay / period_)) + 4;
      last.setConstant(std::min(rows, kCorrectionHalo), command[k]);
    }
    std::copy(last.begin() + 1, last.end(), last.begin());
    last[last.size() - 1] = command[k];
    Recording recording{period_, {}, {}, last, {}};
    correct(refinements_[k], recording);
    acting_[k] = recording.tau[last.size() - 1];
  }
  return acting_;
}

}  // namespace cablefit
