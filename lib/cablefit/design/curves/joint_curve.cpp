#include "cablefit/design/curves/joint_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/base/root.hpp"
#include "cablefit/model/stiffness.hpp"

namespace cablefit {
namespace {

constexpr double kFirstStep = 1e-7;  // rad; the outward search doubles it
constexpr int kScanSteps = 400;

double taut_margin(const JointCurve& curve, double phi) {
  return curve.elongations(phi).minCoeff();
}

int slackest(const JointCurve& curve, double phi) {
  Eigen::Index which = 0;
  curve.elongations(phi).minCoeff(&which);
  return static_cast<int>(which);
}

/// Where the first cable goes slack in this direction (+1, -1).
void find_end(const JointCurve& curve, double direction, double& deflection, double& torque,
              int& cable) {
  const auto end = root_outward([&](double phi) { return -taut_margin(curve, phi); },
                                direction * kFirstStep, direction * kFarthest);
  deflection = torque = direction * std::numeric_limits<double>::infinity();
  if (!end) return;
  deflection = *end;
  torque = curve.torque(deflection);
  cable = slackest(curve, deflection);
}

}  // namespace

JointCurve::JointCurve(const Transmission& transmission, int joint)
    : transmission_(&transmission),
      joint_(joint),
      q_(transmission.reference_q()),
      theta_(transmission.reference_theta()) {}

Eigen::VectorXd JointCurve::theta(double phi) const {
  Eigen::VectorXd theta = theta_ + transmission_->encoder_zero();
  theta(joint_) += phi;
  return theta;
}

double JointCurve::torque(double phi) const {
  Eigen::VectorXd link, motor;
  transmission_->torques(q_, theta(phi), link, motor);
  return motor(joint_);
}

double JointCurve::stiffness(double phi) const {
  return motor_stiffness(*transmission_, joint_, phi);
}

Eigen::VectorXd JointCurve::elongations(double phi) const {
  return transmission_->elongations(q_, theta(phi));
}

Eigen::VectorXd JointCurve::tensions(double phi) const {
  return transmission_->tensions(q_, theta(phi));
}

double JointCurve::tension_at_pulleys(double phi) const {
  return transmission_->motor_coupling(theta(phi)).row(joint_).cwiseAbs().dot(tensions(phi));
}

std::optional<double> JointCurve::deflection_at(double torque) const {
  const double sign = torque < 0 ? -1 : 1;
  const double rest = this->torque(0);
  if (!(sign * (torque - rest) > 0)) return 0.0;
  return root_outward([&](double phi) { return sign * (this->torque(phi) - torque); },
                      sign * kFirstStep, sign * kFarthest);
}

double ClosureRange::threshold() const {
  if (low == 0 && high == 0) return 0;
  return std::min(-torque_low, torque_high);
}

ClosureRange closure_range(const JointCurve& curve) {
  ClosureRange range;
  if (!(taut_margin(curve, 0) > 0)) return range;
  find_end(curve, -1, range.low, range.torque_low, range.cable_low);
  find_end(curve, 1, range.high, range.torque_high, range.cable_high);
  return range;
}

std::vector<double> smooth_pieces(const JointCurve& curve, double low, double high) {
  std::vector<double> ends = {low, high};
  if (low < 0 && high > 0) ends.push_back(0);  // where cables without preload end and begin
  for (std::size_t c = 0; c < curve.transmission().cables.size(); ++c) {
    const auto l = [&](double phi) { return curve.elongations(phi)(static_cast<Eigen::Index>(c)); };
    for (int i = 0; i < kScanSteps; ++i) {
      const double from = low + (high - low) * i / kScanSteps;
      const double to = low + (high - low) * (i + 1) / kScanSteps;
      if ((l(from) > 0) != (l(to) > 0)) ends.push_back(root_between(l, from, to));
    }
  }
  std::sort(ends.begin(), ends.end());
  const double least = 1e-12 * (high - low);
  ends.erase(
      std::unique(ends.begin(), ends.end(), [=](double a, double b) { return b - a <= least; }),
      ends.end());
  return ends;
}

}  // namespace cablefit
