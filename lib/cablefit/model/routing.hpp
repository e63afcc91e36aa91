// Routing: the displacement of each cable by each joint. The elongation of cable i is l_i = g_i -
// h_i + l_o (Fichera & Grossard 2017, (3)-(4)) where g_i is a sum over joints of a map of theta_k,
// and h_i of q_k. To add a kind of map: one file in routing/, one line in routing.cpp.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace cablefit {

class JsonNode;

/// Parameters of any displacement map; each kind uses some of them. SI. On a linear axis m takes
/// the place of rad, and radii have no unit.
struct MapParameters {
  std::vector<double> coefficients;         ///< of the radius: r_0, r_1, ... (m, m/rad, ...)
  std::vector<double> angle, displacement;  ///< table: rad ascending, m
  std::vector<double> curvature;            ///< table: second derivative at each point, m/rad^2
};

/// One key of a map in a rig file: a number or a list.
using MapEntry = std::pair<std::string_view, std::variant<double, std::vector<double>>>;

/// A row of the table of displacement maps (rig file "motor_radius", "link_radius": {"type": name,
/// ...}). The sign is positive where a growing angle of the motor stretches the cable. The
/// derivative of the displacement is continuous for every angle.
struct MapKind {
  std::string_view name;
  std::string_view equation;
  std::string_view source;
  bool constant_radius;  ///< a round pulley, which rig files give as a plain number
  MapParameters (*read)(const JsonNode& node);
  /// The values that `read` returned, without "type", to write them back.
  std::vector<MapEntry> (*entries)(const MapParameters& parameters);
  double (*displacement)(const MapParameters& parameters, double angle);  ///< m
  double (*radius)(const MapParameters& parameters, double angle);  ///< d displacement/d angle, m
  double (*radius_slope)(const MapParameters& parameters, double angle);  ///< m/rad
};

std::span<const MapKind> map_kinds();
/// Throws Error(input) with a suggestion.
const MapKind& find_map_kind(std::string_view name);

/// Displacement of one cable by one joint.
struct DisplacementMap {
  const MapKind* kind = nullptr;
  MapParameters parameters;

  double displacement(double angle) const { return kind->displacement(parameters, angle); }
  double radius(double angle) const { return kind->radius(parameters, angle); }
  double radius_slope(double angle) const { return kind->radius_slope(parameters, angle); }

  /// As above, for many angles. A round pulley needs no call per angle.
  Eigen::ArrayXd displacements(const Eigen::Ref<const Eigen::ArrayXd>& angle) const;
  Eigen::ArrayXd radii(const Eigen::Ref<const Eigen::ArrayXd>& angle) const;

  /// The joint does not move this cable.
  bool is_zero() const { return kind->constant_radius && radius(0) == 0; }
};

/// A round pulley of this signed radius.
DisplacementMap round_pulley(double radius);
/// One round pulley per joint.
std::vector<DisplacementMap> round_pulleys(const Eigen::VectorXd& radius);

/// The pose with l = l_o; empty: 0 (paper: q_o, theta_o).
struct ReferencePose {
  Eigen::VectorXd q, theta;
};

}  // namespace cablefit
