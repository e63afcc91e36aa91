// The linear part of the one-step identification: rows, weights, physical bounds and solutions for
// given initial elongations. Coefficients are linear once l_o is known (variable projection,
// Golub & Pereyra 1973), so everything else asks here.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cablefit/identify/equations/joint_model.hpp"

namespace cablefit {

using Elongations = std::vector<Eigen::VectorXd>;  ///< per job, n_cables; m or rad

/// What a fit is about. Rows of elongations that were asked for before are kept.
struct JointFit {
  std::span<const LogSurvey> logs;
  std::vector<PreloadJob> jobs;
  JointLayout layout;
  std::vector<double> weights;  ///< per equation, jobs one after the other
  bool unconstrained = false;   ///< cables may push
  int threads = 1;

  using Rows = std::shared_ptr<const std::vector<RowStatistics>>;
  std::vector<std::map<std::vector<double>, Rows>> known = {};  ///< per job, by l_o
  std::vector<std::vector<EquationFacts>> facts = {};           ///< per job, per equation

  bool searches() const { return layout.n_elongations > 0; }
  /// l - l_o of a cable in all equations of the job.
  ElongationRange displacements(std::size_t job, std::size_t cable) const;
  /// Elongations that the cables of a job reach with these l_o.
  std::vector<ElongationRange> elongations(std::size_t job, const Eigen::VectorXd& l_o) const;
};

JointFit make_joint_fit(std::span<const LogSurvey> logs, std::vector<PreloadJob> jobs,
                        bool inertias_apart, bool unconstrained, int threads);

/// A choice of l_o and what follows from it.
struct JointPoint {
  Elongations l_o;
  std::vector<JointFit::Rows> rows;  ///< per job
  JointSolution solution;            ///< of the linear parameters, equilibrium and bounds imposed

  double merit() const { return solution.weighted_rss; }
  JointInput input() const;
};

/// One pass over the logs for all points together. `with_cells`: for covariances, not kept.
std::vector<JointPoint> evaluate(JointFit& fit, const std::vector<Elongations>& points,
                                 bool with_cells = false);

/// The solution at a point with equilibrium and physical bounds; these only where plain least
/// squares breaks them.
JointSolution solve_bounded(const JointFit& fit, const JointPoint& point);

/// Inequalities of a point, rows * (linear parameters) >= 0: lower bounds of parameters, and
/// k(l) >= 0 of every cable.
struct PhysicalBounds {
  Eigen::MatrixXd rows;
  std::vector<std::string> texts;        ///< one per row: "f_s >= 0"
  std::vector<Eigen::Index> parameters;  ///< whose lower bound it is; -1: a cable's
};
PhysicalBounds physical_bounds(const JointFit& fit, const Elongations& l_o);

/// Deflections phi of every joint: of one, those that reach the elongations of the logs with the
/// link in its reference position; of several, those of the rows of each joint's equations.
std::vector<DeflectionRange> deflections_of(const JointFit& fit, std::size_t job,
                                            const JointPoint& point);

/// Per equation the variance of what its own least squares leaves, without equilibrium and without
/// regard to the others.
std::vector<double> own_variances(const JointFit& fit, const JointPoint& point);

}  // namespace cablefit
