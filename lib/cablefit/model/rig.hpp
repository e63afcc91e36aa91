// The rig file (cablefit/rig/1): the meaning of a log's columns, and the parts of the bench.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/model/arm.hpp"
#include "cablefit/model/cables.hpp"
#include "cablefit/model/load.hpp"

namespace cablefit {

/// Source of a channel: a column with its unit, sign and scale.
struct ColumnMapping {
  std::string column;  ///< as in the log's header
  double scale = 1.0;  ///< SI value = (value as written) * scale * (unit's factor) + shift
  double shift = 0.0;  ///< in `unit`; rarely needed
  std::string unit;    ///< of value * scale; empty: the header's unit, else SI
};

enum class TorqueHold { automatic, zoh, none };

/// tau = kp e + ki (integral of e) + kd de/dt + feed-forward, clipped, with e = reference - theta.
/// Derivatives are backward differences over the period. A velocity loop on the motor's speed alone
/// is kd with feed_velocity = -kd. A cascade of P and PI is written as this law (rig/bench.cpp).
struct Controller {
  std::string type = "pd";
  double kp = 0, kd = 0;                ///< N m/rad, N m s/rad
  double ki = 0;                        ///< N m/(rad s)
  double feed_position = 0;             ///< N m/rad, of the reference less its first value
  double feed_velocity = 0;             ///< N m s/rad, of the reference's speed
  double feed_acceleration = 0;         ///< N m s^2/rad
  double limit = kUnbounded;            ///< |tau| <= limit, N m
  double period = 0;                    ///< s; 0: the log's
  std::string reference = "theta_ref";  ///< column
  /// One per joint, where they differ: their laws and limits instead of this one's. Period and
  /// reference are the same. Empty: one law for all joints.
  std::vector<Controller> joints = {};

  const Controller& of(std::size_t joint) const { return joints.empty() ? *this : joints[joint]; }
};

/// All of these in one, the first for joint 1. They have the same period and reference.
Controller controller_of(std::vector<Controller> joints);

class JsonNode;

struct SensorInfo {
  std::optional<double> quantum;  ///< rad
  std::optional<double> noise;    ///< sd, SI
};

struct Rig {
  std::string path;  ///< empty: the default rig
  std::string name;
  std::string preload;  ///< name of the preload setting; may be empty
  std::map<std::string, ColumnMapping>
      columns;             ///< by channel: "t", "q", "theta", "tau", "tau_load", "q1", ...
  double sample_rate = 0;  ///< Hz, of logs without a time column; 0: not given
  JointAxes axes;          ///< "motion"
  TorqueHold torque_hold = TorqueHold::automatic;
  double torque_period = 0;  ///< s; 0: the log's
  Load load;
  Arm arm;  ///< of several joints
  std::optional<Controller> controller;
  bool open_loop = false;  ///< tau is a command that does not depend on measured signals
  std::map<std::string, SensorInfo> sensors;  ///< by channel
  std::map<std::string, double> cad;          ///< by parameter name
  std::vector<std::string> joints = {"1"};
  Transmission transmission;  ///< coefficients empty: to be fitted
  bool cables_given = false;  ///< the rig file gives cables, so parameters are in cable space
  std::vector<bool> search_elongation;  ///< per cable: "initial_elongation": "search"

  int n_joints() const { return static_cast<int>(joints.size()); }
};

/// Of the joint that a cable in joint space belongs to. Cables in cable space have m and N.
Axes axes_of(const JointAxes& joints, const Cable& cable);

/// The paper's rig: one joint, two antagonist cables in joint space.
Rig default_rig();
/// Throws Error(input) at file:line:column: unknown keys with "did you mean", negative masses, ...
Rig read_rig(const std::string& path);
/// As above, from an object inside another file, such as a model file's "rig".
Rig parse_rig(const JsonNode& node);
/// The rig by `rig_option` (--rig) when not empty, else by rig.json beside the log when there is
/// one, else the default rig.
Rig rig_for_log(const std::string& log_path, const std::string& rig_option);

}  // namespace cablefit
