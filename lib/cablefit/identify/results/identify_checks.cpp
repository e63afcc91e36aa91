#include "cablefit/identify/results/identify_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/elastic/checks/elastic_checks.hpp"

namespace cablefit {
namespace {

// Of the largest torque in an equation, sqrt(2) times its rms. A blocked sweep leaves its noise;
// what moves leaves the friction that has no model as well.
constexpr double kBlockedShare = 0.03, kMovingShare = 0.15;
constexpr double kUnexplained = 0.5;
constexpr double kLineSd = 3;

/// What one equation of a preload leaves, against what it has.
struct Misfit {
  std::string equation;
  bool blocked = false;
  double rms = 0, largest = 0;  ///< N m

  double share() const { return largest > 0 ? rms / largest : 0; }
};

/// rms of rows * combination.
double rms_of(const RowStatistics& rows, const Eigen::VectorXd& combination) {
  const auto n = static_cast<double>(std::max<Eigen::Index>(1, rows.n_rows()));
  return (rows.r() * combination).norm() / std::sqrt(n);
}

/// sqrt(2) times the rms of the largest of its terms, the elastic torque being one of them.
double largest_term(const JointFit& fit, const JointBlock& block, const Eigen::VectorXd& x) {
  double largest = rms_of(*block.rows, block.response);
  const Eigen::Index n = fit.layout.n_coefficients;
  largest = std::max(largest, rms_of(*block.rows, block.regressors.leftCols(n) * x.head(n)));
  for (Eigen::Index k = n; k < fit.layout.n_linear; ++k)
    largest = std::max(largest, rms_of(*block.rows, block.regressors.col(k) * x(k)));
  return std::sqrt(2.0) * largest;
}

std::vector<Misfit> misfits_of(const JointFit& fit, const JudgedPoint& judged, std::size_t job) {
  const JointProblem problem =
      joint_problem(fit.jobs, fit.layout, judged.point.input(), fit.weights, {});
  std::size_t b = 0;
  for (std::size_t j = 0; j < job; ++j) b += fit.facts[j].size();
  std::vector<Misfit> misfits;
  for (const JointRecord& record : fit.jobs[job].records)
    for (const JointEquation& equation : record.equations) {
      const JointBlock& block = problem.blocks[b];
      misfits.push_back({equation.base.name, equation.blocked,
                         rms_of(*block.rows, judged.point.solution.combinations[b]),
                         largest_term(fit, block, judged.point.solution.x)});
      ++b;
    }
  return misfits;
}

std::string unit_of(const JointFit& fit) { return torque_unit(fit.jobs.front().axes.all()); }

bool is_searched(const PreloadJob& job) {
  return std::find(job.searched.begin(), job.searched.end(), true) != job.searched.end();
}

std::string what_to_try(const JointFit& fit, std::size_t job) {
  return is_searched(fit.jobs[job])
             ? "check the rig file's cables and the encoder zeros of q and theta (`cablefit "
               "elastic` looks for theta_0)"
             : "if the cables are preloaded try --l-o search; check the rig file's cables and the "
               "encoder zeros of q and theta (`cablefit elastic` looks for theta_0)";
}

}  // namespace

void require_explained(const JointFit& fit, const JudgedPoint& judged, std::size_t job) {
  for (const Misfit& m : misfits_of(fit, judged, job))
    if (m.share() > kUnexplained)
      throw Error(
          ErrorKind::not_identifiable,
          fmt::format("preload '{:.40}': these cables do not explain the {} logs: {:.3g} {} rms "
                      "remain where the largest torque is {:.3g} {}; check the signs of the radii, "
                      "the initial elongations and the reference pose in the rig file",
                      fit.jobs[job].name, m.blocked ? "blocked" : "moving", m.rms, unit_of(fit),
                      m.largest, unit_of(fit)));
}

std::vector<std::string> misfit_warnings(const JointFit& fit, const JudgedPoint& judged,
                                         std::size_t job, const IdentifyPreload& preload) {
  std::vector<std::string> warnings;
  for (const Misfit& m : misfits_of(fit, judged, job))
    if (m.share() > (m.blocked ? kBlockedShare : kMovingShare))
      warnings.push_back(
          fmt::format("the residual of the {} equation is {:.3g} {} rms, {:.2g} % of its largest "
                      "torque: the sd do not include this error of the model; {}",
                      m.equation, m.rms, unit_of(fit), 100 * m.share(), what_to_try(fit, job)));
  for (const LineStiffness& line : preload.lines)
    if (std::abs(line.model - line.measured) > kLineSd * line.sd)
      warnings.push_back(fmt::format(
          "the straight line through the blocked rows has {} = {:.4g} +- {:.2g} {}/{}, through "
          "these cables {:.4g}: blocked and moving logs do not agree on them; {}",
          line.name, line.measured, line.sd, unit_of(fit),
          unit_for(fit.jobs.front().axes.all(), "rad"), line.model, what_to_try(fit, job)));
  if (!is_searched(fit.jobs[job]) && looks_preloaded(preload.transmission, preload.elongations))
    warnings.emplace_back(
        "the stiffness falls on both sides of zero, as with cables that are both taut there "
        "(preload), but l_o = 0 was taken: give l_o in the rig file, or --l-o search");
  return warnings;
}

}  // namespace cablefit
