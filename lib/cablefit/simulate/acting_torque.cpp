#include "cablefit/simulate/acting_torque.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/simulate/corrections.hpp"

namespace cablefit {
namespace {

constexpr double kLongestDelay = 0.02;  // s, see effects.hpp
constexpr double kFinest = 125e-6;      // s
constexpr int kMostParts = 8;

}  // namespace

ActingTorque::ActingTorque(const Model& model, double period)
    : is_needed_(corrects(model)),
      n_parts_(std::clamp(static_cast<int>(std::lround(period / kFinest)), 1, kMostParts)),
      part_(period / static_cast<double>(n_parts_)),
      held_(model.joints.size()),
      parts_(n_parts_, static_cast<Eigen::Index>(model.joints.size())),
      acting_(model.joints.size()) {
  for (const JointModel& joint : model.joints) refinements_.push_back(joint.added);
}

void ActingTorque::command(const std::vector<double>& tau) {
  for (std::size_t k = 0; k < tau.size(); ++k) {
    Eigen::ArrayXd& held = held_[k];
    if (held.size() == 0) {
      const auto before = static_cast<Eigen::Index>(std::ceil(kLongestDelay / part_));
      held.setConstant(before + n_parts_ + 2, tau[k]);
    }
    std::copy(held.begin() + n_parts_, held.end(), held.begin());
    held.tail(n_parts_).setConstant(tau[k]);
    Recording recording{part_, {}, {}, held, {}};
    correct(refinements_[k], recording);
    parts_.col(static_cast<Eigen::Index>(k)) = recording.tau.tail(n_parts_);
  }
}

const std::vector<double>& ActingTorque::at(double fraction) {
  const auto part = static_cast<Eigen::Index>(fraction * static_cast<double>(n_parts_));
  for (std::size_t k = 0; k < acting_.size(); ++k)
    acting_[k] =
        parts_(std::clamp<Eigen::Index>(part, 0, n_parts_ - 1), static_cast<Eigen::Index>(k));
  return acting_;
}

}  // namespace cablefit
