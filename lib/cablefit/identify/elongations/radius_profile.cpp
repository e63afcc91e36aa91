#include "cablefit/identify/elongations/radius_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/estimate/spread/long_run.hpp"
#include "cablefit/identify/elongations/radius_search.hpp"
#include "cablefit/identify/equations/joint_radii.hpp"

namespace cablefit {
namespace {

constexpr int kMostSteps = 12;
constexpr double kMet = 0.01;         // of the root of the deviance: a hundredth of the interval
constexpr double kGrowth = 4;         // of a step at most
const double kReach = std::log(2.0);  // a nominal radius is right within a factor of two

/// The least deviance with the radii of one group at exp(`ln_factor`) times the best.
class RadiusProfile {
 public:
  RadiusProfile(const JointFit& fit, const JudgedPoint& judged, std::vector<Eigen::Index> group)
      : fit_(fit), judged_(judged), group_(std::move(group)), best_(searched_radii(fit)) {}

  Eigen::Index parameter() const { return fit_.layout.first_radius() + group_.front(); }
  double relative_sd() const {
    return std::sqrt(judged_.covariance.covariance(parameter(), parameter())) /
           std::abs(best_(group_.front()));
  }

  double deviance(double ln_factor) const {
    JointFit fit = with_radii(fit_, radii_at(ln_factor));
    JointPoint point = descend(fit, {{elongations_at(ln_factor)}}).front();
    point = search_radii(fit, std::move(point), group_);
    return std::max(0.0, point.merit() - judged_.point.merit());
  }

 private:
  /// Change of another parameter that goes along by the covariance.
  double along(Eigen::Index other, double ln_factor) const {
    const Eigen::MatrixXd& c = judged_.covariance.covariance;
    return c(other, parameter()) / c(parameter(), parameter()) * best_(group_.front()) * ln_factor;
  }

  Eigen::VectorXd radii_at(double ln_factor) const {
    Eigen::VectorXd radii = best_;
    for (Eigen::Index k = 0; k < radii.size(); ++k) {
      const bool own = std::find(group_.begin(), group_.end(), k) != group_.end();
      const double ln =
          own ? ln_factor : along(fit_.layout.first_radius() + k, ln_factor) / best_(k);
      radii(k) *= std::exp(std::clamp(ln, -kReach, kReach));
    }
    return radii;
  }

  Elongations elongations_at(double ln_factor) const {
    Elongations l_o = judged_.point.l_o;
    for (Eigen::Index k = fit_.layout.n_linear; k < fit_.layout.first_radius(); ++k) {
      const JointParameter& p = fit_.layout.parameters[static_cast<std::size_t>(k)];
      l_o[static_cast<std::size_t>(p.preload)](static_cast<Eigen::Index>(p.cable)) +=
          along(k, ln_factor);
    }
    return l_o;
  }

  const JointFit& fit_;
  const JudgedPoint& judged_;
  std::vector<Eigen::Index> group_;
  Eigen::VectorXd best_;
};

/// ln of the factor at which the root of the deviance is `limit`, by secants through 0; infinite:
/// beyond the reach. `side`: -1 or 1.
double crossing(const RadiusProfile& profile, double limit, double side) {
  double ln = std::min(limit * profile.relative_sd(), kReach);
  double below = 0, above = kUnbounded;
  for (int step = 0; step < kMostSteps; ++step) {
    const double root = std::sqrt(profile.deviance(side * ln));
    if (std::abs(root / limit - 1) < kMet) break;
    (root < limit ? below : above) = ln;
    if (below >= kReach) return side * kUnbounded;
    ln *= std::clamp(limit / root, 1 / kGrowth, kGrowth);
    if (ln <= below || ln >= above)
      ln = std::isinf(above) ? kGrowth * below : 0.5 * (below + above);
    ln = std::min(ln, kReach);
  }
  return side * ln;
}

void take_interval(double radius, double ln_low, double ln_high, Estimate& e) {
  const auto end = [&](double ln) {
    return std::isinf(ln) ? std::numeric_limits<double>::quiet_NaN() : radius * std::exp(ln);
  };
  e.ci_low = end(radius > 0 ? ln_low : ln_high);
  e.ci_high = end(radius > 0 ? ln_high : ln_low);
  e.profiled = true;
}

}  // namespace

void profile_radii(const JointFit& fit, const JudgedPoint& judged, std::span<Estimate> estimates) {
  if (!fit.layout.searches_radius()) return;
  const Eigen::VectorXd radii = searched_radii(fit);
  for (const std::vector<Eigen::Index>& group : radius_groups(fit.jobs)) {
    const RadiusProfile profile(fit, judged, group);
    const Eigen::Index k = profile.parameter();
    const auto estimate_of = [&](Eigen::Index radius) -> Estimate& {
      return estimates[static_cast<std::size_t>(fit.layout.first_radius() + radius)];
    };
    if (!estimate_of(group.front()).not_identifiable.empty()) continue;
    const double scale =
        judged.linearised.solve_operator(k, k) / judged.covariance.covariance(k, k);
    const double limit = t_quantile_975(judged.covariance.degrees_of_freedom(k)) / std::sqrt(scale);
    const double low = crossing(profile, limit, -1), high = crossing(profile, limit, 1);
    for (const Eigen::Index radius : group) {
      Estimate& e = estimate_of(radius);
      if (std::isinf(low) && std::isinf(high))
        e.not_identifiable =
            "is not separable from the stiffness in these logs: its profile likelihood is flat "
            "from half to twice the value; move the link farther, or give the radius";
      else
        take_interval(radii(radius), low, high, e);
    }
  }
}

}  // namespace cablefit
