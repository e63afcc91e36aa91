#include "cablefit/dynamic/output_error/output_error.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "cablefit/base/parallel.hpp"
#include "cablefit/dynamic/output_error/noise_levels.hpp"
#include "cablefit/estimate/long_run.hpp"
#include "cablefit/estimate/nonlinear_least_squares.hpp"
#include "cablefit/estimate/parameter_estimate.hpp"
#include "cablefit/estimate/row_statistics.hpp"

namespace cablefit {
namespace {

constexpr double kFirstForceNoise = 0.05;  // of the rms torque, where nothing is known
// Looked at for the noise levels, which are then within 3 %.
constexpr std::size_t kNoisePieces = 8, kNoiseRows = 400;
// Of the logarithm of a noise level: how far it may be off at first, and from round to round.
constexpr double kFirstGuess = 0.7, kNextGuess = 0.25;
constexpr double kSettled = 3;  // sd: what a round may still move a parameter
constexpr double kFirstSteps = 0.3, kLastStep = 0.02,
                 kCloseEnough = 0.2;         // sd: at which a round ends
constexpr double kNearer = 0.7;              // of the decrement: what a step at last must leave
constexpr double kInwards = 1e-9;            // from a bound, to be free
constexpr double kLeastInertiaShare = 0.05;  // of where it starts; J > 0

bool is_fitted(const ModelParameter& p, const OutputErrorOptions& options) {
  if (std::find(options.held.begin(), options.held.end(), p.name) != options.held.end())
    return false;
  if (p.kind == ParameterKind::elongation) return options.fit_elongations;
  if (p.kind == ParameterKind::encoder_zero) return options.fit_encoder_zeros;
  return !p.is_shape || options.fit_shapes;
}

std::vector<ModelParameter> fitted_parameters(const Model& model,
                                              const OutputErrorOptions& options) {
  std::vector<ModelParameter> fitted;
  for (const ModelParameter& p : model_parameters(model))
    if (is_fitted(p, options)) fitted.push_back(p);
  return fitted;
}

/// The fit of one log: windows, noise, gains and what is accumulated over them.
class Fit {
 public:
  Fit(const Model& model, const std::vector<MeasuredStretch>& stretches,
      const OutputErrorOptions& options)
      : options_(options),
        model_(model),
        parameters_(fitted_parameters(model, options)),
        windows_(cut_windows(model, stretches, options.window, options.position_sd)),
        statistics_(1, 1, false) {
    assert(!windows_.empty());
    const OutputErrorWindow& last = windows_.back();
    n_numbers_ = static_cast<Eigen::Index>(last.first_number + last.n_rows);
    settings_.compare_every = static_cast<std::size_t>(options.first_compare_every);
    settings_.steps = settings_.smoothing_steps = steps_of(options.first_step);
    every_ = std::max<std::size_t>(
        1, static_cast<std::size_t>(static_cast<double>(n_numbers_) / options.first_rows));
    x_.resize(static_cast<Eigen::Index>(parameters_.size()));
    for (Eigen::Index k = 0; k < x_.size(); ++k)
      x_[k] = parameter_value(model, parameters_[static_cast<std::size_t>(k)]);
    set_first_noise();
  }

  OutputErrorFit run();

 private:
  int steps_of(double longest) const {
    return std::max(1, static_cast<int>(std::ceil(windows_.front().period / longest - 1e-6)));
  }
  void look_closely();
  void set_first_noise();
  void update_noise(double first_step, int max_evaluations);
  bool accumulate(const Eigen::VectorXd& x);
  /// Until a step is shorter than so many sd.
  NonlinearSolution minimise(int max_iterations, double step);
  NonlinearSolution score();
  bool leave_bounds(const NonlinearSolution& solution, const Eigen::VectorXd& gradient);
  Eigen::MatrixXd prior_rows(const Eigen::VectorXd& x) const;
  void set_parameters(const Eigen::VectorXd& x);
  void fill(OutputErrorFit& fit, const NonlinearSolution& solution);
  Eigen::MatrixXd all_rows(const Eigen::VectorXd& x) const;
  void set_on_bound(std::size_t k, const OutputErrorFit& fit, const NonlinearSolution& solution,
                    Estimate& e) const;
  void fill_covariance(OutputErrorFit& fit, const NonlinearSolution& solution);
  Estimate estimate(std::size_t k, const OutputErrorFit& fit,
                    const NonlinearSolution& solution) const;

