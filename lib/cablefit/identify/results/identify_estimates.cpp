#include "cablefit/identify/results/identify_estimates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/identify/equations/joint_radii.hpp"
#include "cablefit/identify/results/determined.hpp"

namespace cablefit {
namespace {

// Variance left to a scaled parameter that equalities hold, rounding squared.
constexpr double kHeld = 1e-20;

double sd_at(const Eigen::MatrixXd& covariance, Eigen::Index k) {
  return std::sqrt(std::max(0.0, covariance(k, k)));
}

const Eigen::MatrixXd& chosen(const JointCovariance& covariance, bool robust) {
  return robust ? covariance.covariance : covariance.white;
}

/// The bound that holds a parameter at 0; empty when none does. A coefficient may be held by
/// several conditions on its cable together.
std::string bound_of(const JointFit& fit, const JudgedPoint& judged, Eigen::Index k) {
  if (!judged.unbounded || k >= fit.layout.n_linear) return "";
  const JointParameter& p = fit.layout.parameters[static_cast<std::size_t>(k)];
  const PhysicalBounds bounds = physical_bounds(fit, judged.point.l_o);
  for (const Eigen::Index i : judged.point.solution.active)
    if (bounds.parameters[static_cast<std::size_t>(i)] == k) return fmt::format("{} >= 0", p.name);
  const JointSolution& s = judged.linearised;
  const bool held = s.solve_operator(k, k) * std::pow(s.column_norm(k), 2) < kHeld;
  if (k >= fit.layout.n_coefficients || !held) return "";
  return fmt::format("cable {} only pulls", fit.jobs.front().transmission.cables[p.cable].name);
}

const ElongationProfile* profile_of(const JointFit& fit, const JointParameter& p,
                                    const std::vector<ElongationProfile>& profiles) {
  if (p.preload == kShared) return nullptr;
  const std::string& preload = fit.jobs[static_cast<std::size_t>(p.preload)].name;
  for (const ElongationProfile& profile : profiles)
    if (profile.preload == preload && profile.name == p.name) return &profile;
  return nullptr;
}

double known(double end) {
  return std::isinf(end) ? std::numeric_limits<double>::quiet_NaN() : end;
}

void add_known(double part, Estimate& e) {
  e.value += part;
  e.ci_low += part;
  e.ci_high += part;
}

/// Of a linear parameter, where bounds hold the solution.
void take_profile(const JudgedPoint& judged, Eigen::Index k, bool robust, double lower,
                  Estimate& e) {
  const auto at = static_cast<std::size_t>(k);
  if (robust && at < judged.profile.size()) set_profile(e, judged.profile[at], 0, lower);
}

double value_at(const JointFit& fit, const JudgedPoint& judged, Eigen::Index k) {
  if (k < fit.layout.n_linear) return judged.point.solution.x(k);
  if (k >= fit.layout.first_radius()) return searched_radii(fit)(k - fit.layout.first_radius());
  const JointParameter& p = fit.layout.parameters[static_cast<std::size_t>(k)];
  return judged.point.l_o[static_cast<std::size_t>(p.preload)](static_cast<Eigen::Index>(p.cable));
}

Estimate estimate_at(const JointFit& fit, const JudgedPoint& judged,
                     const ElongationProfile* profile, Eigen::Index k, bool robust) {
  const JointParameter& p = fit.layout.parameters[static_cast<std::size_t>(k)];
  Estimate e;
  e.name = p.name;
  e.symbol = p.symbol;
  e.unit = p.unit;
  e.not_identifiable = why_undetermined(fit, judged, k);
  if (profile != nullptr && std::isinf(profile->low) && std::isinf(profile->high))
    e.not_identifiable = "its profile likelihood is flat over all elongations of the search";
  if (!e.not_identifiable.empty()) return e;
  const double degrees_of_freedom = judged.covariance.degrees_of_freedom(k);
  e.active_bound = bound_of(fit, judged, k);
  if (!e.active_bound.empty()) {
    e.sd = sd_at(chosen(judged.unbounded->covariance, robust), k);
    e.sd_white = sd_at(judged.unbounded->covariance.white, k);
    set_on_bound(e, judged.unbounded->x(k), degrees_of_freedom);
    take_profile(judged, k, robust, 0, e);  // at its bound, 0: one-sided
    add_known(p.known, e);
    return e;
  }
  e.value = value_at(fit, judged, k);
  e.sd = sd_at(chosen(judged.covariance, robust), k);
  e.sd_white = sd_at(judged.covariance.white, k);
  set_interval(e, degrees_of_freedom, p.lower);
  take_profile(judged, k, robust, p.lower, e);
  if (profile != nullptr) {
    e.ci_low = known(profile->low);
    e.ci_high = known(profile->high);
    e.profiled = true;
  }
  add_known(p.known, e);
  return e;
}

}  // namespace

std::vector<Estimate> joint_estimates(const JointFit& fit, const JudgedPoint& judged,
                                      const std::vector<ElongationProfile>& profiles, bool robust) {
  std::vector<Estimate> estimates;
  for (std::size_t k = 0; k < fit.layout.parameters.size(); ++k)
    estimates.push_back(estimate_at(fit, judged,
                                    profile_of(fit, fit.layout.parameters[k], profiles),
                                    static_cast<Eigen::Index>(k), robust));
  return estimates;
}

}  // namespace cablefit
