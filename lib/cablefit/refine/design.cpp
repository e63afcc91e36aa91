#include "cablefit/refine/design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cablefit {
namespace {

constexpr double kQuietSpeeds = 6;      // sd of a standing axis' speed
constexpr double kShareOfSpeed = 0.02;  // of the rms speed

/// sd of the white noise on an encoder: what second differences show, at least what rounding to the
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
    const Kernel slope = gaussian_slope(smoothing.signals, stretch.recording.period);
    const Eigen::ArrayXd& x = stretch.recording.*signal;
    noise = std::min(noise, encoder_noise(x));
    per_noise = std::max(per_noise, slope.weights.matrix().norm());
    squares += apply(slope, x).square().sum();
    n += static_cast<double>(x.size());
  }
  if (n == 0) return 0;
  return std::max(kQuietSpeeds * per_noise * noise, kShareOfSpeed * std::sqrt(squares / n));
}

LogScale scale_of(const std::vector<Stretch>& stretches) {
  LogScale scale;
  double low = kUnbounded, high = -kUnbounded;
  for (const Stretch& stretch : stretches) {
    scale.peak = std::max(scale.peak, stretch.recording.tau.abs().maxCoeff());
    low = std::min(low, stretch.recording.theta.minCoeff());
    high = std::max(high, stretch.recording.theta.maxCoeff());
  }
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
    design.states.push_back(joint_states(design.rows.back().motion, model));
  }
}

/// How long ago a dated effect happened; negative before.
double since_event(const Variant& variant, const Stretch& stretch, double t) {
  if (stretch.log == variant.event_log) return t - variant.event_time;
  return stretch.log > variant.event_log ? 1e9 : -1e9;
}

/// Torque per unit of each linear parameter at every sample, on link and motor.
struct FullTorques {
  Eigen::MatrixXd link, motor;  ///< samples x n_linear
};

/// At every `every`-th sample.
FullTorques full_torques(const Variant& variant, const Stretch& stretch,
                         const std::vector<JointState>& states, Eigen::Index every) {
  const Refinement& row = *variant.refinement;
  const std::size_t n = row.n_linear();
  const auto rows = (static_cast<Eigen::Index>(states.size()) + every - 1) / every;
  FullTorques out{Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(n)),
                  Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(n))};
  if (row.is_event && stretch.log < variant.event_log) return out;
  std::vector<double> z(row.n_states), link(n), motor(n), level(n);
  const bool on_link = row.site == Site::link;
  const double h = static_cast<double>(every) * stretch.recording.period;
  for (Eigen::Index i = 0; i < rows; ++i) {
    JointState state = states[static_cast<std::size_t>(i * every)];
    if (row.is_event) {
      state.since_event = since_event(variant, stretch, state.t);
      if (state.since_event < 0) continue;
    }
    if (row.advance != nullptr) row.advance(state, variant.shape.data(), h, z.data());
    std::fill(link.begin(), link.end(), 0.0);
    std::fill(motor.begin(), motor.end(), 0.0);
    if (row.torque != nullptr)
      row.torque(state, variant.shape.data(), z.data(), link.data(), motor.data());
    if (row.level != nullptr) {
      std::fill(level.begin(), level.end(), 0.0);
      const double speed = on_link ? state.qd : state.thetad;
      const double direction = speed > 0 ? 1.0 : speed < 0 ? -1.0 : 0.0;
      row.level(state, direction, variant.shape.data(), z.data(), level.data());
      std::vector<double>& own = on_link ? link : motor;
      for (std::size_t p = 0; p < n; ++p) own[p] += direction * level[p];
    }
    for (std::size_t p = 0; p < n; ++p) {
      out.link(i, static_cast<Eigen::Index>(p)) = link[p];
      out.motor(i, static_cast<Eigen::Index>(p)) = motor[p];
    }
  }
  return out;
}

std::vector<Eigen::MatrixXd> torque_columns(const Design& design, const Variant& variant,
                                            std::size_t k) {
  const Eigen::Index every = design.smoothing.every;
  const FullTorques full = full_torques(variant, design.stretches[k], design.states[k], every);
  const Kernel filter = gaussian(design.smoothing.columns,
                                 static_cast<double>(every) * design.stretches[k].recording.period);
  std::vector<Eigen::MatrixXd> columns;
  for (const KindRows& kind : design.rows[k].kinds) {
    const Eigen::MatrixXd& own = kind.kind == RowKind::link ? full.link : full.motor;
    const auto n_rows = static_cast<Eigen::Index>(kind.at.size());
    if ((own.array() == 0).all()) {
      columns.emplace_back(Eigen::MatrixXd::Zero(n_rows, own.cols()));
      continue;
    }
    std::vector<Eigen::Index> at = kind.at;
    for (Eigen::Index& i : at) i /= every;
    columns.push_back(apply_at(filter, own, at));
  }
  return columns;
}

std::vector<double> parameters_of(const Variant& variant, double linear) {
  std::vector<double> all(variant.refinement->n_linear(), linear);
  all.insert(all.end(), variant.shape.begin(), variant.shape.end());
  return all;
}

