// The parameters of the one-step identification and how they stand in the equations of all joints
// and preloads: cable coefficients shared, inertias shared between preloads or not, friction,
// offset and l_o of each preload its own.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/estimate/fit/joint_least_squares.hpp"
#include "cablefit/identify/equations/joint_equations.hpp"

namespace cablefit {

inline constexpr int kShared = -1;

struct JointParameter {
  std::string name;    ///< as in results: "K1_0", "J_link", "l_o[1]"
  std::string symbol;  ///< the paper's
  std::string unit;    ///< of the rig's axis
  double lower = -kUnbounded;
  int preload = kShared;  ///< place among the jobs
  std::size_t cable = 0;  ///< of a coefficient, l_o or r_m
  bool inertia = false;   ///< or another base parameter of an arm
  /// Part of it that is known and belongs to it in results: a load's inertia, or where a nonlinear
  /// parameter was linearised.
  double known = 0;
};

struct JointLayout {
  /// Coefficients, inertias, the rest, then l_o, then r_m.
  std::vector<JointParameter> parameters;
  Eigen::Index n_coefficients = 0;  ///< of all cables, first
  Eigen::Index n_linear = 0;        ///< all but l_o and r_m
  Eigen::Index n_elongations = 0;   ///< searched

  /// Place of the first r_m that is searched.
  Eigen::Index first_radius() const { return n_linear + n_elongations; }
  bool searches_radius() const {
    return first_radius() < static_cast<Eigen::Index>(parameters.size());
  }

  /// Of the preload, or shared; -1 when there is none.
  Eigen::Index find(std::string_view name, int preload) const;
};
/// `inertias_apart`: each preload has its own.
JointLayout joint_layout(const std::vector<PreloadJob>& jobs, bool inertias_apart);

/// One choice of l_o with the rows it gives.
struct JointInput {
  std::vector<Eigen::VectorXd> l_o;                     ///< per job, n_cables
  std::vector<const std::vector<RowStatistics>*> rows;  ///< per job, per equation
};

struct JointForm {
  bool equilibrium = true;  ///< impose P f = S f = 0 in the reference pose, (8c)/(19e)
  /// Coefficients about which l_o and r_m are linearised: a column per searched one, whose
  /// parameter is its change. None: they stand still, parameters are the n_linear first ones.
  std::optional<Eigen::VectorXd> coefficients = {};
};

/// The problem without inequalities. J_link is that of the link alone: a load's own is known and
/// taken off its equation. `weights`: per equation, jobs one after the other.
JointProblem joint_problem(const std::vector<PreloadJob>& jobs, const JointLayout& layout,
                           const JointInput& input, const std::vector<double>& weights,
                           const JointForm& form);

/// The cables of a job with these coefficients and elongations.
Transmission fitted_cables(const PreloadJob& job, const Eigen::VectorXd& l_o,
                           const Eigen::VectorXd& x);

}  // namespace cablefit