  const OutputErrorOptions& options_;
  Model model_;
  std::vector<ModelParameter> parameters_;
  std::vector<OutputErrorWindow> windows_;
  NoiseLevels noise_;
  Eigen::Index n_numbers_ = 0;
  std::size_t every_ = 1;  ///< window is looked at
  FilterSettings settings_;
  int n_passes_ = 0;
  bool settled_ = false;
  bool is_valid_ = false;  ///< what was accumulated last: nothing diverged
  Eigen::VectorXd x_;
  RowStatistics statistics_;
  double lag_product_ = 0, lag_square_ = 0;
};

void Fit::set_first_noise() {
  noise_.position = options_.position_sd;
  if (options_.force_sd.size() > 0) {
    noise_.force = options_.force_sd;
    return;
  }
  double squares = 0, n = 0;
  for (const OutputErrorWindow& w : windows_)
    for (std::size_t i = 0; i < w.held.size(); ++i) {
      const double force = w.held[i] + w.sloping[i];
      squares += force * force;
      ++n;
    }
  const auto n_axes = static_cast<Eigen::Index>(windows_.front().n_axes);
  noise_.force =
      Eigen::VectorXd::Constant(n_axes, std::max(1e-9, kFirstForceNoise * std::sqrt(squares / n)));
}

/// With the steps and as often as the result deserves.
void Fit::look_closely() {
  settings_.compare_every = static_cast<std::size_t>(options_.compare_every);
  settings_.steps = steps_of(options_.step);
  settings_.smoothing_steps = steps_of(2 * options_.step);
}

void Fit::set_parameters(const Eigen::VectorXd& x) {
  for (std::size_t k = 0; k < parameters_.size(); ++k)
    set_parameter_value(model_, parameters_[k], x[static_cast<Eigen::Index>(k)]);
}

/// From pieces spread over the logs.
void Fit::update_noise(double first_step, int max_evaluations) {
  if (options_.force_sd.size() > 0) return;
  const std::size_t n_pieces = std::min(kNoisePieces, windows_.size());
  std::vector<OutputErrorWindow> pieces;
  for (std::size_t i = 0; i < n_pieces; ++i) {
    pieces.push_back(windows_[(2 * i + 1) * windows_.size() / (2 * n_pieces)]);
    pieces.back().n_rows = std::min(pieces.back().n_rows, kNoiseRows);
  }
  noise_ = likeliest_noise(model_, pieces, noise_, settings_, first_step, max_evaluations);
}

/// Rows of a window and what they add up to.
struct WindowPart {
  bool valid = false;
  std::optional<RowStatistics> statistics;
  double lag_product = 0, lag_square = 0;
};

/// Product of each whitened residual with the one a row later, and of each with itself.
void add_lags(const Eigen::MatrixXd& rows, Eigen::Index n_axes, WindowPart& part) {
  const auto residual = rows.rightCols<1>();
  const Eigen::Index n = residual.rows() - n_axes;
  part.lag_product = residual.topRows(n).cwiseProduct(residual.bottomRows(n)).sum();
  part.lag_square = residual.topRows(n).squaredNorm();
}

bool Fit::accumulate(const Eigen::VectorXd& x) {
  ++n_passes_;
  const Eigen::Index n_columns = x.size() + 1;
  const RowStatistics empty(n_columns, n_numbers_);
  statistics_ = empty.empty_copy();
  lag_product_ = lag_square_ = 0;
  is_valid_ = true;
  ordered_pipeline<std::size_t>(
      options_.threads,
      [&](auto emit) {
        for (std::size_t k = every_ / 2; k < windows_.size(); k += every_) emit(std::size_t{k});
      },
      [&](std::size_t k) {
        WindowPart part;
        SensitivePlant plant(model_, parameters_, true);
        if (!plant.set_parameters(x.data())) return part;
        const OutputErrorWindow& window = windows_[k];
        SensitivePlant bare(plant.model(), {}, true);
        const SmoothedMotion motion = smooth_motion(bare, window, noise_, settings_);
        if (!motion.valid) return part;
        const Eigen::MatrixXd rows = window_residuals(plant, window, noise_, motion, settings_);
        if (rows.rows() == 0) return part;
        std::vector<Eigen::Index> numbers;
        for (std::size_t row = settings_.compare_every; row < window.n_rows;
             row += settings_.compare_every)
          numbers.insert(numbers.end(), window.n_axes,
                         static_cast<Eigen::Index>(window.first_number + row));
        part.statistics = empty.empty_copy();
        part.statistics->add(rows, numbers);
        add_lags(rows, static_cast<Eigen::Index>(window.n_axes), part);
        part.valid = true;
        return part;
      },
      [&](WindowPart&& part) {
        is_valid_ = is_valid_ && part.valid;
        if (!part.valid) return;
        statistics_.add(*part.statistics);
        lag_product_ += part.lag_product;
        lag_square_ += part.lag_square;
      });
  return is_valid_;
}

/// Whitened rows: their columns are the parameters, then the residual.
Eigen::MatrixXd Fit::prior_rows(const Eigen::VectorXd& x) const {
  const GaussianPrior& prior = options_.prior;
  const auto n = static_cast<Eigen::Index>(prior.names.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n, x.size() + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < x.size(); ++k)
      if (parameters_[static_cast<std::size_t>(k)].name ==
          prior.names[static_cast<std::size_t>(i)]) {
        rows(i, k) = 1;
        rows(i, x.size()) = x[k] - prior.mean[i];
      }
  }
  if (n == 0) return rows;
  return prior.covariance.llt().matrixL().solve(rows);
}

/// Those of the logs and of the prior, compressed.
Eigen::MatrixXd Fit::all_rows(const Eigen::VectorXd& x) const {
  StreamingQr all(x.size() + 1);
  all.add(statistics_.r());
  if (!options_.prior.names.empty()) all.add(prior_rows(x));
  return all.r();
}

NonlinearSolution Fit::minimise(int max_iterations, double step) {
  NonlinearProblem problem;
  const Eigen::Index p = x_.size();
  problem.start = x_;
  problem.lower = Eigen::VectorXd::Constant(p, -kUnbounded);
  problem.upper = Eigen::VectorXd::Constant(p, kUnbounded);
  for (Eigen::Index k = 0; k < p; ++k) {
    const ModelParameter& parameter = parameters_[static_cast<std::size_t>(k)];
    problem.names.push_back(parameter.name);
    problem.lower[k] = parameter.lower;
    problem.upper[k] = parameter.upper;
    if (is_inertia(model_, parameter)) problem.lower[k] = kLeastInertiaShare * std::abs(x_[k]);
    problem.start[k] = std::clamp(x_[k], problem.lower[k], problem.upper[k]);
  }
  problem.n_residuals = p + 1;
  problem.jacobian_is_cheap = true;
  problem.evaluate = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) {
    if (!accumulate(x)) return false;
    const Eigen::MatrixXd rows = all_rows(x);
    r = rows.col(p);
    if (jacobian) *jacobian = rows.leftCols(p);
    return true;
  };
  NonlinearOptions options;
  options.max_iterations = max_iterations;
  options.thorough = false;
  options.decrement_tolerance = step * step * static_cast<double>(p);
  return solve(problem, options);
}

