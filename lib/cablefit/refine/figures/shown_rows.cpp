#include "cablefit/refine/figures/shown_rows.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "cablefit/refine/rows/regime_variables.hpp"

namespace cablefit {
namespace {

constexpr double kPause = 1;  // s between logs on the time axis

std::vector<double> variables_at(const Design& design, std::size_t stretch, Eigen::Index at,
                                 RowKind kind) {
  std::vector<double> values;
  for (const RegimeVariable& variable : regime_variables())
    values.push_back(value_at(variable, design, stretch, kind, at));
  return values;
}

template <typename Rows>
bool has_rows_of(const Rows& rows, RowKind wanted) {
  return std::any_of(rows.kinds.begin(), rows.kinds.end(), [wanted](const KindRows& kind) {
    return kind.kind == wanted && !kind.at.empty();
  });
}

}  // namespace

Timeline timeline_of(const Design& design, std::span<const LogSurvey> logs, RowKind wanted) {
  Timeline time;
  double next = 0;
  std::size_t log = std::numeric_limits<std::size_t>::max();
  for (std::size_t s = 0; s < design.stretches.size(); ++s) {
    const Stretch& stretch = design.stretches[s];
    if (!has_rows_of(design.rows[s], wanted)) {
      time.begins.push_back(next);
      continue;
    }
    if (stretch.log != log) {
      log = stretch.log;
      const std::filesystem::path path = logs[log].plan.path;
      time.marks.push_back({next, path.filename().string()});
    }
    time.begins.push_back(next);
    const double period = stretch.recording.period;
    time.spacing = std::max(time.spacing, design.smoothing_of(s).row_period());
    next += static_cast<double>(stretch.recording.theta.size()) * period + kPause;
  }
  time.end = std::max(next - kPause, time.spacing);
  if (time.marks.size() < 2) time.marks.clear();
  return time;
}

ShownRows shown_rows(const Design& design, const Eigen::VectorXd& x, RowKind wanted,
                     const Timeline& time) {
  ShownRows shown;
  constexpr Eigen::Index kApart = 1000;  // places, more than lags are shown
  double squares = 0;
  Eigen::Index first = 0;
  for (std::size_t s = 0; s < design.rows.size(); ++s) {
    const Smoothing smoothing = design.smoothing_of(s);
    for (const KindRows& kind : design.rows[s].kinds) {
      if (kind.kind != wanted) continue;
      const double period = smoothing.period;
      shown.row_period = std::max(shown.row_period, smoothing.row_period());
      const Eigen::VectorXd residual = kind.response - kind.base * x;
      for (std::size_t i = 0; i < kind.at.size(); ++i) {
        const double t = time.begins[s] + static_cast<double>(kind.at[i]) * period;
        const double r = residual(static_cast<Eigen::Index>(i));
        shown.rows.push_back({t, variables_at(design, s, kind.at[i], wanted), r});
        shown.numbers.push_back(first + kind.at[i] / smoothing.stride);
        squares += r * r;
      }
    }
    first += design.stretches[s].recording.theta.size() / smoothing.stride + kApart;
  }
  if (!shown.rows.empty()) shown.rms = std::sqrt(squares / static_cast<double>(shown.rows.size()));
  return shown;
}

}  // namespace cablefit
