#include "cablefit/dynamic/checks/conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/dynamic/checks/residual_tests.hpp"
#include "cablefit/estimate/spread/long_run.hpp"
#include "cablefit/estimate/tests/binned_test.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kQuarters = 4;
constexpr std::size_t kSampled = 20000;  // values that edges are chosen from
constexpr double kLevelWidth = 0.01;     // of all loads: narrower is one load
constexpr std::size_t kFewRows = 20;     // fewer say nothing about an rms
constexpr double kMaterialRatio = 1.25;  // of the rms errors
constexpr double kSignificantSd = 3;

std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.3g} {}", value, unit);
}

Condition by_log(const JudgedRows& rows, const std::vector<std::string>& logs) {
  Condition c{"log", rows.log, 1, {}, logs, false};
  for (std::size_t k = 1; k < logs.size(); ++k) c.edges.push_back(static_cast<double>(k) - 0.5);
  return c;
}

Condition by_speed(const JudgedRows& fitted) {
  const JudgedVariable& v = fitted.variable(kVelocity);
  std::vector<double> speeds = sampled_column(fitted, v.column, kSampled);
  for (double& speed : speeds) speed = std::abs(speed);
  Condition c{"speed", v.column, 0, bin_edges(speeds, kQuarters), {}, true};
  if (c.edges.empty()) return c;
  c.labels.push_back("below " + with_unit(c.edges.front(), v.unit));
  for (std::size_t k = 1; k < c.edges.size(); ++k)
    c.labels.push_back(fmt::format("{:.3g} .. {}", c.edges[k - 1], with_unit(c.edges[k], v.unit)));
  c.labels.push_back("above " + with_unit(c.edges.back(), v.unit));
  const double fastest = *std::max_element(speeds.begin(), speeds.end());
  c.edges.push_back(fastest);
  c.labels.push_back("beyond the fitted " + with_unit(fastest, v.unit));
  return c;
}

/// A label for the values of one bin.
std::string range_label(const std::vector<double>& sorted, double width, const std::string& unit) {
  const double low = sorted.front(), high = sorted.back();
  if (high - low <= width) return with_unit(0.5 * (low + high), unit);
  return fmt::format("{:.3g} .. {}", low, with_unit(high, unit));
}

Condition by_load(const JudgedRows& rows) {
  const JudgedVariable& v = rows.variable(kLoad);
  std::vector<double> loads = sampled_column(rows, v.column, kSampled);
  std::erase_if(loads, [](double x) { return !std::isfinite(x); });
  std::sort(loads.begin(), loads.end());
  Condition c{"load", v.column, 1, {}, {}, true};
  if (loads.empty()) return c;
  c.edges = bin_edges(loads, kQuarters);
  const double width = kLevelWidth * std::max(std::abs(loads.front()), std::abs(loads.back()));
  auto from = loads.begin();
  for (std::size_t k = 0; k <= c.edges.size(); ++k) {
    const auto to =
        k < c.edges.size() ? std::lower_bound(from, loads.end(), c.edges[k]) : loads.end();
    c.labels.push_back(from == to ? "" : range_label({from, to}, width, v.unit));
    from = to;
  }
  return c;
}

/// Sums over the rows of one bin.
struct BinErrors {
  std::size_t n_rows = 0;
  double sum = 0, squares = 0, largest = 0, torque = 0, linear = 0;
  std::vector<double> cells;  ///< of squared residuals, by stretch of time
  std::vector<double> cell_rows;

  void add(double residual, double torque_here, double linear_here, std::size_t cell) {
    ++n_rows;
    sum += residual;
    squares += residual * residual;
    largest = std::max(largest, std::abs(residual));
    torque += torque_here * torque_here;
    linear += linear_here * linear_here;
    if (cell >= cells.size()) {
      cells.resize(cell + 1, 0.0);
      cell_rows.resize(cell + 1, 0.0);
    }
    cells[cell] += residual * residual;
    cell_rows[cell] += 1;
  }
  double root(double sum_of_squares) const {
    return n_rows > 0 ? std::sqrt(sum_of_squares / static_cast<double>(n_rows)) : 0;
  }
};

using Bins = std::vector<std::vector<BinErrors>>;  ///< by condition and bin; the first is of all

