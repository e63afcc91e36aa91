#include "cablefit/design/design_spread.hpp"

#include <array>
#include <cmath>
#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/design/curves/equilibrium_preload.hpp"

namespace cablefit {
namespace {

/// Quantities with an sd, in the order of DesignSpread's members.
constexpr std::array<double DesignSpread::*, 5> kMembers = {
    &DesignSpread::closure_torque, &DesignSpread::stiffness_zero, &DesignSpread::stiffness_low,
    &DesignSpread::stiffness_high, &DesignSpread::efficiency_driving};

std::array<double, 5> numbers_of(const DesignJoint& joint) {
  return {joint.closure_torque, joint.stiffness_zero, joint.stiffness_low, joint.stiffness_high,
          joint.friction ? joint.friction->efficiency_driving : kNotKnown};
}

/// Only what has an sd is asked for: no simpler models, no collisions.
DesignOptions numbers_only(const DesignOptions& options) {
  DesignOptions only;
  only.torque = options.torque;
  only.tension_friction = options.tension_friction;
  only.friction = options.friction;
  only.orders.clear();
  return only;
}

std::optional<DesignJoint> described(const Model& model, const DesignPoint& point, int number,
                                     const DesignOptions& options) try {
  const Transmission cables = with_radii(model.transmission, point.radius_factor);
  return describe_joint(model, point.is_own ? cables : with_preload(cables, point.l_o), number,
                        options);
} catch (const Error&) {
  return std::nullopt;
}

}  // namespace

DesignSpread spread_of(const DesignJoint& joint, const DesignPoint& point,
                       const std::vector<MovedModel>& copies, int number,
                       const DesignOptions& options) {
  const std::array<double, 5> middle = numbers_of(joint);
  const DesignOptions only = numbers_only(options);
  std::array<double, 5> squares{};
  for (const MovedModel& copy : copies) {
    const auto moved = described(copy.model, point, number, only);
    for (std::size_t k = 0; k < squares.size(); ++k)
      squares[k] += moved ? std::pow((numbers_of(*moved)[k] - middle[k]) / copy.by, 2) : kNotKnown;
  }
  DesignSpread spread;
  for (std::size_t k = 0; k < squares.size(); ++k)
    spread.*kMembers[k] = std::isfinite(squares[k]) ? std::sqrt(squares[k]) : kNotKnown;
  // Between fitted preloads the interval is that of the curve: the copies do not move it.
  if (joint.friction && std::isfinite(joint.friction->sd)) {
    const double efficiency = joint.friction->efficiency_driving;
    spread.efficiency_driving = efficiency * efficiency / options.torque * joint.friction->sd;
  }
  return spread;
}

}  // namespace cablefit
