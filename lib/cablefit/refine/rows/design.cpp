#include "cablefit/refine/rows/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "cablefit/model/effects/effect_walk.hpp"

namespace cablefit {
namespace {

constexpr double kQuietSpeeds = 6;      // sd of a standing axis' speed
constexpr double kShareOfSpeed = 0.02;  // of the rms speed

/// sd of the white noise on an encoder: what third differences show, at least what rounding to the
/// finest step that occurs makes.
double encoder_noise(const Eigen::ArrayXd& x) {
  if (x.size() < 4) return 0;
  double quantum = std::numeric_limits<double>::infinity(), sum = 0;
  for (Eigen::Index i = 3; i < x.size(); ++i) {
    const double step = std::abs(x(i) - x(i - 1));
    if (step > 1e-12) quantum = std::min(quantum, step);
    const double third = x(i) - 3 * x(i - 1) + 3 * x(i - 2) - x(i - 3);
    sum += third * third / 20;
  }
  const double rounding = std::isfinite(quantum) ? quantum / std::sqrt(12.0) : 0;
  return std::max(rounding, std::sqrt(sum / static_cast<double>(x.size())));
}

/// Below it a position counts as standing still.
struct LeastSpeed {
  double by_noise = 0, rms = 0;  ///< rad/s
  double value() const { return std::max(by_noise, kShareOfSpeed * rms); }
};

template <typename Wanted>
LeastSpeed least_speed(const std::vector<Stretch>& stretches, Eigen::ArrayXd Recording::*signal,
                       const Smoothing& smoothing, Wanted wanted) {
  double noise = kUnbounded, squares = 0, n = 0, per_noise = 0;
  for (const Stretch& stretch : stretches) {
    if (!wanted(stretch)) continue;
    const double period = stretch.recording.period;
    const Kernel slope = gaussian_slope(suited(smoothing, period).signals, period);
    const Eigen::ArrayXd& x = stretch.recording.*signal;
    if (const double own = encoder_noise(x); own > 0) noise = std::min(noise, own);  // 0: stood
    per_noise = std::max(per_noise, slope.weights.matrix().norm());
    squares += apply(slope, x).square().sum();
    n += static_cast<double>(x.size());
  }
  if (n == 0) return {};
  if (!std::isfinite(noise)) noise = 0;
  return {kQuietSpeeds * per_noise * noise, std::sqrt(squares / n)};
}

/// Of all logs together, but a sweep of a blocked link may be slower than that altogether.
void set_least_speeds(const std::vector<Stretch>& stretches, Smoothing& smoothing) {
  constexpr double kShareOfSweep = 0.7;
  const auto is_blocked = [](const Stretch& stretch) { return stretch.blocked; };
  smoothing.least_speed_theta =
      least_speed(stretches, &Recording::theta, smoothing, [](const Stretch& /*any*/) {
        return true;
      }).value();
  smoothing.least_speed_q =
      least_speed(stretches, &Recording::q, smoothing, std::not_fn(is_blocked)).value();
  const LeastSpeed sweep = least_speed(stretches, &Recording::theta, smoothing, is_blocked);
  smoothing.least_speed_blocked =
      std::max(sweep.by_noise, std::min(smoothing.least_speed_theta, kShareOfSweep * sweep.rms));
}

LogScale scale_of(const Design& design) {
  constexpr double kLeast = 1e-9;
  LogScale scale;
  double low = kUnbounded, high = -kUnbounded;
  std::vector<double> speeds, deflections, torques;
  for (std::size_t k = 0; k < design.stretches.size(); ++k) {
    const Stretch& stretch = design.stretches[k];
    for (const double tau : stretch.recording.tau) torques.push_back(std::abs(tau));
    low = std::min(low, stretch.recording.theta.minCoeff());
    high = std::max(high, stretch.recording.theta.maxCoeff());
    for (const JointState& state : design.states[k]) {
      speeds.push_back(std::abs(state.thetad));
      deflections.push_back(std::abs(state.deflection));
    }
  }
  scale.peak = *std::max_element(torques.begin(), torques.end());
  const auto at = torques.begin() + static_cast<std::ptrdiff_t>(3 * torques.size() / 4);
  std::nth_element(torques.begin(), at, torques.end());
  scale.usual = *at;
  scale.speed = std::max(kLeast, most_of(std::move(speeds)));
  scale.deflection = std::max(kLeast, most_of(std::move(deflections)));
  scale.travel = std::max(1e-9, (high - low) / 2);
  return scale;
}

/// Of the rows that there are and the models.
void fill_states(Design& design) {
  design.states.clear();
  design.coarse_states.clear();
  for (std::size_t k = 0; k < design.stretches.size(); ++k) {
    const auto& states = design.states.emplace_back(joint_states(
        *design.rows[k].motion, design.models[design.stretches[k].model], design.smoothing));
    const auto stride = static_cast<std::size_t>(design.smoothing_of(k).stride);
    auto& coarse = design.coarse_states.emplace_back();
    for (std::size_t i = 0; i < states.size(); i += stride) coarse.push_back(states[i]);
  }
}

void fill_rows(Design& design, const std::vector<StretchRows>* kept) {
  design.rows.clear();
  for (std::size_t k = 0; k < design.stretches.size(); ++k) {
    const Stretch& stretch = design.stretches[k];
    design.rows.push_back(base_rows(stretch, design.models[stretch.model], design.layout,
                                    design.smoothing, kept != nullptr ? &(*kept)[k] : nullptr));
  }
  fill_states(design);
}

/// Whether the rows depend on the coefficients: on those of cables by an effect that was added, and
/// of an arm by what its links do to each other.
bool rows_follow_values(const Design& design) {
  return !design.added.empty() ||
         std::any_of(design.models.begin(), design.models.end(),
                     [](const Model& model) { return model.is_coupled(); });
}

bool same_positions(const Recording& a, const Recording& b) {
  return (a.q == b.q).all() && (a.theta == b.theta).all() && (a.tau_load == b.tau_load).all();
}

/// The column of dry friction with what the row does to all of it.
std::vector<std::vector<ReplacedColumns>> columns_of_dry_friction(const Design& design,
                                                                  Variant variant,
                                                                  Evaluation evaluation) {
  const Eigen::Index dry = dry_column(design, *variant.effect);
  if (dry < 0) return {};
  variant.is_plain = false;
  const auto active = active_columns(design, variant, {}, evaluation);
  std::vector<std::vector<ReplacedColumns>> replaced;
  for (std::size_t k = 0; k < active.size(); ++k) {
    auto& kinds = replaced.emplace_back();
    for (std::size_t i = 0; i < active[k].size(); ++i) {
      const Eigen::MatrixXd& added = active[k][i].columns;
      ReplacedColumns& kind =
          kinds.emplace_back(ReplacedColumns{1 + dry, 1, design.rows[k].kinds[i].base.col(dry)});
      kind.columns.middleRows(active[k][i].from, added.rows()) += added.leftCols(1);
    }
  }
  return replaced;
}

/// With the effect's cables; nothing where it makes no sense for them.
std::optional<std::vector<Model>> with_other_cables(const Design& design, const Variant& variant) {
  std::vector<Model> models = design.models;
  if (models.front().rigid) return {};
  for (Model& model : models) {
    auto changed = variant.effect->change(model.transmission, variant.shape.data());
    if (!changed) return {};
    model.transmission = std::move(*changed);
  }
  return models;
}

std::vector<std::vector<ReplacedColumns>> columns_of_other_cables(const Design& design,
                                                                  const Variant& variant,
                                                                  Evaluation evaluation) {
  const auto models = with_other_cables(design, variant);
  if (!models) return {};
  const BaseLayout layout = base_layout(models->front());
  std::vector<std::vector<ReplacedColumns>> replaced;
  for (std::size_t k = 0; k < design.stretches.size(); ++k)
    replaced.push_back(columns_of_cables(*design.rows[k].motion, design.rows[k].kinds,
                                         design.layout, (*models)[design.stretches[k].model],
                                         layout, design.smoothing, evaluation));
  return replaced;
}

/// Of the model, with the response.
std::vector<ReplacedColumns> all_columns(const StretchRows& rows) {
  std::vector<ReplacedColumns> all;
  for (const KindRows& kind : rows.kinds) {
    const Eigen::Index n = 1 + kind.base.cols();
    ReplacedColumns& own = all.emplace_back(ReplacedColumns{0, n, {}});
    own.columns.resize(kind.base.rows(), n);
    own.columns << kind.response, kind.base;
  }
  return all;
}

}  // namespace

bool has_plain_form(const Effect& row) {
  return row.n_harmonics > 1 || row.takes_dry_friction ||
         std::any_of(row.shape.begin(), row.shape.end(),
                     [](const ShapeGrid& g) { return g.canonical > 0; });
}

Eigen::Index n_linear(const Variant& variant) {
  const Effect& row = *variant.effect;
  if (variant.is_plain && row.takes_dry_friction) return 0;
  if (variant.is_plain && row.n_harmonics > 1) return 2;
  return static_cast<Eigen::Index>(row.n_linear());
}

bool is_free(const Variant& variant, std::size_t shape) {
  const Effect& row = *variant.effect;
  return is_continuous(row, shape) && !(variant.is_plain && row.shape[shape].canonical > 0);
}

Smoothing Design::smoothing_of(std::size_t stretch) const {
  return suited(smoothing, stretches[stretch].recording.period);
}

Eigen::Index Design::n_columns() const {
  Eigen::Index n = layout.n();
  for (const Variant& variant : added) n += n_linear(variant);
  return n;
}

Design make_design(std::span<const Model> models, std::vector<Stretch> stretches,
                   Smoothing smoothing) {
  Design design;
  design.models.assign(models.begin(), models.end());
  design.layout = base_layout(models.front());
  design.recorded = std::make_shared<const std::vector<Stretch>>(stretches);
  design.stretches = std::move(stretches);
  if (!(smoothing.least_speed_theta > 0)) set_least_speeds(design.stretches, smoothing);
  design.smoothing = smoothing;
  fill_rows(design, nullptr);
  design.scale = scale_of(design);
  return design;
}

bool replaces_rows(const Variant& variant) { return n_linear(variant) == 0; }

Eigen::Index dry_column(const Design& design, const Effect& row) {
  return row.site == Site::link ? design.layout.dry_link : design.layout.dry_motor;
}

std::vector<ReplacedColumns> corrected_columns(const Design& design, std::size_t stretch,
                                               const Effect& row,
                                               const std::vector<double>& parameters,
                                               Evaluation evaluation) {
  const StretchRows& rows = design.rows[stretch];
  const Stretch& recorded = design.stretches[stretch];
  Stretch changed = recorded;
  const Model& model = design.models[changed.model];
  if (row.correct != nullptr) row.correct(parameters.data(), changed.recording);
  if (!same_positions(changed.recording, recorded.recording)) {
    StretchRows own = base_rows(changed, model, design.layout, design.smoothing, &rows);
    for (std::size_t i = 0; i < own.kinds.size(); ++i)
      if (rows.kinds[i].linearised.size() > 0) own.kinds[i].response += rows.kinds[i].linearised;
    return all_columns(own);
  }
  return columns_of_torque(rows, changed.recording, model, design.smoothing, evaluation);
}

std::vector<std::vector<ReplacedColumns>> replaced_columns(const Design& design,
                                                           const Variant& variant,
                                                           Evaluation evaluation) {
  const Effect& row = *variant.effect;
  if (row.takes_dry_friction) return columns_of_dry_friction(design, variant, evaluation);
  if (row.change != nullptr) return columns_of_other_cables(design, variant, evaluation);
  std::vector<std::vector<ReplacedColumns>> replaced;
  for (std::size_t k = 0; k < design.stretches.size(); ++k)
    replaced.push_back(corrected_columns(design, k, row, variant.shape, evaluation));
  return replaced;
}

std::vector<StretchRows> replaced_rows(const Design& design, const Variant& variant) {
  const auto replaced = replaced_columns(design, variant, Evaluation::fine);
  if (replaced.empty()) return {};
  std::vector<StretchRows> rows = design.rows;
  for (std::size_t k = 0; k < rows.size(); ++k) put_in(rows[k], replaced[k]);
  return rows;
}

void change_again(const Variant& variant, Transmission& transmission) {
  const auto again = variant.effect->change_again;
  if (again == nullptr) return;
  if (auto changed = again(transmission, variant.shape.data())) transmission = std::move(*changed);
}

bool applies(const Design& design, const Variant& variant) {
  const auto change = variant.effect->change;
  if (change == nullptr) return true;
  return std::all_of(design.models.begin(), design.models.end(), [&](const Model& model) {
    return !model.rigid && change(model.transmission, variant.shape.data());
  });
}

void append(std::vector<StretchRows>& rows, const VariantColumns& columns) {
  for (std::size_t s = 0; s < rows.size(); ++s)
    for (std::size_t k = 0; k < rows[s].kinds.size(); ++k) {
      Eigen::MatrixXd& base = rows[s].kinds[k].base;
      const Eigen::Index before = base.cols();
      base.conservativeResize(Eigen::NoChange, before + columns[s][k].cols());
      base.rightCols(columns[s][k].cols()) = columns[s][k];
    }
}

VariantColumns residuals(const std::vector<StretchRows>& rows, const Eigen::VectorXd& x) {
  VariantColumns all;
  for (const StretchRows& stretch : rows) {
    auto& kinds = all.emplace_back();
    for (const KindRows& kind : stretch.kinds) kinds.emplace_back(kind.base * x - kind.response);
  }
  return all;
}

Design with_variant(const Design& design, const Variant& variant, const Eigen::VectorXd& values) {
  Design out = design;
  const Effect& row = *variant.effect;
  if (replaces_rows(variant)) {
    out.rows = replaced_rows(design, variant);
    if (out.rows.empty())
      throw Error(ErrorKind::not_identifiable,
                  fmt::format("no cable has {} in addition to the model", row.name));
    if (row.change != nullptr)
      for (Model& model : out.models)
        model.transmission = *row.change(model.transmission, variant.shape.data());
    for (std::size_t k = 0; k < out.rows.size() && row.correct != nullptr; ++k) {
      Stretch& stretch = out.stretches[k];
      row.correct(variant.shape.data(), stretch.recording);
      out.rows[k].motion = motion_of(stretch, out.models[stretch.model], out.smoothing);
    }
    out.layout = base_layout(out.models.front());
    fill_states(out);
  } else {
    append(out.rows, variant_columns(design, variant, values));
  }
  out.added.push_back(variant);
  return out;
}

namespace {

/// Its linear parameters, 0 where `values` has none, and its shape.
std::vector<double> parameters_at(const Variant& variant, const Eigen::VectorXd& values,
                                  Eigen::Index first) {
  std::vector<double> all;
  for (Eigen::Index k = first; k < first + n_linear(variant); ++k)
    all.push_back(k < values.size() ? values(k) : 0);
  all.insert(all.end(), variant.shape.begin(), variant.shape.end());
  return all;
}

/// The recordings as logged, with all corrections.
void correct_recordings(const Eigen::VectorXd& values, Design& design) {
  design.stretches = *design.recorded;
  Eigen::Index first = design.layout.n();
  for (const Variant& variant : design.added) {
    if (variant.effect->correct != nullptr)
      for (Stretch& stretch : design.stretches)
        variant.effect->correct(parameters_at(variant, values, first).data(), stretch.recording);
    first += n_linear(variant);
  }
}

/// Its column, where the recordings are corrected with its value.
void append_linearised(const Variant& variant, const Eigen::VectorXd& values, Design& design) {
  const double value = parameters_at(variant, values, design.n_columns()).front();
  const VariantColumns columns = variant_columns(design, variant, values);
  for (std::size_t s = 0; s < design.rows.size(); ++s)
    for (std::size_t k = 0; k < design.rows[s].kinds.size(); ++k) {
      KindRows& kind = design.rows[s].kinds[k];
      const Eigen::VectorXd there = value * columns[s][k].col(0);
      kind.response += there;
      if (kind.linearised.size() == 0) kind.linearised.setZero(there.size());
      kind.linearised += there;
    }
  append(design.rows, columns);
  design.added.push_back(variant);
}

}  // namespace

bool is_linearised(const Variant& variant) {
  return variant.effect->correct != nullptr && n_linear(variant) > 0;
}

Design rebuilt(const Design& design, const Eigen::VectorXd& values) {
  Design out = design;
  correct_recordings(values, out);
  fill_rows(out, &design.rows);
  out.added.clear();
  for (const Variant& variant : design.added) {
    // Cables and recordings are those of the effect already.
    const Effect& row = *variant.effect;
    if (is_linearised(variant))
      append_linearised(variant, values, out);
    else if (row.change != nullptr || row.correct != nullptr)
      out.added.push_back(variant);
    else
      out = with_variant(out, variant, values);
  }
  return out;
}

Design relinearised(const Design& design, const Eigen::VectorXd& values) {
  Design out = design;
  for (Model& model : out.models) {
    set_base_values(out.layout, values, model);
    for (const Variant& variant : out.added) change_again(variant, model.transmission);
  }
  if (rows_follow_values(design)) return rebuilt(out, values);
  fill_states(out);
  return out;
}

}  // namespace cablefit
