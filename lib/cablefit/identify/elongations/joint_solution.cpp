#include "cablefit/identify/elongations/joint_solution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/spread/long_run.hpp"
#include "cablefit/identify/elongations/elongation_search.hpp"
#include "cablefit/identify/elongations/radius_search.hpp"

namespace cablefit {
namespace {

constexpr int kReweighings = 3;
constexpr double kSettled = 0.02;  // change of a weight that changes nothing
constexpr int kRestarts = 4;
constexpr double kDifferenceSd = 3;  // inertias that differ by more sd are no longer one

/// "J_link 0.339, 0.328 (5.1 sd)" of every inertia that differs between preloads.
std::string different_inertias(const JointFit& fit, const JudgedPoint& judged) {
  std::string text;
  const auto& p = fit.layout.parameters;
  for (std::size_t a = 0; a < p.size(); ++a)
    for (std::size_t b = a + 1; b < p.size(); ++b) {
      if (p[a].name != p[b].name || !p[a].inertia) continue;
      const auto i = static_cast<Eigen::Index>(a), k = static_cast<Eigen::Index>(b);
      const Eigen::MatrixXd& c = judged.covariance.covariance;
      const double sd = std::sqrt(std::max(0.0, c(i, i) + c(k, k) - 2 * c(i, k)));
      const double distance =
          std::abs(judged.point.solution.x(i) - judged.point.solution.x(k)) / sd;
      if (!(distance > kDifferenceSd)) continue;
      text += fmt::format("{}{} {:.4g} ({:.40}) and {:.4g} ({:.40}), {:.0f} sd apart",
                          text.empty() ? "" : "; ", p[a].name, judged.point.solution.x(i),
                          fit.jobs[static_cast<std::size_t>(p[a].preload)].name,
                          judged.point.solution.x(k),
                          fit.jobs[static_cast<std::size_t>(p[b].preload)].name, distance);
    }
  return text;
}

/// None beside a searched r_m, which a profile would hold where it is: intervals are then those of
/// the joint covariance.
ElongationProfiles profiles_of(JointFit& fit, const JudgedPoint& judged) {
  if (fit.layout.searches_radius()) return {};
  std::vector<Eigen::Index> which;
  std::vector<double> t, scale;
  const Eigen::MatrixXd& robust = judged.covariance.covariance;
  for (Eigen::Index k = fit.layout.n_linear; k < judged.linearised.x.size(); ++k) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(judged.linearised.x.size(), k);
    if (!judged.linearised.determines(unit)) continue;
    which.push_back(k);
    scale.push_back(judged.linearised.solve_operator(k, k) / robust(k, k));
    t.push_back(t_quantile_975(judged.covariance.degrees_of_freedom(k)));
  }
  return profile_elongations(fit, judged.point, which, robust, t, scale);
}

}  // namespace

JointPoint settle(JointFit& fit, JointPoint point) {
  for (int i = 0; i < kReweighings; ++i) {
    JointPoint full = evaluate(fit, {point.l_o}, true).front();
    JointProblem problem = joint_problem(fit.jobs, fit.layout, full.input(), fit.weights, {});
    reweigh(problem, full.solution);
    double change = 0;
    for (std::size_t b = 0; b < fit.weights.size(); ++b) {
      change = std::max(change, std::abs(problem.blocks[b].weight / fit.weights[b] - 1));
      fit.weights[b] = problem.blocks[b].weight;
    }
    // Where something is left open a descent drifts, and may end where a single row decides.
    point = fit.searches()
                ? least_certain(fit, {polish(fit, point), evaluate(fit, {point.l_o}).front()})
                : polish(fit, point);
    point = search_radii(fit, std::move(point));
    if (change < kSettled) break;
  }
  return point;
}

JointPoint fit_all(JointFit& fit, const JointFit& first, const JointPoint& start) {
  if (n_undetermined(first, start) > 0) {
    JointPoint point = search_elongations(fit);
    return settle(fit, search_radii(fit, std::move(point)));
  }
  const JointPoint begin = evaluate(fit, {start.l_o}).front();
  const std::vector<double> variances = own_variances(fit, begin);
  for (std::size_t e = 0; e < variances.size(); ++e)
    if (variances[e] > 0) fit.weights[e] = 1 / variances[e];
  return settle(fit, search_radii(fit, descend(fit, {{start.l_o}}).front()));
}

JointPoint share_inertias(JointFit& fit, JointPoint point, IdentifyResult& result) {
  const JudgedPoint judged = judge_point(fit, evaluate(fit, {point.l_o}, true).front());
  const std::string differences = different_inertias(fit, judged);
  if (!differences.empty()) {
    result.decisions.push_back({"inertias", "per preload", differences});
    result.warnings.push_back(
        "inertias differ between preloads, although one drive has one inertia: " + differences +
        "; they are not shared");
    return point;
  }
  result.decisions.push_back(
      {"inertias", "shared", "those of the preloads agree within 3 sd, each without its load"});
  fit.layout = joint_layout(fit.jobs, false);
  return settle(fit, descend(fit, {{point.l_o}}).front());
}

Profiled judge_with_profiles(JointFit& fit, JointPoint point) {
  for (int i = 0; i < kRestarts; ++i) {
    JudgedPoint judged = judge_point(fit, evaluate(fit, {point.l_o}, true).front());
    ElongationProfiles found = profiles_of(fit, judged);
    if (!found.better) return {std::move(judged), std::move(found.profiles)};
    point = settle(fit, std::move(*found.better));
  }
  throw Error(ErrorKind::not_identifiable,
              "the initial elongations did not converge: each profile likelihood has another "
              "optimum; give them in the rig file, or sweep until every cable goes slack");
}

}  // namespace cablefit
