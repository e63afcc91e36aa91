#include "cablefit/dynamic/rows/torque_delay.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/estimate/fit/least_squares.hpp"
#include "cablefit/estimate/spread/long_run.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/preliminary.hpp"
#include "cablefit/samples/rows/torque_hold.hpp"

namespace cablefit {
namespace {

constexpr int kDelayWindows = 8;
constexpr double kDelayMisfit = 0.1;  // of the hold; less hardly moves any parameter

Eigen::ArrayXd slope(const Eigen::ArrayXd& x, double h) {
  Eigen::ArrayXd d = Eigen::ArrayXd::Zero(x.size());
  if (x.size() > 2)
    d.segment(1, x.size() - 2) = (x.tail(x.size() - 2) - x.head(x.size() - 2)) / (2 * h);
  return d;
}

/// The equation with two columns more: slope of the measured and of the model's torque.
Equation with_slopes(const Equation& base, const DynamicColumns& c, const Eigen::VectorXd& model) {
  Equation equation = base;
  equation.averaged.insert(equation.averaged.end(), {true, true});
  equation.columns.insert(equation.columns.end(), {"", ""});
  equation.fill = [base, c, model](const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
    base.fill(signals, out.leftCols(c.count));
    out.col(c.count) = slope(out.col(c.torque).array(), signals.period);
    out.col(c.count + 1) = slope((out.leftCols(c.count) * model).array(), signals.period);
  };
  return equation;
}

RowStatistics preliminary_rows(std::span<const LogSurvey> logs,
                               const std::vector<PreliminaryWindow>& preliminary,
                               const RowSettings& rows, const Equation& equation) {
  Eigen::Index expected = 0;
  for (const PreliminaryWindow& p : preliminary)
    expected += (p.window.end - p.window.begin) / rows.decimate + 1;
  RowStatistics statistics(static_cast<Eigen::Index>(equation.columns.size()), expected);
  Eigen::Index offset = 0;
  std::size_t log = 0;
  for (const PreliminaryWindow& p : preliminary) {
    if (p.log != log) offset += static_cast<Eigen::Index>(logs[log].n_rows) / rows.decimate + 1;
    log = p.log;
    const RowBatch batch = make_rows(p.window, logs[p.log], offset, rows, {&equation, 1});
    statistics.add(batch.equations[0].rows, batch.equations[0].numbers);
  }
  return statistics;
}

std::string hold_text(double hold, bool held) {
  return held ? fmt::format("half a hold of {:.3g} ms (zoh)", 1e3 * hold) : "0 (none)";
}

/// A hold that the rig file does not limit may be shorter than the row of the log.
void take_shorter_hold(double row, TorqueDelay& delay) {
  const std::optional<int> periods = drive_periods({delay.seconds, delay.sd}, row);
  if (periods && *periods > 1) delay.hold = delay.period = row / *periods;
}

/// Which convention is nearer, and whether either is near enough.
void judge_delay(TorqueDelay& delay) {
  const double ms = 1e3, hold = delay.hold;
  const std::string found =
      fmt::format("the torque acts {:.3g} +- {:.2g} ms after its time stamp (1 sd)",
                  ms * delay.seconds, ms * delay.sd);
  if (!(delay.sd < hold / 4)) {
    delay.held = false;
    delay.period = 0;
    delay.undecided = true;
    delay.reason = found + ": the motion does not show whether it is held";
    delay.warning =
        "these logs do not show whether the torque is held over a sample; no hold is "
        "assumed; set \"torque_hold\" in the rig file";
    return;
  }
  delay.held = std::abs(delay.seconds - hold / 2) < std::abs(delay.seconds);
  delay.reason = fmt::format("{}: nearer to {}", found, hold_text(hold, delay.held));
  if (delay.period > 0) {
    delay.reason += ", less than a row of the log";
    return;
  }
  const double left = std::abs(delay.seconds - (delay.held ? hold / 2 : 0));
  if (left > std::max(3 * delay.sd, kDelayMisfit * hold))
    delay.warning = fmt::format(
        "{}; neither a hold of {:.3g} ms nor none explains that, and inertia and friction may be "
        "biased: give the drive's period, \"torque_period\", in the rig file, or look for a delay "
        "in the drive or the log",
        found, ms * hold);
}

struct DelayFit {
  double seconds = 0, sd = 0;
};

/// Instrumental variables: instruments [W, model slope] for regressors [W, measured slope]; the
/// last coefficient is the delay. `rows`: columns of the equation, then the measured and the model
/// slope.
std::optional<DelayFit> fit_delay(const RowStatistics& rows, const DynamicColumns& c,
                                  const Eigen::VectorXd& plain_response) {
  const Eigen::Index p = c.n_effects + 1;
  const Eigen::MatrixXd gram = rows.r().transpose() * rows.r();
  std::vector<Eigen::Index> z, x;
  for (Eigen::Index k = 0; k < c.n_effects; ++k) z.push_back(k), x.push_back(k);
  x.push_back(c.count);
  z.push_back(c.count + 1);
  Eigen::VectorXd response = Eigen::VectorXd::Zero(c.count + 2);
  response.head(c.count) = plain_response;
  Eigen::VectorXd scale(p);
  for (Eigen::Index k = 0; k < p; ++k)
    scale(k) =
        1 / std::sqrt(std::max(gram(z[static_cast<std::size_t>(k)], z[static_cast<std::size_t>(k)]),
                               1e-300));
  Eigen::MatrixXd zx(p, p);
  Eigen::VectorXd zy(p);
  for (Eigen::Index i = 0; i < p; ++i) {
    const auto zi = z[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < p; ++j)
      zx(i, j) = scale(i) * gram(zi, x[static_cast<std::size_t>(j)]) * scale(j);
    zy(i) = scale(i) * gram.row(zi).dot(response);
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(zx);
  if (!lu.isInvertible()) return std::nullopt;
  const Eigen::VectorXd solution = scale.cwiseProduct(lu.solve(zy));
  Eigen::VectorXd residual = response;
  for (Eigen::Index k = 0; k < p; ++k) residual(x[static_cast<std::size_t>(k)]) -= solution(k);
  // Influence of each cell on the delay alone: the last row of (Z'X)^-1 times its scores.
  const Eigen::RowVectorXd last = lu.inverse().row(p - 1).cwiseProduct(scale.transpose());
  const Eigen::MatrixXd series =
      series_over_time(rows.cells(), 1, [&](const GramCell& cell) -> Eigen::RowVectorXd {
        const Eigen::VectorXd all = cell.gram * residual;
        const Eigen::VectorXd scores = all(z);
        return last * scores;
      });
  const LongRunCovariance spread = long_run_covariance(series);
  return DelayFit{solution(p - 1), scale(p - 1) * std::sqrt(spread.covariance(0, 0))};
}

}  // namespace

TorqueDelay estimate_torque_delay(std::span<const LogSurvey> logs, const PartFilter& wanted,
                                  const RowSettings& settings, double rest_speed, Side side,
                                  const ElasticFit* elastic, const JointPlace& place) {
  TorqueDelay delay;
  RowSettings rows = settings;
  rows.signal.torque_held = false;
  std::vector<const ElasticFit*> fits;
  if (elastic != nullptr) fits.push_back(elastic);
  const DynamicColumns c = dynamic_columns(side, fits, ElasticDetail::torque, place);
  const Equation base = dynamic_equation(c, fits, false, rest_speed);
  const double rate = sample_rates(logs, wanted).highest;
  const double period = 1 / rate;
  const auto preliminary =
      preliminary_windows(logs, wanted, rows.signal, row_halo(rows, rate), kDelayWindows);

  LinearProblem problem;
  for (Eigen::Index k = 0; k < c.n_effects; ++k) problem.regressors.push_back(k);
  problem.names.assign(problem.regressors.size(), "");
  problem.response = dynamic_response(c, fits, 0);
  const RowStatistics plain = preliminary_rows(logs, preliminary, rows, base);
  if (plain.n_rows() < 50) {
    delay.reason = "too few rows in motion to estimate a torque delay";
    return delay;
  }
  const LinearSolution start = solve(plain, problem);
  // The model's torque: effects plus elastic torque, i.e. the torque column less the residual.
  Eigen::VectorXd model = Eigen::VectorXd::Unit(c.count, c.torque) - start.residual_combination;
  const RowStatistics with_slope_rows =
      preliminary_rows(logs, preliminary, rows, with_slopes(base, c, model));

  const auto fitted = fit_delay(with_slope_rows, c, problem.response);
  if (!fitted) {
    delay.reason = "the motion does not determine a torque delay";
    return delay;
  }
  delay.estimated = true;
  delay.seconds = fitted->seconds;
  delay.sd = fitted->sd;
  delay.hold = rows.signal.torque_period > 0 ? rows.signal.torque_period : period;
  if (!(rows.signal.torque_period > 0)) take_shorter_hold(period, delay);
  judge_delay(delay);
  return delay;
}

}  // namespace cablefit