StretchRows corrected_rows(const Design& design, std::size_t k, const Refinement& row,
                           const std::vector<double>& parameters) {
  Stretch stretch = design.stretches[k];
  row.correct(parameters.data(), stretch.recording);
  return base_rows(stretch, design.models[stretch.model], design.layout, design.smoothing,
                   &design.rows[k]);
}

/// What a small error of a sensor changes in what the equations leave.
std::vector<Eigen::MatrixXd> sensor_columns(const Design& design, const Variant& variant,
                                            const Eigen::VectorXd& values, std::size_t k) {
  const Refinement& row = *variant.refinement;
  const StretchRows corrected = corrected_rows(design, k, row, parameters_of(variant, row.step));
  const Eigen::VectorXd own = values.head(design.layout.n());
  std::vector<Eigen::MatrixXd> columns;
  for (std::size_t i = 0; i < corrected.kinds.size(); ++i) {
    const KindRows &after = corrected.kinds[i], &before = design.rows[k].kinds[i];
    columns.push_back(((after.base * own - after.response) -
                       (before.base.leftCols(own.size()) * own - before.response)) /
                      row.step);
  }
  return columns;
}

}  // namespace

Eigen::Index Design::n_columns() const {
  Eigen::Index n = layout.n();
  for (const Variant& variant : added)
    n += static_cast<Eigen::Index>(variant.refinement->n_linear());
  return n;
}

Design make_design(std::span<const Model> models, std::vector<Stretch> stretches,
                   Smoothing smoothing) {
  Design design;
  design.models.assign(models.begin(), models.end());
  design.layout = base_layout(models.front());
  design.stretches = std::move(stretches);
  design.scale = scale_of(design.stretches);
  if (!(smoothing.least_speed_theta > 0)) {
    smoothing.least_speed_theta =
        least_speed(design.stretches, &Recording::theta, false, smoothing);
    smoothing.least_speed_q = least_speed(design.stretches, &Recording::q, true, smoothing);
  }
  design.smoothing = smoothing;
  fill_rows(design, nullptr);
  return design;
}

VariantColumns variant_columns(const Design& design, const Variant& variant,
                               const Eigen::VectorXd& values) {
  VariantColumns columns;
  for (std::size_t k = 0; k < design.stretches.size(); ++k)
    columns.push_back(variant.refinement->correct != nullptr
                          ? sensor_columns(design, variant, values, k)
                          : torque_columns(design, variant, k));
  return columns;
}

bool replaces_rows(const Refinement& refinement) { return refinement.n_linear() == 0; }

std::vector<StretchRows> replaced_rows(const Design& design, const Variant& variant) {
  const Refinement& row = *variant.refinement;
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
    Stretch stretch = design.stretches[k];
    if (row.correct != nullptr) row.correct(variant.shape.data(), stretch.recording);
    rows.push_back(
        base_rows(stretch, models[stretch.model], layout, design.smoothing, &design.rows[k]));
    // What was added before stays as it is.
    for (std::size_t i = 0; i < rows.back().kinds.size(); ++i) {
      Eigen::MatrixXd& base = rows.back().kinds[i].base;
      const Eigen::MatrixXd& old = design.rows[k].kinds[i].base;
      const Eigen::Index own = base.cols(), more = old.cols() - design.layout.n();
      base.conservativeResize(Eigen::NoChange, own + more);
      base.rightCols(more) = old.rightCols(more);
    }
  }
  return rows;
}

Design with_variant(const Design& design, const Variant& variant, const Eigen::VectorXd& values) {
  Design out = design;
  const Refinement& row = *variant.refinement;
  if (replaces_rows(row)) {
    out.rows = replaced_rows(design, variant);
    if (row.change != nullptr)
      for (Model& model : out.models)
        model.transmission = *row.change(model.transmission, variant.shape.data());
    if (row.correct != nullptr)
      for (Stretch& stretch : out.stretches) row.correct(variant.shape.data(), stretch.recording);
    out.layout = base_layout(out.models.front());
    for (std::size_t k = 0; k < out.stretches.size(); ++k)
      out.states[k] = joint_states(out.rows[k].motion, out.models[out.stretches[k].model]);
  } else {
    const VariantColumns columns = variant_columns(design, variant, values);
    for (std::size_t k = 0; k < columns.size(); ++k)
      for (std::size_t i = 0; i < columns[k].size(); ++i) {
        Eigen::MatrixXd& base = out.rows[k].kinds[i].base;
        const Eigen::Index before = base.cols();
        base.conservativeResize(Eigen::NoChange, before + columns[k][i].cols());
        base.rightCols(columns[k][i].cols()) = columns[k][i];
      }
  }
  out.added.push_back(variant);
  return out;
}

Design relinearised(const Design& design, const Eigen::VectorXd& values) {
  Design out = design;
  for (Model& model : out.models) set_base_values(values.head(out.layout.n()), model);
  fill_rows(out, &design.rows);
  out.added.clear();
  for (const Variant& variant : design.added) {
    // Cables and recordings are those of the effect already.
    if (replaces_rows(*variant.refinement))
      out.added.push_back(variant);
    else
      out = with_variant(out, variant, values);
  }
  return out;
}

}  // namespace cablefit
