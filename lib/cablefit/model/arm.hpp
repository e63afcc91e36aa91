// Arms: how the links of several joints are coupled. Without an arm every joint moves an inertia of
// its own. To add an arm: one file in arm/, one line in arm.cpp.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/model/effects.hpp"

namespace cablefit {

class JsonNode;
struct SerialArm;
struct SerialChain;

/// Parameters of any arm; each kind uses some of them. SI.
struct ArmParameters {
  std::vector<double> J_link;  ///< independent: known inertias, kg m^2, one per joint; or empty
  double length_1 = 0;         ///< planar: from axis 1 to axis 2, m
  double gravity = 0;          ///< planar: in the plane of motion, m/s^2; 0: the plane is level
  double horizontal = 0;       ///< planar: q1 at which link 1 points away horizontally, rad
  std::shared_ptr<const SerialArm> serial;  ///< serial: the chain and its base parameters
};

/// The data of the rig that an arm needs.
struct RigJoints {
  int count = 1;
  JointAxes axes;
};

/// One key of an arm in a rig file: a number, a list or a list of lists.
using ArmEntry =
    std::pair<std::string_view,
              std::variant<double, std::vector<double>, std::vector<std::vector<double>>>>;

/// A row of the table of arms (rig file "arm": {"type": name, ...}).
struct ArmKind {
  std::string_view name;
  std::string_view equation;
  std::string_view source;
  ArmParameters (*read)(const JsonNode& node, const RigJoints& joints);
  /// The values that `read` returned, without "type", to write them back.
  std::vector<ArmEntry> (*entries)(const ArmParameters& parameters);
  /// Base parameters that the links share. Each is named by the combination of parameters that it
  /// is. None: every joint has its own J_link.
  std::vector<ParameterInfo> (*base_parameters)(const ArmParameters& parameters);
  /// Link torque of joint `joint` (from 0) per unit of each base parameter, M(q) qdd + C(q, qd) +
  /// g(q); `links`: motion of q, one per joint. nullptr without base parameters.
  void (*regressor)(const ArmParameters& parameters, std::span<const Motion> links, int joint,
                    Eigen::Ref<Eigen::MatrixXd> columns);
  /// Values of the base parameters by the masses in the rig file; empty: it has none. nullptr: this
  /// kind cannot compute them.
  std::vector<double> (*described)(const ArmParameters& parameters) = nullptr;
  /// The joints and links for the simulation. `base`: values of the base parameters. Each value
  /// goes to the standard parameter that names its combination, and the others are 0. The torques
  /// equal those of the regressor (arm/arm_dynamics.hpp). nullptr without base parameters.
  SerialChain (*chain)(const ArmParameters& parameters, std::span<const double> base) = nullptr;
  /// Whether joints may slide.
  bool may_slide = false;
  /// Name of the table row that the arm belongs to after reading; empty: this row.
  std::string_view becomes = {};
};

std::span<const ArmKind> arm_kinds();
/// Throws Error(input) with a suggestion.
const ArmKind& find_arm_kind(std::string_view name);

struct Arm {
  const ArmKind* kind = nullptr;  ///< nullptr: not given, every joint moves alone
  ArmParameters parameters;

  /// The links are coupled.
  bool is_coupled() const { return kind != nullptr && kind->regressor != nullptr; }
  std::vector<ParameterInfo> base_parameters() const;
  /// Their values by the masses in the rig file, in the same order; empty: none.
  std::vector<double> described() const;
};

}  // namespace cablefit
