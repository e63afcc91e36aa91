#include "cablefit/elastic/zeros/standstill.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr double kLeastShare = 0.01;  // of the samples; fewer change f_sm by less than its sd

/// rad/s; the rest speed that would have been chosen.
double chosen_rest_speed(const ElasticJob& job) {
  SampleOptions chosen = job.options.samples;
  chosen.rest_speed.reset();
  return blocked_settings(job.logs, job.wanted, chosen).rest_speed_theta;
}

/// "samples in motion alone give 2.8 N m; "; nothing where they do not determine it.
std::string friction_in_motion(const BlockedRows& moving, const ElasticCandidate& cables,
                               const std::string& unit) {
  const LinearSolution s = solve_candidate(moving, cables);
  const auto at = std::find(cables.names.begin(), cables.names.end(), "f_sm");
  const auto k = static_cast<std::size_t>(at - cables.names.begin());
  if (k == cables.names.size() || !s.not_identifiable[k].empty()) return "";
  return fmt::format("samples in motion alone give {:.3g} {}; ", s.x(static_cast<Eigen::Index>(k)),
                     unit);
}

}  // namespace

void note_standstill(const ElasticJob& job, const BlockedRows& rows, const ElasticCandidate& cables,
                     ElasticPreload& preload) {
  const Estimate* friction = find_estimate(preload.fits.back().parameters, "f_sm");
  if (job.options.samples.rest_speed.value_or(1) != 0 || friction == nullptr) return;
  const double rest = chosen_rest_speed(job);
  const BlockedRows moving = rows_where(rows, [&](const Eigen::Ref<const Eigen::RowVectorXd>& row) {
    return std::abs(row(rows.columns.speed)) >= rest;
  });
  const auto n = static_cast<double>(rows.rows->n_rows());
  const double share = 1 - static_cast<double>(moving.rows->n_rows()) / n;
  if (share < kLeastShare) return;
  const std::string unit = torque_unit(preload.axes);
  preload.warnings.push_back(
      fmt::format("--rest-speed 0 keeps samples at standstill ({:.0f} %), where the torque lies "
                  "anywhere in the "
                  "friction band: f_sm = {:.3g} {} is too low; {}leave --rest-speed out",
                  100 * share, friction->value, unit, friction_in_motion(moving, cables, unit)));
}

}  // namespace cablefit
