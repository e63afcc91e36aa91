// Columns of a variant: torques and levels along the smooth motion, or what a small error of a
// sensor changes in the equations.
#include <algorithm>
#include <cmath>

#include "cablefit/model/effects/effect_walk.hpp"
#include "cablefit/refine/rows/design.hpp"

namespace cablefit {
namespace {

/// How long ago a dated effect happened; negative before.
double since_event(const Variant& variant, const Stretch& stretch, double t) {
  if (stretch.log == variant.event_log) return t - variant.event_time;
  return stretch.log > variant.event_log ? 1e9 : -1e9;
}

/// Samples [first, last).
struct SampleRange {
  Eigen::Index first = 0, last = 0;
};

/// Those in which an effect may do something: of an event none before it or when it is over.
SampleRange active_samples(const Variant& variant, const Stretch& stretch, double step,
                           Eigen::Index n) {
  const Effect& row = *variant.effect;
  if (!row.is_event) return {0, n};
  const bool is_over = stretch.log > variant.event_log && (row.passes() || variant.ends_with_log);
  if (stretch.log < variant.event_log || is_over) return {n, n};
  if (stretch.log > variant.event_log) return {0, n};
  const auto sample_at = [&](double time) {
    const double samples = std::floor((time - stretch.t0) / step);
    return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(samples), 0, n);
  };
  const Eigen::Index first = sample_at(variant.event_time);
  if (row.lasts()) return {first, n};
  return {first, std::min(n, sample_at(variant.event_time + variant.shape.front()) + 2)};
}

/// Torque per unit of each linear parameter, on link and motor: column i is that of sample from +
/// i; all others are 0.
struct SomeTorques {
  Eigen::Index from = 0;
  Eigen::MatrixXd link, motor;  ///< n_linear x samples
};

/// At every `every`-th sample, with `margin` of them without torque at either end.
SomeTorques some_torques(const Variant& variant, const Stretch& stretch,
                         const std::vector<JointState>& states, Eigen::Index every,
                         Eigen::Index margin) {
  const Effect& row = *variant.effect;
  const auto n = static_cast<Eigen::Index>(row.n_linear());
  const auto samples = (static_cast<Eigen::Index>(states.size()) + every - 1) / every;
  const double h = static_cast<double>(every) * stretch.recording.period;
  const SampleRange active = active_samples(variant, stretch, h, samples);
  const Eigen::Index all = active.last - active.first + 2 * margin;
  SomeTorques out{active.first - margin, Eigen::MatrixXd::Zero(n, all),
                  Eigen::MatrixXd::Zero(n, all)};
  EffectWalk walk(row, variant.shape);
  JointState dated;  // of an event, whose age is not the state's own
  for (Eigen::Index i = active.first; i < active.last; ++i) {
    const JointState* state = &states[static_cast<std::size_t>(i * every)];
    if (row.is_event) {
      dated = *state;
      dated.since_event = since_event(variant, stretch, dated.t);
      if (dated.since_event < 0) continue;
      state = &dated;
    }
    const double speed = row.site == Site::link ? state->qd : state->thetad;
    const double direction = speed > 0 ? 1.0 : speed < 0 ? -1.0 : 0.0;
    walk.step(*state, direction, h, out.link.col(i - out.from).data(),
              out.motor.col(i - out.from).data());
  }
  return out;
}

/// The first `n` rows filtered, at those of `at` that the filter can reach; 0 elsewhere. `samples`:
/// from number `from` on, with twice the filter's reach of zeros at either end.
Eigen::MatrixXd filtered(const Kernel& filter, const Eigen::MatrixXd& samples, Eigen::Index from,
                         Eigen::Index n, const std::vector<Eigen::Index>& at, Eigen::Index every) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(at.size()), n);
  const Eigen::Index reach = filter.reach(), width = filter.weights.size();
  const auto begin = std::lower_bound(at.begin(), at.end(), (from + reach) * every);
  const auto end = std::lower_bound(begin, at.end(), (from + samples.cols() - reach) * every);
  Eigen::VectorXd sum(samples.rows());
  for (auto i = begin; i != end; ++i) {
    sum.noalias() = samples.middleCols(*i / every - from - reach, width) * filter.weights.matrix();
    out.row(i - at.begin()) = sum.head(n).transpose();
  }
  return out;
}

std::vector<Eigen::MatrixXd> torque_columns(const Design& design, const Variant& variant,
                                            std::size_t k, Evaluation evaluation) {
  const Smoothing smoothing = design.smoothing_of(k);
  const bool is_coarse = evaluation == Evaluation::coarse;
  const Eigen::Index every = is_coarse ? smoothing.stride : smoothing.every;
  const Kernel filter = gaussian(smoothing.columns, static_cast<double>(every) * smoothing.period);
  SomeTorques torques =
      some_torques(variant, design.stretches[k], design.states[k], every, 2 * filter.reach());
  if (design.models.front().rigid && counts_on_rigid(*variant.effect))
    torques.motor += torques.link;
  const Eigen::Index n = n_linear(variant);
  std::vector<Eigen::MatrixXd> columns;
  for (const KindRows& kind : design.rows[k].kinds) {
    const Eigen::MatrixXd& own = kind.kind == RowKind::link ? torques.link : torques.motor;
    const bool is_zero = own.size() == 0 || own.isZero(0);
    columns.push_back(is_zero ? Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(kind.at.size()), n)
                              : filtered(filter, own, torques.from, n, kind.at, every));
  }
  return columns;
}

std::vector<double> parameters_of(const Variant& variant, double linear) {
  std::vector<double> all(variant.effect->n_linear(), linear);
  all.insert(all.end(), variant.shape.begin(), variant.shape.end());
  return all;
}

/// What a small error of a sensor changes in what the equations leave.
std::vector<Eigen::MatrixXd> sensor_columns(const Design& design, const Variant& variant,
                                            const Eigen::VectorXd& values, std::size_t k) {
  const Effect& row = *variant.effect;
  const StretchRows corrected = corrected_rows(design, k, row, parameters_of(variant, row.step));
  const Eigen::VectorXd own = values.head(design.layout.n());
  std::vector<Eigen::MatrixXd> columns;
  for (std::size_t i = 0; i < corrected.kinds.size(); ++i) {
    const KindRows &after = corrected.kinds[i], &before = design.rows[k].kinds[i];
    columns.push_back(((after.base.leftCols(own.size()) * own - after.response) -
                       (before.base.leftCols(own.size()) * own - before.response)) /
                      row.step);
  }
  return columns;
}

}  // namespace

VariantColumns variant_columns(const Design& design, const Variant& variant,
                               const Eigen::VectorXd& values, Evaluation evaluation) {
  VariantColumns columns;
  for (std::size_t k = 0; k < design.stretches.size(); ++k)
    columns.push_back(variant.effect->correct != nullptr
                          ? sensor_columns(design, variant, values, k)
                          : torque_columns(design, variant, k, evaluation));
  return columns;
}

}  // namespace cablefit
