// Columns of a variant: torques and levels along the smooth motion, or what a small error of a
// sensor changes in the equations.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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

/// Whether an event does nothing in a stretch: it comes later or is over.
bool is_idle(const Variant& variant, const Stretch& stretch) {
  if (!variant.effect->is_event) return false;
  const bool is_over =
      stretch.log > variant.event_log && (variant.effect->passes() || variant.ends_with_log);
  return stretch.log < variant.event_log || is_over;
}

/// Those in which an effect may do something: of an event none before it.
SampleRange active_samples(const Variant& variant, const Stretch& stretch, double step,
                           Eigen::Index n) {
  const Effect& row = *variant.effect;
  if (!row.is_event || stretch.log > variant.event_log) return {0, n};
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

/// Of every so many samples of a stretch.
struct SomeStates {
  const std::vector<JointState>& of;
  Eigen::Index stride;  ///< between these in `of`
  double h;             ///< s, between these
};

/// Begins to load a state: together they are larger than the caches near the core, and a walk has
/// little else to do.
void fetch(const JointState& state) {
  constexpr std::size_t kLine = 64;  // bytes of a cache line
  const char* const bytes = reinterpret_cast<const char*>(&state);
  for (std::size_t k = 0; k < sizeof(JointState); k += kLine) __builtin_prefetch(bytes + k);
}

/// With `margin` of them without torque at either end.
SomeTorques some_torques(const Variant& variant, const Stretch& stretch, const SomeStates& states,
                         Eigen::Index margin) {
  const Effect& row = *variant.effect;
  const auto n = static_cast<Eigen::Index>(row.n_linear());
  const auto samples =
      (static_cast<Eigen::Index>(states.of.size()) + states.stride - 1) / states.stride;
  const double h = states.h;
  const SampleRange active = active_samples(variant, stretch, h, samples);
  const Eigen::Index all = active.last - active.first + 2 * margin;
  SomeTorques out{active.first - margin, Eigen::MatrixXd::Zero(n, all),
                  Eigen::MatrixXd::Zero(n, all)};
  EffectWalk walk(row, variant.shape);
  JointState dated;                    // of an event, whose age is not the state's own
  constexpr Eigen::Index kAhead = 12;  // states in which memory answers
  const auto state_at = [&](Eigen::Index i) -> const JointState& {
    return states.of[static_cast<std::size_t>(i * states.stride)];
  };
  for (Eigen::Index i = active.first; i < active.last; ++i) {
    fetch(state_at(std::min(i + kAhead, active.last - 1)));
    const JointState* state = &state_at(i);
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

/// Samples x[0], x[n], x[2 n], ... weighted and added up in their order, from four places at once:
/// each sum has to wait for itself.
void weigh_four(const Eigen::ArrayXd& weights, const std::array<const double*, 4>& x,
                Eigen::Index n, double* to) {
  double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
  for (Eigen::Index j = 0; j < weights.size(); ++j) {
    const double weight = weights(j);
    s0 += weight * x[0][j * n];
    s1 += weight * x[1][j * n];
    s2 += weight * x[2][j * n];
    s3 += weight * x[3][j * n];
  }
  to[0] = s0;
  to[1] = s1;
  to[2] = s2;
  to[3] = s3;
}

/// The first `n` rows filtered, at those of `at` that the filter can reach. `samples`: from number
/// `from` on, with twice the filter's reach of zeros at either end.
ActiveColumns filtered(const Kernel& filter, const Eigen::MatrixXd& samples, Eigen::Index from,
                       Eigen::Index n, const std::vector<Eigen::Index>& at, Eigen::Index every) {
  const Eigen::Index reach = filter.reach(), n_all = samples.rows();
  const auto begin = std::lower_bound(at.begin(), at.end(), (from + reach) * every);
  const auto end = std::lower_bound(begin, at.end(), (from + samples.cols() - reach) * every);
  ActiveColumns out{begin - at.begin(), Eigen::MatrixXd(end - begin, n)};
  const auto first_sample = [&](Eigen::Index row) {
    return samples.data() + (begin[row] / every - from - reach) * n_all;
  };
  const Eigen::Index n_rows = out.columns.rows();
  for (Eigen::Index row = 0; row < n_rows; row += 4) {
    const Eigen::Index here = std::min<Eigen::Index>(4, n_rows - row);
    std::array<const double*, 4> x{};
    for (Eigen::Index i = 0; i < 4; ++i)
      x[static_cast<std::size_t>(i)] = first_sample(row + std::min(i, here - 1));
    for (Eigen::Index k = 0; k < n; ++k) {
      std::array<double, 4> sums{};
      weigh_four(filter.weights, x, n_all, sums.data());
      std::copy_n(sums.data(), here, &out.columns(row, k));
      for (const double*& next : x) ++next;
    }
  }
  return out;
}

std::vector<ActiveColumns> torque_columns(const Design& design, const Variant& variant,
                                          std::size_t k, Evaluation evaluation) {
  const Eigen::Index n = n_linear(variant);
  const ActiveColumns none{0, Eigen::MatrixXd(0, n)};
  if (is_idle(variant, design.stretches[k])) return {design.rows[k].kinds.size(), none};
  const Smoothing smoothing = design.smoothing_of(k);
  const bool is_coarse = evaluation == Evaluation::coarse;
  const Eigen::Index every = is_coarse ? smoothing.stride : smoothing.every;
  const Kernel filter = gaussian(smoothing.columns, static_cast<double>(every) * smoothing.period);
  const Stretch& stretch = design.stretches[k];
  SomeTorques torques =
      some_torques(variant, stretch,
                   {is_coarse ? design.coarse_states[k] : design.states[k], is_coarse ? 1 : every,
                    static_cast<double>(every) * stretch.recording.period},
                   2 * filter.reach());
  if (design.models.front().rigid && counts_on_rigid(*variant.effect))
    torques.motor += torques.link;
  std::vector<ActiveColumns> columns;
  for (const KindRows& kind : design.rows[k].kinds) {
    const Eigen::MatrixXd& own = kind.kind == RowKind::link ? torques.link : torques.motor;
    const bool is_zero = own.size() == 0 || own.isZero(0);
    columns.push_back(is_zero ? none : filtered(filter, own, torques.from, n, kind.at, every));
  }
  return columns;
}

std::vector<double> parameters_of(const Variant& variant, double linear) {
  std::vector<double> all(variant.effect->n_linear(), linear);
  all.insert(all.end(), variant.shape.begin(), variant.shape.end());
  return all;
}

/// What a small error of a sensor changes in what the equations leave.
std::vector<ActiveColumns> sensor_columns(const Design& design, const Variant& variant,
                                          const Eigen::VectorXd& values, std::size_t k) {
  const Effect& row = *variant.effect;
  const auto corrected =
      corrected_columns(design, k, row, parameters_of(variant, row.step), Evaluation::fine);
  const Eigen::VectorXd own = values.head(design.layout.n());
  std::vector<ActiveColumns> columns;
  for (std::size_t i = 0; i < corrected.size(); ++i) {
    const KindRows& before = design.rows[k].kinds[i];
    const Eigen::MatrixXd& after = corrected[i].columns;
    const Eigen::VectorXd model = before.base.leftCols(own.size()) * own;
    const bool has_own = after.cols() > 1;  // positions changed
    const Eigen::VectorXd changed = has_own ? after.rightCols(own.size()) * own : model;
    columns.push_back({0, ((changed - after.col(0)) - (model - before.response)) / row.step});
  }
  return columns;
}

/// With zeros before and after, `n_rows` in all.
Eigen::MatrixXd all_rows(ActiveColumns some, Eigen::Index n_rows) {
  if (some.columns.rows() == n_rows) return std::move(some.columns);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n_rows, some.columns.cols());
  all.middleRows(some.from, some.columns.rows()) = some.columns;
  return all;
}

}  // namespace

std::vector<std::vector<ActiveColumns>> active_columns(const Design& design, const Variant& variant,
                                                       const Eigen::VectorXd& values,
                                                       Evaluation evaluation) {
  std::vector<std::vector<ActiveColumns>> columns;
  for (std::size_t k = 0; k < design.stretches.size(); ++k)
    columns.push_back(variant.effect->correct != nullptr
                          ? sensor_columns(design, variant, values, k)
                          : torque_columns(design, variant, k, evaluation));
  return columns;
}

VariantColumns variant_columns(const Design& design, const Variant& variant,
                               const Eigen::VectorXd& values, Evaluation evaluation) {
  VariantColumns columns;
  auto active = active_columns(design, variant, values, evaluation);
  for (std::size_t k = 0; k < active.size(); ++k) {
    auto& kinds = columns.emplace_back();
    for (std::size_t i = 0; i < active[k].size(); ++i)
      kinds.push_back(all_rows(std::move(active[k][i]), design.rows[k].kinds[i].response.size()));
  }
  return columns;
}

}  // namespace cablefit