/// Moves parameters a little inwards from bounds at which |r|^2 falls inwards. False: there are
/// none.
bool Fit::leave_bounds(const NonlinearSolution& solution, const Eigen::VectorXd& gradient) {
  bool any = false;
  for (std::size_t k = 0; k < parameters_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (!solution.at_bound[k] || !(gradient[i] < 0) || is_inertia(model_, parameters_[k])) continue;
    x_[i] += kInwards * std::max(1.0, std::abs(x_[i]));
    any = true;
  }
  return any;
}

/// Near the solution: Gauss-Newton steps as they are (Fisher's scoring). Rows that come to rest or
/// leave it make |r|^2 jump by more than the last steps lower it, while J'r = 0 is met all the
/// same.
NonlinearSolution Fit::score() {
  const double enough = kLastStep * kLastStep * static_cast<double>(x_.size());
  const Eigen::VectorXd start = x_;
  NonlinearSolution best = minimise(0, 0);
  for (int i = 0; is_valid_ && i < options_.max_iterations; ++i) {
    const Eigen::MatrixXd rows = all_rows(best.x);
    const Eigen::VectorXd gradient = rows.leftCols(x_.size()).transpose() * rows.col(x_.size());
    x_ = best.x - best.inverse * gradient;
    const bool any = leave_bounds(best, gradient);
    if (!any && !(best.decrement > enough)) break;
    const NonlinearSolution next = minimise(0, 0);
    if (!is_valid_ || (!any && !(next.decrement < kNearer * best.decrement))) {
      accumulate(best.x);
      break;
    }
    best = next;
  }
  x_ = start;
  // Rows that come to rest leave a little even where no step helps any more.
  best.converged =
      is_valid_ && best.decrement < kCloseEnough * kCloseEnough * static_cast<double>(x_.size());
  best.message =
      best.converged ? "converged"
      : is_valid_
          ? fmt::format("no convergence: another step would lower |r|^2 by {:.3g}", best.decrement)
          : "the simulation diverges where the fit starts";
  return best;
}

