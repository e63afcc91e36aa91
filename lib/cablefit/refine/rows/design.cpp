#include "cablefit/refine/rows/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

double least_speed(const std::vector<Stretch>& stretches, Eigen::ArrayXd Recording::*signal,
                   bool of_link, const Smoothing& smoothing) {
  double noise = kUnbounded, squares = 0, n = 0, per_noise = 0;
  for (const Stretch& stretch : stretches) {
    if (of_link && stretch.blocked) continue;
    const double period = stretch.recording.period;
    const Kernel slope = gaussian_slope(suited(smoothing, period).signals, period);
    const Eigen::ArrayXd& x = stretch.recording.*signal;
    if (const double own = encoder_noise(x); own > 0) noise = std::min(noise, own);  // 0: stood
    per_noise = std::max(per_noise, slope.weights.matrix().norm());
    squares += apply(slope, x).square().sum();
    n += static_cast<double>(x.size());
  }
  if (n == 0) return 0;
  if (!std::isfinite(noise)) noise = 0;
  return std::max(kQuietSpeeds * per_noise * noise, kShareOfSpeed * std::sqrt(squares / n));
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

void fill_rows(Design& design, const std::vector<StretchRows>* kept) {
  design.rows.clear();
  design.states.clear();
  for (std::size_t k = 0; k < design.stretches.size(); ++k) {
    const Stretch& stretch = design.stretches[k];
    const Model& model = design.models[stretch.model];
    design.rows.push_back(base_rows(stretch, model, design.layout, design.smoothing,
                                    kept != nullptr ? &(*kept)[k] : nullptr));
    design.states.push_back(joint_states(*design.rows.back().motion, model));
  }
}

bool same_positions(const Recording& a, const Recording& b) {
  return (a.q == b.q).all() && (a.theta == b.theta).all() && (a.tau_load == b.tau_load).all();
}

/// The column of dry friction with what the row does to all of it.
std::vector<StretchRows> rows_of_dry_friction(const Design& design, Variant variant,
                                              Evaluation evaluation) {
  const Eigen::Index dry = dry_column(design, *variant.effect);
  if (dry < 0) return {};
  variant.is_plain = false;
  const VariantColumns columns = variant_columns(design, variant, {}, evaluation);
  std::vector<StretchRows> rows = design.rows;
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (std::size_t i = 0; i < rows[k].kinds.size(); ++i)
      rows[k].kinds[i].base.col(dry) += columns[k][i].col(0);
  return rows;
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
  design.stretches = std::move(stretches);
  if (!(smoothing.least_speed_theta > 0)) {
    smoothing.least_speed_theta =
        least_speed(design.stretches, &Recording::theta, false, smoothing);
    smoothing.least_speed_q = least_speed(design.stretches, &Recording::q, true, smoothing);
  }
  design.smoothing = smoothing;
  fill_rows(design, nullptr);
  design.scale = scale_of(design);
  return design;
}

bool replaces_rows(const Variant& variant) { return n_linear(variant) == 0; }

Eigen::Index dry_column(const Design& design, const Effect& row) {
  return row.site == Site::link ? design.layout.dry_link : design.layout.dry_motor;
}

StretchRows corrected_rows(const Design& design, std::size_t k, const Effect& row,
                           const std::vector<double>& parameters, Evaluation evaluation) {
  Stretch stretch = design.stretches[k];
  if (row.correct != nullptr) row.correct(parameters.data(), stretch.recording);
  const Model& model = design.models[stretch.model];
  if (same_positions(stretch.recording, design.stretches[k].recording))
    return rows_of_torque(design.rows[k], stretch, model, design.smoothing, evaluation);
  StretchRows rows = base_rows(stretch, model, design.layout, design.smoothing, &design.rows[k]);
  for (std::size_t i = 0; i < rows.kinds.size(); ++i) {
    Eigen::MatrixXd& base = rows.kinds[i].base;
    const Eigen::MatrixXd& old = design.rows[k].kinds[i].base;
    const Eigen::Index own = base.cols(), more = old.cols() - design.layout.n();
    base.conservativeResize(Eigen::NoChange, own + more);
    base.rightCols(more) = old.rightCols(more);
  }
  return rows;
}

std::vector<StretchRows> replaced_rows(const Design& design, const Variant& variant,
                                       Evaluation evaluation) {
  const Effect& row = *variant.effect;
  if (row.takes_dry_friction) return rows_of_dry_friction(design, variant, evaluation);
  std::vector<Model> models = design.models;
  BaseLayout layout = design.layout;
  if (row.change != nullptr) {
    if (models.front().rigid) return {};
    for (Model& model : models) {
      auto changed = row.change(model.transmission, variant.shape.data());
      if (!changed) return {};
      model.transmission = std::move(*changed);
    }
    layout = base_layout(models.front());
  }
  std::vector<StretchRows> rows;
  for (std::size_t k = 0; k < design.stretches.size(); ++k) {
    const Model& model = models[design.stretches[k].model];
    rows.push_back(row.change != nullptr
                       ? rows_of_cables(design.rows[k], design.layout, model, layout,
                                        design.smoothing, evaluation)
                       : corrected_rows(design, k, row, variant.shape, evaluation));
  }
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
    if (row.correct != nullptr)
      for (Stretch& stretch : out.stretches) row.correct(variant.shape.data(), stretch.recording);
    out.layout = base_layout(out.models.front());
    for (std::size_t k = 0; k < out.stretches.size(); ++k)
      out.states[k] = joint_states(*out.rows[k].motion, out.models[out.stretches[k].model]);
  } else {
    append(out.rows, variant_columns(design, variant, values));
  }
  out.added.push_back(variant);
  return out;
}

Design relinearised(const Design& design, const Eigen::VectorXd& values) {
  Design out = design;
  for (Model& model : out.models) {
    set_base_values(out.layout, values, model);
    for (const Variant& variant : out.added) change_again(variant, model.transmission);
  }
  fill_rows(out, &design.rows);
  out.added.clear();
  for (const Variant& variant : design.added) {
    // Cables and recordings are those of the effect already.
    const Effect& row = *variant.effect;
    if (row.change != nullptr || (row.correct != nullptr && replaces_rows(variant)))
      out.added.push_back(variant);
    else
      out = with_variant(out, variant, values);
  }
  return out;
}

}  // namespace cablefit
