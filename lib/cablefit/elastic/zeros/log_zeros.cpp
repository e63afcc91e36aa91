#include "cablefit/elastic/zeros/log_zeros.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "cablefit/estimate/solve/scaled_solve.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kFewestZeroRows = 10;
constexpr double kMostOf = 0.75;      // of the squared residual, that zeros of their own explain
constexpr double kWorthWords = 0.02;  // of the peak torque, that is left without them

struct LogZeros {
  struct Zero {
    std::string log;     ///< path
    double theta_0 = 0;  ///< rad (m on a linear axis)
  };
  std::vector<Zero> zeros;  ///< in the order of the logs
  double rms = 0;           ///< what is left with a zero per log, N m (N)
};

/// The rows of one log, as a triangle; empty when there are too few.
Eigen::MatrixXd triangle_of(const ElasticJob& job, std::size_t log, const BlockedRows& rows,
                            const Transmission& fitted) {
  ElasticJob own = job;
  own.logs = job.logs.subspan(log, 1);
  const auto& parts = own.logs.front().parts;
  if (std::none_of(parts.begin(), parts.end(), job.wanted)) return {};
  const BlockedRows some = collect_blocked(own, rows.transmission.theta_0(0), &fitted);
  if (some.plateaus != rows.plateaus || some.rows->n_rows() < kFewestZeroRows) return {};
  return some.rows->r();
}

/// One Gauss-Newton step from the curve `fitted`, which becomes the curve found.
std::optional<LogZeros> zeros_from(const ElasticJob& job, const BlockedRows& rows,
                                   const ElasticCandidate& candidate, Transmission& fitted) {
  std::vector<Eigen::MatrixXd> triangles;
  LogZeros found;
  for (std::size_t k = 0; k < job.logs.size(); ++k) {
    Eigen::MatrixXd r = triangle_of(job, k, rows, fitted);
    if (r.size() == 0) continue;
    triangles.push_back(std::move(r));
    found.zeros.push_back({job.logs[k].plan.path, 0});
  }
  const auto n_logs = static_cast<Eigen::Index>(triangles.size());
  if (n_logs < 2) return {};
  // The zero of each log in a column of its own, after the shared ones. A drive's offset is part of
  // it: only a kink in the curve would separate the two.
  std::vector<Eigen::Index> shared = candidate.regressors;
  std::erase(shared, rows.columns.offset);
  std::erase(shared, rows.columns.zero);
  const auto n_shared = static_cast<Eigen::Index>(shared.size());
  const Eigen::Index height = triangles.front().rows();
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(n_logs * height, n_shared + n_logs);
  Eigen::VectorXd y(n_logs * height);
  for (Eigen::Index k = 0; k < n_logs; ++k) {
    const Eigen::MatrixXd& r = triangles[static_cast<std::size_t>(k)];
    w.block(k * height, 0, height, n_shared) = r(Eigen::indexing::all, shared);
    w.block(k * height, n_shared + k, height, 1) = r.col(rows.columns.zero);
    y.segment(k * height, height) = r.col(rows.columns.tau);
  }
  const ScaledSolve solved = solve_scaled(w, y);
  if (solved.null_directions.cols() > 0) return {};
  const Eigen::VectorXd& x = solved.x;
  found.rms = (y - w * x).norm() / std::sqrt(static_cast<double>(rows.rows->n_rows()));
  for (Eigen::Index k = 0; k < n_logs; ++k)
    found.zeros[static_cast<std::size_t>(k)].theta_0 =
        rows.transmission.theta_0(0) + x(n_shared + k);
  fitted = fitted_transmission(candidate, x);
  fitted.theta_0 = rows.transmission.theta_0;
  return found;
}

/// One curve for all logs and a zero for each; nothing for a single log, or where the rows do not
/// determine them. `fitted`: with one zero for all.
std::optional<LogZeros> find_log_zeros(const ElasticJob& job, const BlockedRows& rows,
                                       const ElasticCandidate& candidate,
                                       const Transmission& fitted) {
  Transmission curve = fitted;  // fitted with one zero for all, its slope is off
  if (!zeros_from(job, rows, candidate, curve)) return {};
  return zeros_from(job, rows, candidate, curve);
}

}  // namespace

double note_log_zeros(const ElasticJob& job, const BlockedRows& rows,
                      std::span<const ElasticCandidate> candidates, ElasticPreload& preload) {
  const ElasticFit& selected = *preload.find(preload.selected);
  const double left = selected.rms_error;
  if (job.logs.size() < 2 || left < kWorthWords * preload.peak_torque) return left;
  const auto candidate = std::find_if(candidates.begin(), candidates.end(),
                                      [&](const auto& c) { return c.model == preload.selected; });
  const auto found = find_log_zeros(job, rows, *candidate, selected.transmission);
  if (!found || found->rms * found->rms > (1 - kMostOf) * left * left) return left;
  const Axes axes = preload.axes;
  std::string zeros;
  for (const LogZeros::Zero& zero : found->zeros)
    zeros += fmt::format("{}{:.4g} {} in {}", zeros.empty() ? "" : ", ", 1e3 * zero.theta_0,
                         unit_for(axes, "mrad"), zero.log);
  preload.warnings.push_back(
      fmt::format("the encoder zero differs between logs: with one each the residual is {:.3g} "
                  "of {:.3g} {} rms ({}); was an axis homed between them? `cablefit refine` of "
                  "these logs identifies it as a slip and fits all logs with it",
                  found->rms, left, torque_unit(axes), zeros));
  return found->rms;
}

}  // namespace cablefit
