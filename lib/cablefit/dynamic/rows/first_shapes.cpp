#include "cablefit/dynamic/rows/first_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/preliminary.hpp"

namespace cablefit {
namespace {

constexpr int kShapeWindows = 6;  // of every log
constexpr double kMost = 0.99;    // of the values, that LogScale covers
constexpr double kUsual = 0.75;   // of |tau|

bool is_blank(const EffectInstance& effect) {
  return std::any_of(effect.parameters.begin(), effect.parameters.end(),
                     [](const Estimate& e) { return std::isnan(e.value); });
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void append(std::vector<double>& all, const Eigen::ArrayXd& values) {
  const Eigen::ArrayXd sizes = values.abs();
  all.insert(all.end(), sizes.begin(), sizes.end());
}

LogScale scale_of(const DynamicJob& job, int joint) {
  std::vector<double> speeds, deflections, torques;
  double low = kUnbounded, high = -kUnbounded;
  const SignalSettings& settings = job.settings.rows.signal;
  const Eigen::Index halo = row_halo(job.settings.rows, sample_rates(job.logs, job.wanted).highest);
  for (const PreliminaryWindow& p :
       preliminary_windows(job.logs, job.wanted, settings, halo, kShapeWindows)) {
    const Signals signals = make_signals(p.window, job.logs[p.log].plan, settings);
    const JointSignals& s = signals.joints[static_cast<std::size_t>(joint)];
    append(speeds, s.thetad);
    append(torques, s.tau);
    if (!job.rigid)
      append(deflections, job.elastic.front()->transmission.deflections(joint, s.q, s.theta));
    low = std::min(low, s.theta.minCoeff());
    high = std::max(high, s.theta.maxCoeff());
  }
  return {.peak = quantile(torques, 1),
          .usual = quantile(torques, kUsual),
          .travel = (high - low) / 2,
          .speed = quantile(std::move(speeds), kMost),
          .deflection = quantile(std::move(deflections), kMost)};
}

std::vector<double> values_of(const ShapeGrid& grid, const LogScale& scale) {
  if (grid.canonical > 0) return {grid.canonical};
  std::vector<double> values;
  for (int i = 0; i < grid.n_values; ++i) values.push_back(grid.value(i, scale));
  return values;
}

/// All combinations of the values of the row's nonlinear parameters.
std::vector<std::vector<double>> points_of(const Effect& row, const LogScale& scale) {
  std::vector<std::vector<double>> points = {{}};
  for (const ShapeGrid& grid : row.shape) {
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& point : points)
      for (const double value : values_of(grid, scale)) {
        longer.push_back(point);
        longer.back().push_back(value);
      }
    points = std::move(longer);
  }
  return points;
}

/// An sd of 0 holds a nonlinear parameter; none frees it.
void set_values(EffectInstance& effect, const std::vector<double>& shape) {
  const std::size_t n = effect.effect->n_linear();
  for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
    effect.parameters[k].value = k < n ? 0 : shape[k - n];
    if (k >= n) effect.parameters[k].sd = 0;
  }
}
void set_free(EffectInstance& effect) {
  for (Estimate& e : effect.parameters) e.sd = std::numeric_limits<double>::quiet_NaN();
}

/// Sum over the equations of the logarithm of what least squares leaves: each counts alike.
double misfit(const DynamicJob& job) {
  const std::vector<EquationRows> equations = preliminary_equations(job, kShapeWindows);
  const std::vector<LinearSolution> solutions = solve_equations(equations, job.elastic, 0);
  double sum = 0;
  for (std::size_t k = 0; k < equations.size(); ++k) {
    const double rss = (equations[k].rows->r() * solutions[k].residual_combination).squaredNorm();
    sum += std::log(std::max(rss, std::numeric_limits<double>::min()));
  }
  return sum;
}

/// Tries `effect`, which has no values, as one more of the joint.
void add_at_best(const EffectInstance& effect, const LogScale& scale, DynamicJob& job,
                 std::vector<EffectInstance>& own) {
  own.push_back(effect);
  double least = kUnbounded;
  std::vector<double> best;
  for (const std::vector<double>& point : points_of(*effect.effect, scale)) {
    set_values(own.back(), point);
    const double found = misfit(job);
    if (found < least || best.empty()) best = point;
    least = std::min(least, found);
  }
  set_values(own.back(), best);
}

void add_one_by_one(const EffectsPerJoint& wanted, DynamicJob& job) {
  for (std::size_t joint = 0; joint < wanted.size(); ++joint) {
    const LogScale scale = scale_of(job, static_cast<int>(joint));
    for (const EffectInstance& effect : wanted[joint])
      if (is_blank(effect))
        add_at_best(effect, scale, job, job.added[joint]);
      else
        job.added[joint].push_back(effect);
  }
}

}  // namespace

EffectsPerJoint with_values(EffectsPerJoint effects) {
  for (std::vector<EffectInstance>& own : effects) std::erase_if(own, is_blank);
  return effects;
}

void find_first_shapes(DynamicJob& job) {
  const EffectsPerJoint wanted = job.added;
  if (std::none_of(wanted.begin(), wanted.end(), [](const std::vector<EffectInstance>& own) {
        return std::any_of(own.begin(), own.end(), is_blank);
      }))
    return;
  for (std::vector<EffectInstance>& own : job.added) own.clear();
  add_one_by_one(wanted, job);
  EffectsPerJoint found = job.added;
  const std::vector<EquationRows> equations = preliminary_equations(job, kShapeWindows);
  const std::vector<LinearSolution> solutions = solve_equations(equations, job.elastic, 0);
  for (std::size_t k = 0; k < equations.size(); ++k)
    take_values(equations[k].columns, solutions[k].x, found);
  for (std::size_t joint = 0; joint < wanted.size(); ++joint)
    for (std::size_t k = 0; k < wanted[joint].size(); ++k)
      if (is_blank(wanted[joint][k])) {
        job.added[joint][k] = found[joint][k];
        set_free(job.added[joint][k]);
      }
}

}  // namespace cablefit
