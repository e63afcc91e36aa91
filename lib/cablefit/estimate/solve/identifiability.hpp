// Which parameters the rows of an equation separate, before the response is used: scaled condition
// number, singular directions and correlations, in words.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "cablefit/estimate/solve/motion_advice.hpp"

namespace cablefit {

struct NamedColumn {
  std::string name;  ///< of the parameter
  MotionColumn motion = {};
};

/// Parameters of which the rows show combinations only.
struct Confusion {
  std::vector<std::size_t> members;  ///< columns, ascending; a single one is never excited
  bool exact = false;                ///< not at all, rather than hardly
  double condition_index = 0;        ///< largest singular value / that of the direction
  double correlation = 0;            ///< of the estimates, of two members; else NaN
  std::string text;
};

struct Identifiability {
  double condition_scaled = 0;  ///< columns scaled to unit norm; infinite when some are dependent
  Eigen::MatrixXd correlation;  ///< of the estimates, p x p; 0 with those that are not determined
  /// sd of each estimate per unit of residual sd, were the residual white: root of diag (W'W)^-1.
  /// Infinite where it is not determined.
  Eigen::VectorXd unit_sd;
  std::vector<Confusion> confusions;  ///< exact ones first
};

/// `columns`: m x p, m >= p, a factor R with R'R = W'W of `n_rows` rows W. A direction counts as
/// hardly determined when two estimates correlate by more than 0.95, or when three or more have
/// most of their variance in a direction of condition index above 30 (Belsley, Kuh & Welsch 1980,
/// ch. 3).
Identifiability identifiability(const Eigen::MatrixXd& columns, Eigen::Index n_rows,
                                std::span<const NamedColumn> names);

/// "f_v and f_s are strongly correlated: 0.998; move at several speeds ...". `rms`:
/// of the columns.
std::string hardly_apart(const NamedColumn& a, double rms_a, const NamedColumn& b, double rms_b,
                         double correlation);
/// Estimates with a larger correlation are reported.
inline constexpr double kCorrelationTold = 0.95;  // estimation-rules: warn above

/// Why the parameter `self` alone is not determined, from a direction (scaled parameters) that the
/// rows do not show: "is not separable from f_s in these logs; ...".
std::string not_determined(const Eigen::VectorXd& direction, Eigen::Index self,
                           const Eigen::VectorXd& rms, std::span<const NamedColumn> names);
/// Per parameter the same of all directions; empty where it is determined. `null_directions`:
/// parameters x directions, columns of unit norm, in scaled parameters.
std::vector<std::string> not_determined(const Eigen::MatrixXd& null_directions,
                                        const Eigen::VectorXd& rms,
                                        std::span<const NamedColumn> names);
/// The same space in directions of as few parameters as there can be: each has one of its own.
Eigen::MatrixXd sparse_directions(Eigen::MatrixXd directions);
/// Smallest share in a null direction that counts as taking part.
inline constexpr double kNullComponent = 0.05;

}  // namespace cablefit
