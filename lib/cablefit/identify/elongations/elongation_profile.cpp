#include "cablefit/identify/elongations/elongation_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cablefit {
namespace {

constexpr std::array kNear = {-3.0, -2.5, -2.0, -1.5, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0};
// Deviance below the best that is no rounding of a descent, and still says nothing of any l_o.
constexpr double kBelow = 0.01;
constexpr std::array kFar = {-50.0, -25.0, -12.0, -7.0, -4.5, 4.5, 7.0, 12.0, 25.0, 50.0};

const JointParameter& parameter_at(const JointFit& fit, Eigen::Index k) {
  return fit.layout.parameters[static_cast<std::size_t>(k)];
}

double& elongation_of(const JointFit& fit, Elongations& l_o, Eigen::Index k) {
  const JointParameter& p = parameter_at(fit, k);
  return l_o[static_cast<std::size_t>(p.preload)](static_cast<Eigen::Index>(p.cable));
}

/// `distance` sd from the best, where the others go along by their covariance.
ElongationStart start_at(const JointFit& fit, const JointPoint& best, Eigen::Index k,
                         const Eigen::MatrixXd& covariance, double distance) {
  ElongationStart start{best.l_o, {k}};
  const double sd = std::sqrt(covariance(k, k));
  for (Eigen::Index other = fit.layout.n_linear; other < covariance.rows(); ++other)
    elongation_of(fit, start.l_o, other) += covariance(other, k) / sd * distance;
  return start;
}

/// Adds the points at these distances to the profiles for which `wanted` says true.
template <typename Wanted>
void add_points(JointFit& fit, const JointPoint& best, const std::vector<Eigen::Index>& which,
                const Eigen::MatrixXd& covariance, std::span<const double> distances, Wanted wanted,
                std::vector<std::vector<std::pair<double, double>>>& points, double allowed,
                std::optional<JointPoint>& better) {
  std::vector<ElongationStart> starts;
  std::vector<std::size_t> owner;
  for (std::size_t i = 0; i < which.size(); ++i)
    for (const double distance : distances) {
      if (!wanted(i, distance)) continue;
      starts.push_back(start_at(fit, best, which[i], covariance, distance));
      const JointParameter& p = parameter_at(fit, which[i]);
      const double at = elongation_of(fit, starts.back().l_o, which[i]);
      if (std::abs(at) > search_reach(fit, static_cast<std::size_t>(p.preload), p.cable)) {
        starts.pop_back();
        continue;
      }
      owner.push_back(i);
    }
  if (starts.empty()) return;
  std::vector<JointPoint> ends = descend(fit, starts);
  for (std::size_t s = 0; s < ends.size(); ++s)
    points[owner[s]].emplace_back(elongation_of(fit, ends[s].l_o, which[owner[s]]),
                                  ends[s].merit() - best.merit());
  const JointPoint& lowest = best_of(ends);
  if (lowest.merit() < (better ? better->merit() : best.merit() - allowed)) better = lowest;
  for (auto& profile : points) std::sort(profile.begin(), profile.end());
}

/// Where the signed root of the deviance crosses -t or t, going outwards from the best; infinite
/// when it does not.
double crossing(const std::vector<std::pair<double, double>>& points, double best, double t,
                bool upwards) {
  double last = best, last_root = 0;
  const auto step = [&](const std::pair<double, double>& point) {
    const double root = std::sqrt(std::max(0.0, point.second));
    if (root >= t) return last + (point.first - last) * (t - last_root) / (root - last_root);
    last = point.first;
    last_root = root;
    return std::numeric_limits<double>::quiet_NaN();
  };
  if (upwards) {
    for (const auto& point : points)
      if (point.first > best)
        if (const double at = step(point); !std::isnan(at)) return at;
    return kUnbounded;
  }
  for (auto point = points.rbegin(); point != points.rend(); ++point)
    if (point->first < best)
      if (const double at = step(*point); !std::isnan(at)) return at;
  return -kUnbounded;
}

}  // namespace

ElongationProfiles profile_elongations(JointFit& fit, const JointPoint& best,
                                       const std::vector<Eigen::Index>& which,
                                       const Eigen::MatrixXd& covariance,
                                       const std::vector<double>& t,
                                       const std::vector<double>& scale) {
  ElongationProfiles out;
  std::vector<std::vector<std::pair<double, double>>> points(which.size());
  JointPoint centre = best;
  // Where something is left open, the point was chosen for it among others a little lower.
  const double allowed = n_undetermined(fit, best) > 0 ? kUnbounded : kBelow;
  add_points(
      fit, best, which, covariance, kNear, [](std::size_t, double) { return true; }, points,
      allowed, out.better);
  if (out.better) return out;
  add_points(
      fit, best, which, covariance, kFar,
      [&](std::size_t i, double distance) {
        const double at = elongation_of(fit, centre.l_o, which[i]);
        return std::isinf(crossing(points[i], at, t[i] / std::sqrt(scale[i]), distance > 0));
      },
      points, allowed, out.better);
  if (out.better) return out;
  for (std::size_t i = 0; i < which.size(); ++i) {
    const JointParameter& p = parameter_at(fit, which[i]);
    const PreloadJob& job = fit.jobs[static_cast<std::size_t>(p.preload)];
    const double at = elongation_of(fit, centre.l_o, which[i]);
    ElongationProfile profile{job.name, p.name, p.unit, {}, {}, t[i] * t[i]};
    const double limit = t[i] / std::sqrt(scale[i]);
    profile.low = crossing(points[i], at, limit, false);
    profile.high = crossing(points[i], at, limit, true);
    points[i].emplace_back(at, 0.0);
    std::sort(points[i].begin(), points[i].end());
    for (const auto& [l_o, deviance] : points[i]) {
      profile.l_o.push_back(l_o);
      profile.deviance.push_back(scale[i] * deviance);
    }
    out.profiles.push_back(std::move(profile));
  }
  return out;
}

}  // namespace cablefit
