#include "cablefit/estimate/fit/profile_interval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/base/parameter.hpp"
#include "cablefit/estimate/fit/active_set.hpp"
#include "cablefit/estimate/fit/instruments.hpp"
#include "cablefit/estimate/solve/constrained_least_squares.hpp"
#include "cablefit/estimate/solve/scaled_solve.hpp"
#include "cablefit/estimate/spread/long_run.hpp"

namespace cablefit {
namespace {

// combination x = v enters as a row that weighs as much more than the data (Van Loan 1985): misses
// v by 1e-8 of an sd, far below what an interval is wanted to, and keeps half of the digits.
constexpr double kWeight = 1e4;
constexpr double kMissed = 1e-5;     // sd: then the inequalities do not allow v at all
constexpr double kPrecision = 1e-6;  // of the distance that the threshold stands for
constexpr int kDoublings = 40;

class Profile {
 public:
  Profile(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, const Eigen::MatrixXd& g,
          const Eigen::RowVectorXd& combination)
      : a_(a), b_(b), g_(g), combination_(combination) {
    const Eigen::MatrixXd inverse = solve_scaled(a, b).inverse;
    sd_ = std::sqrt((combination * inverse * combination.transpose()).value());
    const Eigen::VectorXd best = constrained_least_squares(a, b, g).x;
    least_ = (a * best - b).squaredNorm();
    value_ = combination.dot(best);
    row_.resize(a.rows() + 1, a.cols());
    row_.topRows(a.rows()) = a;
    row_.bottomRows(1) = kWeight / sd_ * combination;
    response_.resize(b.size() + 1);
    response_.head(b.size()) = b;
  }

  double sd() const { return sd_; }  ///< for |a x - b| of unit variance
  double value() const { return value_; }

  /// The least |a x - b|^2 with combination x = v, above that without; infinite where the
  /// inequalities do not allow v.
  double above(double v) {
    response_(b_.size()) = kWeight / sd_ * v;
    const Eigen::VectorXd x = constrained_least_squares(row_, response_, g_).x;
    if (std::abs(combination_.dot(x) - v) > kMissed * sd_) return kNever;
    return (a_ * x - b_).squaredNorm() - least_;
  }

  static constexpr double kNever = std::numeric_limits<double>::infinity();

 private:
  const Eigen::MatrixXd& a_;
  const Eigen::VectorXd& b_;
  const Eigen::MatrixXd& g_;
  Eigen::RowVectorXd combination_;
  Eigen::MatrixXd row_;
  Eigen::VectorXd response_;
  double sd_ = 0, least_ = 0, value_ = 0;
};

/// Where the profile crosses the threshold, going from its best in this direction (1 or -1).
double crossing(Profile& profile, double threshold, double direction) {
  const double unit = std::sqrt(threshold) * profile.sd();
  // The root of the profile is nearly a line, and one without inequalities.
  const auto beyond = [&](double distance) {
    const double above = profile.above(profile.value() + direction * distance * unit);
    return std::sqrt(std::max(0.0, above) / threshold) - 1;
  };
  double inside = 0, outside = 1;  // of `unit` from the best
  double at_inside = -1, at_outside = beyond(outside);
  for (int i = 0; at_outside <= 0; ++i) {
    if (i == kDoublings) return direction * Profile::kNever;
    inside = outside;
    at_inside = at_outside;
    outside *= 2;
    at_outside = beyond(outside);
  }
  while (outside - inside > kPrecision && at_inside < -kPrecision) {
    const double share = at_inside / (at_inside - at_outside);
    const double next = std::isfinite(at_outside)
                            ? inside + (outside - inside) * std::clamp(share, 0.05, 0.95)
                            : 0.5 * (inside + outside);
    const double at_next = beyond(next);
    (at_next <= 0 ? inside : outside) = next;
    (at_next <= 0 ? at_inside : at_outside) = at_next;
  }
  return profile.value() + direction * inside * unit;
}

}  // namespace

ProfileInterval profile_interval(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                 const Eigen::MatrixXd& g, const Eigen::RowVectorXd& combination,
                                 double threshold) {
  Profile profile(a, b, g, combination);
  if (!(profile.sd() > 0) || !(threshold > 0)) return {profile.value(), profile.value()};
  return {crossing(profile, threshold, -1), crossing(profile, threshold, 1)};
}

std::vector<ProfileInterval> profile_intervals(const RowStatistics& rows,
                                               const LinearProblem& problem,
                                               const LinearSolution& s, bool robust) {
  const bool held = !s.active_constraints.empty() ||
                    std::find(s.at_bound.begin(), s.at_bound.end(), true) != s.at_bound.end();
  if (!held) return {};
  std::vector<ProfileInterval> all(problem.regressors.size(), {kNotKnown, kNotKnown});
  std::vector<Eigen::Index> free, columns;
  for (std::size_t k = 0; k < problem.regressors.size(); ++k) {
    if (k < problem.held.size() && !problem.held[k].empty()) continue;
    free.push_back(static_cast<Eigen::Index>(k));
    columns.push_back(problem.regressors[k]);
  }
  const Instruments seen(rows, problem.instruments);
  const Eigen::MatrixXd a = seen.project(rows.r()(Eigen::all, columns));
  const Eigen::VectorXd b = seen.project(rows.r() * problem.response);
  const Eigen::MatrixXd g = inequality_rows(problem, free);
  // The scale comes from the fit without inequalities: what holds a parameter at its bound pulls at
  // the residual, which is no noise.
  LinearProblem plain = problem;
  plain.lower.clear();
  plain.constraints.resize(0, 0);
  const LinearSolution unheld = solve(rows, plain);
  const Eigen::MatrixXd& covariance = robust ? unheld.covariance : unheld.covariance_white;
  const double t = t_quantile_975(unheld.degrees_of_freedom);
  for (std::size_t i = 0; i < free.size(); ++i) {
    const Eigen::Index k = free[i];
    const auto at = static_cast<std::size_t>(k);
    if (!s.not_identifiable[at].empty() || !(unheld.solve_operator(k, k) > 0)) continue;
    all[at] =
        profile_interval(a, b, g, Eigen::RowVectorXd::Unit(a.cols(), static_cast<Eigen::Index>(i)),
                         t * t * covariance(k, k) / unheld.solve_operator(k, k));
  }
  return all;
}

}  // namespace cablefit
