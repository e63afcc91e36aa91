#include "cablefit/dynamic/output_error/output_error.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/output_error/fit_estimates.hpp"
#include "cablefit/dynamic/output_error/instrumental_fit.hpp"
#include "cablefit/dynamic/output_error/noise_levels.hpp"
#include "cablefit/dynamic/output_error/window_pass.hpp"
#include "cablefit/estimate/fit/nonlinear_least_squares.hpp"
#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/model/effects/effect_walk.hpp"

namespace cablefit {
namespace {

constexpr double kFirstForceNoise = 0.05;  // of the rms torque, where nothing is known
// Looked at for the noise levels, which are then within 3 %. Shorter pieces would be ruled by what
// is wrong with the velocity they start with.
constexpr std::size_t kNoisePieces = 4, kNoiseRows = 1000;
// Of the logarithm of a noise level: how far it may be off at first, and from round to round.
constexpr double kFirstGuess = 0.7, kNextGuess = 0.25;
constexpr double kSettled = 3;  // sd: what a round may still move a parameter
constexpr double kFirstSteps = 0.3, kLastStep = 0.02,
                 kCloseEnough = 0.2;         // sd: at which a round ends
constexpr double kNearer = 0.7;              // of the decrement: what a step at last must leave
constexpr double kInwards = 1e-9;            // from a bound, to be free
constexpr double kLeastInertiaShare = 0.05;  // of where it starts; J > 0

/// Whole numbers have no slopes.
bool is_whole(const Model& model, const ModelParameter& p) {
  const std::optional<std::size_t> shape = shape_of(model, p);
  if (!shape) return false;
  return !is_continuous(*model.joints[static_cast<std::size_t>(p.joint)].added[p.effect].effect,
                        *shape);
}

/// l_o and theta_0 stay as stage 1 has them.
bool is_fitted(const Model& model, const ModelParameter& p, const OutputErrorOptions& options) {
  if (is_whole(model, p)) return false;
  if (std::find(options.held.begin(), options.held.end(), p.name) != options.held.end())
    return false;
  return p.kind != ParameterKind::elongation && p.kind != ParameterKind::encoder_zero;
}

std::vector<ModelParameter> fitted_parameters(const Model& model,
                                              const OutputErrorOptions& options) {
  std::vector<ModelParameter> fitted;
  for (const ModelParameter& p : model_parameters(model))
    if (is_fitted(model, p, options)) fitted.push_back(p);
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
        windows_(cut_windows(model, stretches, options.window, options.position_sd)) {
    assert(!windows_.empty());
    const OutputErrorWindow& last = windows_.back();
    const auto n_rows = static_cast<double>(last.first_number + last.n_rows);
    settings_.threads = options.threads;
    settings_.filter.compare_every = static_cast<std::size_t>(options.first_compare_every);
    settings_.filter.steps = settings_.filter.smoothing_steps = steps_of(options.first_step);
    settings_.every = std::clamp<std::size_t>(static_cast<std::size_t>(n_rows / options.first_rows),
                                              1, windows_.size());
    x_.resize(static_cast<Eigen::Index>(parameters_.size()));
    for (Eigen::Index k = 0; k < x_.size(); ++k)
      x_[k] = parameter_value(model, parameters_[static_cast<std::size_t>(k)]);
    set_first_noise();
  }

  OutputErrorFit run();

 private:
  /// Per row of the slowest log.
  int steps_of(double longest) const {
    double period = 0;
    for (const OutputErrorWindow& window : windows_) period = std::max(period, window.period);
    return std::max(1, static_cast<int>(std::ceil(period / longest - 1e-6)));
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
  void use_instruments(OutputErrorFit& fit);
  void take(const InstrumentalFit& found, OutputErrorFit& fit);
  Eigen::MatrixXd all_rows(const Eigen::VectorXd& x) const;

  const OutputErrorOptions& options_;
  Model model_;
  std::vector<ModelParameter> parameters_;
  std::vector<OutputErrorWindow> windows_;
  NoiseLevels noise_;
  PassSettings settings_;
  int n_passes_ = 0;
  bool settled_ = false;
  Eigen::VectorXd x_;
  WindowPass pass_;  ///< the last one
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
  settings_.filter.compare_every = static_cast<std::size_t>(options_.compare_every);
  settings_.filter.steps = steps_of(options_.step);
  settings_.filter.smoothing_steps = steps_of(2 * options_.step);
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
  noise_ = likeliest_noise(model_, pieces, noise_, settings_.filter, first_step, max_evaluations);
}

bool Fit::accumulate(const Eigen::VectorXd& x) {
  ++n_passes_;
  pass_ = pass_over(windows_, model_, parameters_, x, noise_, settings_);
  return pass_.valid;
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
  all.add(pass_.statistics.r());
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
  for (int i = 0; pass_.valid && i < options_.max_iterations; ++i) {
    const Eigen::MatrixXd rows = all_rows(best.x);
    const Eigen::VectorXd gradient = rows.leftCols(x_.size()).transpose() * rows.col(x_.size());
    x_ = best.x - best.inverse * gradient;
    const bool any = leave_bounds(best, gradient);
    if (!any && !(best.decrement > enough)) break;
    const NonlinearSolution next = minimise(0, 0);
    if (!pass_.valid || (!any && !(next.decrement < kNearer * best.decrement))) {
      accumulate(best.x);
      break;
    }
    best = next;
  }
  const double close = kCloseEnough * kCloseEnough * static_cast<double>(x_.size());
  best.converged = pass_.valid && best.decrement < close;
  if (pass_.valid && !best.converged) {  // then at least nothing lowers |r|^2
    x_ = best.x;
    best = minimise(options_.max_iterations, kLastStep);
    best.converged = best.converged && pass_.valid;
  }
  x_ = start;
  if (best.converged) best.message = "converged";
  if (!pass_.valid) best.message = "the simulation diverges where the fit starts";
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
  if (settings_.every > 1) round(false);
  settings_.every = 1;
  fill(fit, round(true));
  if (options_.noise_free_loop && fit.converged) use_instruments(fit);
  return fit;
}

/// Once more with the columns of a noise-free loop, from where the fit without ended.
void Fit::use_instruments(OutputErrorFit& fit) {
  const NoiseFreeLogs logs = options_.noise_free_loop(fit.model);
  if (!logs.failure.empty()) {
    fit.instruments = logs.failure;
    return;
  }
  const auto windows = cut_windows(model_, logs.measured, options_.window, options_.position_sd);
  const auto noise_free =
      cut_windows(model_, logs.noise_free, options_.window, options_.position_sd);
  std::vector<bool> moves;
  for (Eigen::Index k = 0; k < x_.size(); ++k) moves.push_back(fit.covariance(k, k) > 0);
  const InstrumentalFit found =
      solve_instrumental(x_, moves, [&](const Eigen::VectorXd& x) -> InstrumentedSums {
        return {instrumented_pass(windows, noise_free, model_, parameters_, x, noise_, settings_),
                prior_rows(x)};
      });
  fit.n_passes += 2 * found.n_passes;
  fit.instruments = found.failure;
  if (!found.failure.empty()) return;
  for (std::size_t k = 0; k < parameters_.size(); ++k)
    if (found.x[static_cast<Eigen::Index>(k)] < parameters_[k].lower) {
      fit.instruments = fmt::format("{} would leave its bound", parameters_[k].name);
      return;
    }
  take(found, fit);
}

void Fit::take(const InstrumentalFit& found, OutputErrorFit& fit) {
  std::string furthest;
  double most = 0;
  for (std::size_t k = 0; k < parameters_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    Estimate& e = fit.parameters[k];
    if (!(found.covariance(i, i) > 0)) continue;
    e.sd = std::sqrt(found.covariance(i, i));
    e.sd_white = std::sqrt(found.covariance_white(i, i));
    const double moved = (found.x[i] - e.value) / e.sd;
    if (std::abs(moved) >= std::abs(most)) {
      most = moved;
      furthest = e.name;
    }
    e.value = found.x[i];
    set_interval(e, found.degrees_of_freedom, parameters_[k].lower);
  }
  fit.covariance = found.covariance;
  fit.covariance_white = found.covariance_white;
  fit.degrees_of_freedom = found.degrees_of_freedom;
  fit.effective_rows = found.effective_rows;
  x_ = found.x;
  set_parameters(x_);
  fit.model = model_;
  fit.instrumented = true;
  fit.instruments = fmt::format("{} changes most, by {:+.2f} sd", furthest, most);
}

void Fit::fill(OutputErrorFit& fit, const NonlinearSolution& solution) {
  fit.model = model_;
  fit.noise = noise_;
  fit.n_rows = static_cast<std::size_t>(pass_.statistics.n_rows());
  fit.n_passes = n_passes_;
  fit.converged = solution.converged;
  fit.message = solution.message;
  if (!pass_.valid || pass_.statistics.n_rows() <= x_.size()) return;
  fill_estimates({parameters_, pass_, prior_rows(x_), solution}, fit);
  if (!fit.converged) fit.warnings.push_back("output error: " + fit.message);
}

void require_torques(const Model& model) {
  for (const JointModel& joint : model.joints)
    for (const EffectInstance& instance : joint.added)
      if (instance.effect->correct != nullptr || instance.effect->is_event)
        throw usage_error(fmt::format("output error cannot fit a model with '{}' ({}) in it",
                                      instance.effect->name, to_string(instance.effect->site)),
                          "use `cablefit refine`, which fits this effect");
}

}  // namespace

OutputErrorFit fit_output_error(const Model& model, const std::vector<MeasuredStretch>& stretches,
                                const OutputErrorOptions& options) {
  require_torques(model);
  return Fit(model, stretches, options).run();
}

}  // namespace cablefit
