#include "cablefit/estimate/profile_interval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/estimate/active_set.hpp"
#include "cablefit/estimate/constrained_least_squares.hpp"
#include "cablefit/estimate/instruments.hpp"
#include "cablefit/estimate/long_run.hpp"
#include "cablefit/estimate/scaled_solve.hpp"

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

namespace {

/// Diagonal of the covariance as if no inequality held anything, of residuals of unit variance.
struct FreeVariance {
  Eigen::VectorXd white;  ///< (W'W)^-1
  Eigen::VectorXd scale;  ///< honest variance over the white one of this residual, at least 1
};

FreeVariance free_variance(const RowStatistics& rows, const LinearSolution& s,
                           const Eigen::MatrixXd& a, const std::vector<Eigen::Index>& free,
                           double variance) {
  const Eigen::MatrixXd inverse = solve_scaled(a, Eigen::VectorXd::Zero(a.rows())).inverse;
  FreeVariance out{inverse.diagonal(), Eigen::VectorXd::Ones(inverse.rows())};
  const auto n_cells = static_cast<Eigen::Index>(rows.cells().size());
  if (n_cells < 8) return out;
  Eigen::MatrixXd scores(n_cells, inverse.rows());
  for (Eigen::Index c = 0; c < n_cells; ++c) {
    const Eigen::VectorXd all =
        rows.cells()[static_cast<std::size_t>(c)].gram * s.residual_combination;
    scores.row(c) = (s.score_columns.transpose() * all)(free);
  }
  const Eigen::MatrixXd honest = interval_covariance(scores * inverse).covariance;
  for (Eigen::Index k = 0; k < inverse.rows(); ++k)
    if (inverse(k, k) > 0) out.scale(k) = std::max(1.0, honest(k, k) / (variance * inverse(k, k)));
  return out;
}

}  // namespace

std::vector<ProfileInterval> profile_intervals(const RowStatistics& rows,
                                               const LinearProblem& problem,
                                               const LinearSolution& s, bool honest) {
  const bool held = !s.active_constraints.empty() ||
                    std::find(s.at_bound.begin(), s.at_bound.end(), true) != s.at_bound.end();
  if (!held) return {};
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<ProfileInterval> all(problem.regressors.size(), {kNone, kNone});
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
  const double dof = static_cast<double>(std::max<Eigen::Index>(1, s.n_rows - s.n_params));
  const double variance = s.rss / dof;
  const FreeVariance spread = free_variance(rows, s, a, free, variance);
  const double t = t_quantile_975(s.degrees_of_freedom);
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const auto at = static_cast<std::size_t>(free[i]);
    if (!s.not_identifiable[at].empty() || !(spread.white(k) > 0)) continue;
    all[at] = profile_interval(a, b, g, Eigen::RowVectorXd::Unit(a.cols(), k),
                               t * t * variance * (honest ? spread.scale(k) : 1));
  }
  return all;
}

}  // namespace cablefit