Bins collect(const JudgedRows& rows, const std::vector<Condition>& conditions,
             const JudgedModel& model) {
  Bins bins = {std::vector<BinErrors>(1)};
  for (const Condition& c : conditions) bins.emplace_back(c.edges.size() + 1);
  const Eigen::Index places = stretch_places(rows.last_number);
  rows.rows->for_each([&](const Eigen::MatrixXd& batch, std::span<const Eigen::Index> numbers) {
    const auto own = batch.leftCols(rows.n_own);
    const Eigen::VectorXd residual = own * model.residual, torque = own * model.torque;
    Eigen::VectorXd linear = Eigen::VectorXd::Zero(residual.size());
    if (model.linear.size() > 0) linear = own * model.linear;
    for (Eigen::Index i = 0; i < batch.rows(); ++i) {
      const auto cell = static_cast<std::size_t>(numbers[static_cast<std::size_t>(i)] / places);
      bins[0][0].add(residual(i), torque(i), linear(i), cell);
      for (std::size_t c = 0; c < conditions.size(); ++c) {
        const double raw = batch(i, conditions[c].column);
        if (!std::isfinite(raw)) continue;
        const double value = conditions[c].sign == 0 ? std::abs(raw) : raw;
        bins[c + 1][bin_of(value, conditions[c].edges)].add(residual(i), torque(i), linear(i),
                                                            cell);
      }
    }
  });
  return bins;
}

/// Excess of the bin's squared error over `expected`, in sd of it.
double excess_in_sd(const BinErrors& bin, double expected) {
  std::vector<double> excess;
  for (std::size_t c = 0; c < bin.cells.size(); ++c)
    if (bin.cell_rows[c] > 0)
      excess.push_back(bin.cells[c] - bin.cell_rows[c] * expected * expected);
  const auto n = static_cast<Eigen::Index>(excess.size());
  Eigen::MatrixXd series = Eigen::Map<const Eigen::MatrixXd>(excess.data(), n, 1);
  const double total = series.sum();
  series.array() -= total / static_cast<double>(n);
  const double variance = long_run_covariance(series).covariance(0, 0);
  return variance > 0 ? total / std::sqrt(variance) : 0;
}

std::string ratio_text(const ConditionError& e) {
  return e.ratio() < 9.95 ? fmt::format("{:.1f}", e.ratio()) : fmt::format("{:.0f}", e.ratio());
}

ConditionError error_of(const BinErrors& bin, double fitted, bool has_linear) {
  ConditionError e;
  e.n_rows = bin.n_rows;
  e.rms = bin.root(bin.squares);
  e.mean = bin.sum / static_cast<double>(bin.n_rows);
  e.max_abs = bin.largest;
  e.zero = bin.root(bin.torque);
  e.relative = e.zero > 0 ? e.rms / e.zero : 0;
  if (has_linear) e.linear = bin.root(bin.linear);
  e.fitted = fitted;
  if (e.n_rows < kFewRows) {
    e.verdict = "too few rows";
    return e;
  }
  const bool is_larger = e.ratio() > kMaterialRatio;
  e.fails = is_larger && excess_in_sd(bin, fitted) > kSignificantSd;
  e.verdict =
      fmt::format("{}, {} times{}",
                  e.fails     ? "fails"
                  : is_larger ? "unsure"
                              : "holds",
                  ratio_text(e), is_larger && !e.fails ? " (too few independent rows)" : "");
  return e;
}

}  // namespace

std::vector<Condition> conditions(const JudgedRows& unseen, const JudgedRows& fitted,
                                  const std::vector<std::string>& logs) {
  std::vector<Condition> all = {by_log(unseen, logs), by_load(unseen), by_speed(fitted)};
  all.push_back({"direction", unseen.variable(kVelocity).column, 1, {0}, {"-", "+"}, true});
  all.push_back({"drive",
                 unseen.variable(kDrive).column,
                 1,
                 {0.3 * kDriveOff, 0},
                 {"off (no torque)", "brakes", "drives"},
                 true});
  std::erase_if(all, [](const Condition& c) { return c.labels.empty(); });
  return all;
}

std::vector<ConditionError> condition_errors(const JudgedRows& unseen, const JudgedRows& fitted,
                                             const std::vector<Condition>& conditions,
                                             const JudgedModel& model) {
  const Bins bins = collect(unseen, conditions, model), known = collect(fitted, conditions, model);
  const BinErrors& all = known[0][0];
  const double overall = all.root(all.squares);
  const bool has_linear = model.linear.size() > 0;
  std::vector<ConditionError> out;
  if (bins[0][0].n_rows == 0) return out;
  out.push_back(error_of(bins[0][0], overall, has_linear));
  out.back().condition = "all";
  for (std::size_t c = 0; c < conditions.size(); ++c)
    for (std::size_t b = 0; b < bins[c + 1].size(); ++b) {
      const BinErrors& bin = bins[c + 1][b];
      const BinErrors& same = known[c + 1][b];
      if (bin.n_rows == 0) continue;
      const bool has_same = conditions[c].is_comparable && same.n_rows >= kFewRows;
      out.push_back(error_of(bin, has_same ? same.root(same.squares) : overall, has_linear));
      out.back().condition = conditions[c].name;
      out.back().value = conditions[c].labels[b];
    }
  return out;
}

}  // namespace cablefit
