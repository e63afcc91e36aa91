// Load laws: tau_load on the link as a function of q, or a column of the log.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace cablefit {

class JsonNode;

/// Parameters of any load law; each law uses some of them. SI.
struct LoadParameters {
  double torque = 0;                           ///< constant
  double mass = 0, radius = 0, direction = 1;  ///< hanging_mass
  double length = 0, zero = 0;                 ///< pendulum
  std::vector<double> q, table_torque;  ///< table, q ascending, linear between, constant outside
};

/// One key of a load in a rig file: a number or a list.
using LoadEntry = std::pair<std::string_view, std::variant<double, std::vector<double>>>;

/// A row of the table of load laws (rig file "load": {"type": name, ...}).
struct LoadLaw {
  std::string_view name;
  std::string_view equation;
  bool from_column;  ///< the log's tau_load column is used
  LoadParameters (*read)(const JsonNode& node);
  /// The values that `read` returned, without "type", to write them back.
  std::vector<LoadEntry> (*entries)(const LoadParameters& parameters);
  double (*torque)(const LoadParameters& parameters, double q);
  /// Inertia of the load (m r^2, m L^2), part of J_link; 0 without any.
  double (*inertia)(const LoadParameters& parameters);
  /// Allowed on a rig of several joints. Most laws are not, because they depend on one q.
  bool any_joints = false;
  /// Its torque requires a link that turns.
  bool rotary_only = false;
  /// Acceleration of the link, rad/s^2, above which the link no longer carries the load (a slack
  /// rope). nullptr: it always does.
  double (*free_fall)(const LoadParameters& parameters) = nullptr;
  /// d torque / dq, N m/rad. nullptr: the torque does not depend on q.
  double (*slope)(const LoadParameters& parameters, double q) = nullptr;
};

std::span<const LoadLaw> load_laws();
const LoadLaw& find_load_law(std::string_view name);

struct Load {
  const LoadLaw* law =
      nullptr;  ///< nullptr: not given; a tau_load column is used when there is one
  LoadParameters parameters;
};

inline constexpr double kGravity = 9.80665;  ///< m/s^2, standard gravity (CGPM 1901)

}  // namespace cablefit
