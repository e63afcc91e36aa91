// Arms: how the links of several joints are coupled. Without one every joint turns an inertia
// of its own. To add an arm: one file in arm/, one line in arm.cpp.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cablefit/model/effects.hpp"

namespace cablefit {

class JsonNode;
struct SerialArm;
struct SerialChain;

/// Parameters of any arm; each kind uses what it needs. SI.
struct ArmParameters {
  std::vector<double> J_link;  ///< independent: known inertias, kg m^2, one per joint; or none
  double length_1 = 0;         ///< planar: from axis 1 to axis 2, m
  double gravity = 0;          ///< planar: in the plane of motion, m/s^2; 0: the plane is level
  double horizontal = 0;       ///< planar: q1 at which link 1 points away level, rad
  std::shared_ptr<const SerialArm> serial;  ///< serial: the chain and its base parameters
};

/// What an arm must know of the rig.
struct RigJoints {
  int count = 1;
  bool slide = false;  ///< "motion": "linear"
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
  /// What `read` read besides "type", for writing it back.
  std::vector<ArmEntry> (*entries)(const ArmParameters& parameters);
  /// Base parameters that the links share, named by the combination they stand for; none: every
  /// joint has its own J_link.
  std::vector<ParameterInfo> (*base_parameters)(const ArmParameters& parameters);
  /// Link torque of joint `joint` (from 0) per unit of each base parameter, M(q) qdd + C(q, qd) +
  /// g(q); `links`: motion of q, one per joint. nullptr without base parameters.
  void (*regressor)(const ArmParameters& parameters, std::span<const Motion> links, int joint,
                    Eigen::Ref<Eigen::MatrixXd> columns);
  /// The base parameters by what the rig file says of masses; none: it does not. nullptr: it
  /// cannot.
  std::vector<double> (*described)(const ArmParameters& parameters) = nullptr;
  /// The joints and links, with `base` (values of the base parameters) as the links' inertias: on
  /// the standard parameter that each combination is named after, 0 elsewhere. Their torques are
  /// those of the regressor (arm/arm_dynamics.hpp). nullptr without base parameters.
  SerialChain (*chain)(const ArmParameters& parameters, std::span<const double> base) = nullptr;
  /// Makes sense on linear axes.
  bool may_slide = false;
  /// Name of the row that the arm belongs to once it is read; empty: this one.
  std::string_view becomes = {};
};

std::span<const ArmKind> arm_kinds();
/// Throws Error(input) with a suggestion.
const ArmKind& find_arm_kind(std::string_view name);

struct Arm {
  const ArmKind* kind = nullptr;  ///< nullptr: not given; every joint for itself
  ArmParameters parameters;

  /// The links are coupled.
  bool is_coupled() const { return kind != nullptr && kind->regressor != nullptr; }
  std::vector<ParameterInfo> base_parameters() const;
  /// Their values by the description, in the same order, or none.
  std::vector<double> described() const;
};

}  // namespace cablefit
