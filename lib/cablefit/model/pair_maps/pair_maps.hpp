// Displacement maps of two joints: how far two angles together move a cable, in the sums
// g(theta) and h(q) of Fichera & Grossard 2017, (3)-(4). To add a kind: one file in pair_maps/, one
// line in pair_maps.cpp.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace cablefit {

class JsonNode;

/// Parameters of any map of two joints; each kind uses what it needs. SI.
struct PairParameters {
  std::array<std::vector<double>, 2> angle;  ///< grid: rad, ascending
  Eigen::MatrixXd values;  ///< grid: m, by angle 1 and angle 2; polynomial: c_ij, m/rad^(i+j)
  /// Grid: second derivatives of the spline at each point by angle 1, by angle 2, and by both.
  std::array<Eigen::MatrixXd, 3> curvature;
  Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();  ///< guides: m
  double length = 0;  ///< guides: from axis 1 to axis 2, m
  double sign = 1;    ///< of a growing path: 1 in g, -1 in h
};

/// A map of two joints at one pose, with its derivatives by the two angles.
struct PairValue {
  double displacement = 0;                           ///< m
  Eigen::Vector2d radius = Eigen::Vector2d::Zero();  ///< m
  Eigen::Matrix2d slope = Eigen::Matrix2d::Zero();   ///< of the radii, symmetric, m/rad
};

/// One key of a map in a rig file: a number, a list or a list of lists.
using PairEntry =
    std::pair<std::string_view,
              std::variant<double, std::vector<double>, std::vector<std::vector<double>>>>;

/// Which sum a map is part of: g(theta) of the motors or h(q) of the links.
enum class MapSide { motor, link };

/// A row of the table of maps of two joints (rig file "motor_map", "link_map"). Its radii are
/// continuous for all angles.
struct PairMapKind {
  std::string_view name;
  std::string_view equation;
  std::string_view source;
  bool rotary_only;  ///< a geometry of joints that turn
  PairParameters (*read)(const JsonNode& node, MapSide side);
  /// What `read` read besides "type" and "joints", for writing it back.
  std::vector<PairEntry> (*entries)(const PairParameters& parameters);
  PairValue (*at)(const PairParameters& parameters, double angle_1, double angle_2);
};

std::span<const PairMapKind> pair_map_kinds();
/// Throws Error(input) with a suggestion.
const PairMapKind& find_pair_map_kind(std::string_view name);

/// What two joints together add to the displacement of one cable.
struct PairMap {
  const PairMapKind* kind = nullptr;
  PairParameters parameters;
  std::array<std::size_t, 2> joints = {0, 1};  ///< from 0; angle 1 is of the first

  PairValue at(double angle_1, double angle_2) const {
    return kind->at(parameters, angle_1, angle_2);
  }
  bool passes(std::size_t joint) const { return joints[0] == joint || joints[1] == joint; }
  /// Place of a joint that the cable passes in the radii.
  Eigen::Index place(std::size_t joint) const { return joints[0] == joint ? 0 : 1; }
};

/// The map times a factor.
PairMap scaled(PairMap map, double factor);

}  // namespace cablefit