/// Noise levels and fit in turn: a few windows, simulated coarsely, until the fit has settled; the
/// same windows simulated finely, so that the error of coarse steps does not count as noise; all
/// windows. Far from the solution the noise levels are too high, and all that is wanted is to come
/// nearer.
OutputErrorFit Fit::run() {
  OutputErrorFit fit;
  const auto round = [&](bool is_last) {
    const bool is_first = ++fit.n_rounds == 1;
    update_noise(is_first ? kFirstGuess : kNextGuess, is_first ? 40 : 25);
    const NonlinearSolution solution =
        is_last ? score() : minimise(options_.max_iterations, kFirstSteps);
    const Eigen::VectorXd moved = (solution.x - x_).cwiseAbs();
    x_ = solution.x;
    set_parameters(x_);
    settled_ = (moved.array() <= kSettled * solution.inverse.diagonal().array().sqrt()).all();
    return solution;
  };
  while (!settled_ && fit.n_rounds < options_.max_rounds) round(false);
  look_closely();
  if (every_ > 1) round(false);
  every_ = 1;
  fill(fit, round(true));
  return fit;
}

/// With r whitened, J'J is the information; the honest covariance puts the long-run covariance of
/// the scores, cell by cell, in its middle (see least_squares.hpp).
void Fit::fill_covariance(OutputErrorFit& fit, const NonlinearSolution& solution) {
  const Eigen::Index p = x_.size();
  const double variance = fit.residual_rms * fit.residual_rms;
  const Eigen::MatrixXd prior = prior_rows(x_).leftCols(p);
  const Eigen::MatrixXd& inverse = solution.inverse;
  const Eigen::MatrixXd of_prior = inverse * (prior.transpose() * prior) * inverse;
  fit.covariance_white = variance * (inverse - of_prior) + of_prior;
  fit.covariance = fit.covariance_white;
  fit.degrees_of_freedom = static_cast<double>(statistics_.n_rows() - p);
  fit.effective_rows = static_cast<double>(statistics_.n_rows());
  const auto n_cells = static_cast<Eigen::Index>(statistics_.cells().size());
  if (n_cells < 8) return;
  Eigen::MatrixXd scores(n_cells, p);
  for (Eigen::Index c = 0; c < n_cells; ++c)
    scores.row(c) =
        statistics_.cells()[static_cast<std::size_t>(c)].gram.col(p).head(p).transpose();
  const LongRunCovariance hac = long_run_covariance(scores * inverse);
  fit.covariance = hac.covariance + of_prior;
  fit.degrees_of_freedom = hac.degrees_of_freedom;
  double ratio = 0, n = 0;
  for (Eigen::Index k = 0; k < p; ++k) {  // no credit for anti-correlated residuals
    const double white = fit.covariance_white(k, k), honest = fit.covariance(k, k);
    if (!(white > 0)) continue;
    if (honest < white) {
      fit.covariance.row(k) *= honest > 0 ? std::sqrt(white / honest) : 0;
      fit.covariance.col(k) *= honest > 0 ? std::sqrt(white / honest) : 0;
      fit.covariance(k, k) = white;
    }
    ratio += fit.covariance(k, k) / white;
    ++n;
  }
  if (n > 0) fit.effective_rows *= n / ratio;
}

