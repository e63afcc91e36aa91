#include "cablefit/elastic/estimates/elastic_quantities.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "cablefit/model/modes.hpp"
#include "cablefit/model/stiffness.hpp"

namespace cablefit {
namespace {

// rad or m to either side of the reference pose: beyond what an l_o of about 0 is known to, so that
// a pair without preload has the mean of its cables' slopes, whichever side of 0 its l_o fell.
constexpr double kBeside = 2e-5;

/// Of all slack points the one of that cable on that side; NaN when the values have none there.
double slack_value(const Transmission& transmission, const UsedDeflections& used,
                   const SlackPoint& wanted, double SlackPoint::*member) {
  for (const SlackPoint& point : slack_points(transmission, used.low, used.high))
    if (point.cable == wanted.cable && point.slack_above == wanted.slack_above)
      return point.*member;
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double rest_stiffness(const Transmission& transmission) {
  if (transmission.cables.empty()) return transmission.linear_stiffness(0);
  // Each side's slope as it goes towards the pose, by the straight line through two of its points.
  const auto towards = [&](double side) {
    return 2 * motor_stiffness(transmission, 0, side * kBeside) -
           motor_stiffness(transmission, 0, 2 * side * kBeside);
  };
  return 0.5 * (towards(-1) + towards(1));
}

TransmissionOf transmission_of(const Transmission& transmission, bool cable_space,
                               const JointEstimates& from) {
  struct Entry {
    std::size_t cable = 0;
    int coefficient = 0;  // -1: l_o
    Eigen::Index at = 0;
  };
  std::vector<Entry> places;
  for (std::size_t c = 0; c < transmission.cables.size(); ++c) {
    const Cable& cable = transmission.cables[c];
    for (int j = 0; j < cable.n_coefficients(); ++j)
      if (const Eigen::Index at = from.find(coefficient_name(cable, j, cable_space)); at >= 0)
        places.push_back({c, j, at});
    if (const Eigen::Index at = from.find(elongation_name(cable)); at >= 0)
      places.push_back({c, -1, at});
  }
  const Eigen::Index stiffness = from.find("K");
  return [=](const Eigen::VectorXd& value) {
    Transmission changed = transmission;
    if (changed.cables.empty() && stiffness >= 0) changed.linear_stiffness(0) = value(stiffness);
    for (const Entry& place : places) {
      Cable& cable = changed.cables[place.cable];
      if (place.coefficient < 0)
        cable.initial_elongation = value(place.at);
      else
        cable.coefficients[static_cast<std::size_t>(place.coefficient)] = value(place.at);
    }
    return changed;
  };
}

namespace {

/// Of the torque of one joint against the angle of another: "N/rad", "N m/m".
std::string stiffness_unit(Axes torque, Axes angle) {
  return torque_unit(torque) + "/" + unit_for(angle, "rad");
}

/// d tau_m/dtheta at rest of several joints, symmetric: "K_rest[1,2]". Without preload no cable is
/// taut there, and there is none.
std::vector<DerivedQuantity> rest_matrix(const Transmission& transmission, bool cable_space,
                                         const JointAxes& axes, const JointEstimates& from) {
  std::vector<DerivedQuantity> all;
  if (!is_preloaded(transmission)) return all;
  const TransmissionOf changed = transmission_of(transmission, cable_space, from);
  const Eigen::VectorXd q = transmission.reference_q();
  const Eigen::VectorXd theta = transmission.reference_theta() + transmission.encoder_zero();
  for (Eigen::Index i = 0; i < transmission.n_joints; ++i)
    for (Eigen::Index j = i; j < transmission.n_joints; ++j)
      all.push_back({fmt::format("K_rest[{},{}]", i + 1, j + 1), "K_rest",
                     stiffness_unit(axes.of(static_cast<int>(i)), axes.of(static_cast<int>(j))),
                     [changed, q, theta, i, j](const Eigen::VectorXd& v) {
                       return stiffness_matrices(changed(v), q, theta).motor_theta(i, j);
                     }});
  return all;
}

}  // namespace

std::vector<DerivedQuantity> elastic_quantities(const Transmission& transmission, bool cable_space,
                                                const JointAxes& joint_axes,
                                                const UsedDeflections& used,
                                                const JointEstimates& from) {
  std::vector<DerivedQuantity> all;
  if (transmission.cables.empty()) return all;
  if (transmission.n_joints > 1) return rest_matrix(transmission, cable_space, joint_axes, from);
  const Axes axes = joint_axes.all();
  const TransmissionOf changed = transmission_of(transmission, cable_space, from);
  all.push_back({"K_rest", "K_rest", unit_for(axes, "N m/rad"),
                 [changed](const Eigen::VectorXd& v) { return rest_stiffness(changed(v)); }});
  if (!is_preloaded(transmission)) return all;
  for (const SlackPoint& point : slack_points(transmission, used.low, used.high)) {
    std::string cable = fmt::format("[{}]", transmission.cables[point.cable].name);
    if (all.back().name == "tau_slack" + cable) cable += "'";  // taut in a range only
    all.push_back({"phi_slack" + cable, "phi_slack", unit_for(axes, "rad"),
                   [changed, used, point](const Eigen::VectorXd& v) {
                     return slack_value(changed(v), used, point, &SlackPoint::deflection);
                   }});
    all.push_back({"tau_slack" + cable, "tau_slack", torque_unit(axes),
                   [changed, used, point](const Eigen::VectorXd& v) {
                     return slack_value(changed(v), used, point, &SlackPoint::motor);
                   }});
  }
  return all;
}

}  // namespace cablefit