/// One-sided: where the parameter would go if it were free, as far as the fit is linear there. With
/// its column last among those that are free, the last row of R says that alone.
void Fit::set_on_bound(std::size_t k, const OutputErrorFit& fit, const NonlinearSolution& solution,
                       Estimate& e) const {
  std::vector<Eigen::Index> columns;
  for (std::size_t j = 0; j < parameters_.size(); ++j)
    if (!solution.at_bound[j] && solution.not_identifiable[j].empty())
      columns.push_back(static_cast<Eigen::Index>(j));
  columns.push_back(static_cast<Eigen::Index>(k));
  columns.push_back(x_.size());
  const auto last = static_cast<Eigen::Index>(columns.size()) - 2;
  const Eigen::MatrixXd rows = all_rows(x_)(Eigen::all, columns);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
  const double slope = qr.matrixQR()(last, last);
  Estimate free = e;
  free.sd_white = fit.residual_rms / std::abs(slope);
  free.sd = free.sd_white * std::sqrt(static_cast<double>(fit.n_rows) / fit.effective_rows);
  free.value = e.value + std::max(0.0, -qr.matrixQR()(last, last + 1) / slope);
  set_interval(free, fit.degrees_of_freedom);
  e.sd = free.sd;
  e.sd_white = free.sd_white;
  e.ci_low = e.value;
  e.ci_high = free.ci_high;
}

Estimate Fit::estimate(std::size_t k, const OutputErrorFit& fit,
                       const NonlinearSolution& solution) const {
  const ModelParameter& p = parameters_[k];
  const auto i = static_cast<Eigen::Index>(k);
  Estimate e;
  e.name = p.name;
  e.symbol = p.symbol;
  e.unit = p.unit;
  e.not_identifiable = solution.not_identifiable[k];
  if (!e.not_identifiable.empty()) return e;
  e.value = x_[i];
  if (solution.at_bound[k] && is_inertia(model_, p)) {
    e.not_identifiable = fmt::format("the fit drives it towards 0: it stopped at {:.3g}", e.value);
    e.value = std::numeric_limits<double>::quiet_NaN();
    return e;
  }
  if (solution.at_bound[k]) {
    e.active_bound = fmt::format("{} >= {:g}", p.name, p.lower);
    set_on_bound(k, fit, solution, e);
    return e;
  }
  e.sd_white = std::sqrt(fit.covariance_white(i, i));
  e.sd = std::sqrt(fit.covariance(i, i));
  set_interval(e, fit.degrees_of_freedom, p.lower);
  return e;
}

void Fit::fill(OutputErrorFit& fit, const NonlinearSolution& solution) {
  const Eigen::Index p = x_.size();
  fit.model = model_;
  fit.noise = noise_;
  fit.n_rows = static_cast<std::size_t>(statistics_.n_rows());
  fit.n_passes = n_passes_;
  fit.converged = solution.converged;
  fit.message = solution.message;
  if (!is_valid_ || statistics_.n_columns() != p + 1 || statistics_.n_rows() <= p) return;
  fit.residual_rms =
      statistics_.r().col(p).norm() / std::sqrt(static_cast<double>(statistics_.n_rows() - p));
  fit.correlation = lag_square_ > 0 ? lag_product_ / lag_square_ : 0;
  fill_covariance(fit, solution);
  for (std::size_t k = 0; k < parameters_.size(); ++k)
    fit.parameters.push_back(estimate(k, fit, solution));
  if (!fit.converged) fit.warnings.push_back("output error: " + fit.message);
}

}  // namespace

OutputErrorFit fit_output_error(const Model& model, const std::vector<MeasuredStretch>& stretches,
                                const OutputErrorOptions& options) {
  return Fit(model, stretches, options).run();
}

}  // namespace cablefit
