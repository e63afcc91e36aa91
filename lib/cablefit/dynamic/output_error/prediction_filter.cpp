#include "cablefit/dynamic/output_error/prediction_filter.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace cablefit {
namespace {

constexpr double kLargestState = 1e6;

/// Types for N axes; one joint has N = 1 or 2, which the compiler then unrolls. Any number:
/// Dynamic.
template <int N>
struct Of {
  static constexpr int kStates = N == Eigen::Dynamic ? Eigen::Dynamic : 2 * N;
  using PerAxis = Eigen::Matrix<double, N, 1>;
  using PerState = Eigen::Matrix<double, kStates, 1>;
  using Transition = Eigen::Matrix<double, kStates, kStates>;
  using Input = Eigen::Matrix<double, kStates, N>;  ///< of forces; gains are as large
  using Output = Eigen::Matrix<double, N, kStates>;
  using Axes = Eigen::Matrix<double, N, N>;
  using Table = Eigen::Matrix<double, N, Eigen::Dynamic, Eigen::RowMajor>;
  using StateColumns = Eigen::Matrix<double, kStates, Eigen::Dynamic>;
  using AxisColumns = Eigen::Matrix<double, N, Eigen::Dynamic>;
};

/// The initial position is that of the first row, and of its noise; the velocity is all but
/// unknown.
constexpr double kVelocityUncertainty = 4;  // of what a first difference would have
constexpr double kRestSpeeds = 2;           // sd of a speed: what a row's noise does to it

/// Drives the plant from a row to the next, `correction` added to the forces.
class RowStepper {
 public:
  RowStepper(const OutputErrorWindow& window, int steps)
      : window_(window), steps_(steps), h_(window.period / steps), force_(window.n_axes) {}

  /// From `x`, positions and velocities.
  template <typename States>
  void step(const States& x, std::size_t row, const double* correction, SensitivePlant& plant,
            SensitiveState& state) {
    const std::size_t n = window_.n_axes;
    plant.start(x.data(), x.data() + n, window_.t0 + static_cast<double>(row) * window_.period);
    const double* held = window_.held.data() + row * n;
    const double* from = window_.sloping.data() + row * n;
    const double* to = row + 1 < window_.n_rows ? from + n : from;
    for (int s = 0; s < steps_; ++s) {
      const double fraction = (s + 0.5) / steps_;
      for (std::size_t a = 0; a < n; ++a)
        force_[a] =
            held[a] + from[a] + fraction * (to[a] - from[a]) + (correction ? correction[a] : 0.0);
      plant.step(force_.data(), h_);
    }
    plant.read(state);
  }

 private:
  const OutputErrorWindow& window_;
  int steps_;
  double h_;
  std::vector<double> force_;
};

/// What a row does: state by state and by force, read off the plant's inputs.
template <int N>
struct RowModel {
  typename Of<N>::Transition transition;
  typename Of<N>::Input input;
  typename Of<N>::PerAxis force_sd;  ///< N m
};

/// For an axis at rest or at a reversal, dry friction gives only an inequality. The noise of the
/// force violates it in one direction only, so friction there counts as unknown.
template <int N, typename Before>
void loosen_at_rest(const SensitivePlant& plant, const OutputErrorWindow& window,
                    const NoiseLevels& noise, const Before& before, const SensitiveState& state,
                    RowModel<N>& model) {
  const auto n = static_cast<Eigen::Index>(plant.n_axes());
  model.force_sd = noise.force;
  for (Eigen::Index a = 0; a < n; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const double level = plant.rest_level(axis);
    if (level == 0) continue;
    const double speed_sd =
        noise.force[a] * window.period / plant.inertia(axis) + noise.position[a] / window.period;
    const double from = before[n + a], to = state.velocity[axis];
    const bool moves = std::min(std::abs(from), std::abs(to)) > kRestSpeeds * speed_sd;
    if (!moves || from * to < 0) model.force_sd[a] = std::hypot(noise.force[a], level);
  }
}

template <int N>
void read_model(const SensitivePlant& plant, const SensitiveState& state, double period,
                RowModel<N>& model) {
  using Table = typename Of<N>::Table;
  const auto n = static_cast<Eigen::Index>(plant.n_axes());
  const auto columns = static_cast<Eigen::Index>(plant.n_columns());
  const auto first = static_cast<Eigen::Index>(plant.first_input());
  const Eigen::Map<const Table> by_position(state.by_position.data(), n, columns);
  const Eigen::Map<const Table> by_velocity(state.by_velocity.data(), n, columns);
  model.transition.resize(2 * n, 2 * n);
  model.transition.topRows(n) = by_position.middleCols(first, 2 * n);
  model.transition.bottomRows(n) = by_velocity.middleCols(first, 2 * n);
  model.input.resize(2 * n, n);
  model.input.topRows(n) = by_position.rightCols(n);
  model.input.bottomRows(n) = by_velocity.rightCols(n);
  // An axis that is held in the model may be moving in truth: what is known of its velocity must
  // not become exact.
  for (Eigen::Index a = 0; a < n; ++a)
    if (state.velocity[static_cast<std::size_t>(a)] == 0)
      model.input(n + a, a) = period / plant.inertia(static_cast<std::size_t>(a));
}

/// Covariance of a filter, gain and whitener of each row.
template <int N>
class Covariance {
 public:
  Covariance(const OutputErrorWindow& window, const NoiseLevels& noise)
      : n_(static_cast<Eigen::Index>(window.n_axes)), noise_(noise) {
    covariance_ = Of<N>::Transition::Zero(2 * n_, 2 * n_);
    covariance_.diagonal().head(n_) = noise.position.cwiseAbs2();
    covariance_.diagonal().tail(n_) =
        (kVelocityUncertainty / window.period * noise.position).cwiseAbs2();
  }

  /// Over a row.
  void advance(const RowModel<N>& model) {
    const typename Of<N>::Input scaled = model.input * model.force_sd.asDiagonal();
    const typename Of<N>::Transition moved = model.transition * covariance_;
    covariance_.noalias() = moved * model.transition.transpose();
    covariance_.noalias() += scaled * scaled.transpose();
  }

  /// By what was measured at its end.
  void compare() {
    typename Of<N>::Axes innovation = covariance_.topLeftCorner(n_, n_);
    innovation.diagonal() += noise_.position.cwiseAbs2();
    const Eigen::LLT<typename Of<N>::Axes> llt(innovation);
    whitener_ = llt.matrixL().solve(Of<N>::Axes::Identity(n_, n_));
    const typename Of<N>::Output half = whitener_ * covariance_.topRows(n_);
    gain_ = half.transpose() * whitener_;
    // Joseph's form, which rounding does not make indefinite where the plant is unstable (friction
    // that falls with the speed).
    typename Of<N>::Transition rest = Of<N>::Transition::Identity(2 * n_, 2 * n_);
    rest.leftCols(n_) -= gain_;
    const typename Of<N>::Input noisy = gain_ * noise_.position.asDiagonal();
    covariance_ = rest * covariance_ * rest.transpose() + noisy * noisy.transpose();
  }

  const typename Of<N>::Input& gain() const { return gain_; }
  const typename Of<N>::Axes& whitener() const { return whitener_; }
  const typename Of<N>::Transition& covariance() const { return covariance_; }

 private:
  Eigen::Index n_;
  const NoiseLevels& noise_;
  typename Of<N>::Transition covariance_;
  typename Of<N>::Input gain_;
  typename Of<N>::Axes whitener_;
};

template <int N>
typename Of<N>::PerState state_vector(const SensitiveState& state) {
  const auto n = static_cast<Eigen::Index>(state.position.size());
  typename Of<N>::PerState x(2 * n);
  x.head(n) = Eigen::Map<const Eigen::VectorXd>(state.position.data(), n);
  x.tail(n) = Eigen::Map<const Eigen::VectorXd>(state.velocity.data(), n);
  return x;
}

template <int N>
typename Of<N>::PerState start_of(const OutputErrorWindow& window) {
  const auto n = static_cast<Eigen::Index>(window.n_axes);
  typename Of<N>::PerState x(2 * n);
  x.head(n) = Eigen::Map<const Eigen::VectorXd>(window.position.data(), n);
  x.tail(n) = Eigen::Map<const Eigen::VectorXd>(window.start_velocity.data(), n);
  return x;
}

template <int N>
Eigen::Map<const typename Of<N>::PerAxis> measured(const OutputErrorWindow& window,
                                                   std::size_t row) {
  return Eigen::Map<const typename Of<N>::PerAxis>(window.position.data() + row * window.n_axes,
                                                   static_cast<Eigen::Index>(window.n_axes));
}

/// What the smoother needs of a row on its way back.
template <int N>
struct RowMemory {
  typename Of<N>::Transition transition;
  typename Of<N>::Input input, gain;
  typename Of<N>::Transition covariance;
  typename Of<N>::PerAxis weighted_innovation;  ///< S^-1 times it
  typename Of<N>::PerAxis force_sd;             ///< N m
  bool compared = false;
};

/// Bryson & Frazier 1963: the adjoint of the filter; needs no inverse but that of the innovation.
template <int N>
void smooth_back(const std::vector<RowMemory<N>>& rows,
                 const typename Of<N>::Transition& start_covariance, SmoothedMotion& motion) {
  const Eigen::Index n = start_covariance.rows() / 2;
  motion.correction.resize(n, static_cast<Eigen::Index>(rows.size()));
  typename Of<N>::PerState after = Of<N>::PerState::Zero(2 * n);
  for (std::size_t i = rows.size(); i-- > 0;) {
    const RowMemory<N>& row = rows[i];
    const auto at = static_cast<Eigen::Index>(i);
    motion.state.col(at + 1) -= row.covariance * after;
    typename Of<N>::PerState before = after;
    if (row.compared) before.head(n) -= row.gain.transpose() * after + row.weighted_innovation;
    motion.correction.col(at) =
        -row.force_sd.cwiseAbs2().cwiseProduct(row.input.transpose() * before);
    after = row.transition.transpose() * before;
  }
  motion.state.col(0) -= start_covariance * after;
}

template <int N>
SmoothedMotion smoothed(SensitivePlant& plant, const OutputErrorWindow& window,
                        const NoiseLevels& noise, const FilterSettings& settings, bool smooth) {
  using PerAxis = typename Of<N>::PerAxis;
  using PerState = typename Of<N>::PerState;
  const auto n = static_cast<Eigen::Index>(window.n_axes);
  SmoothedMotion motion;
  motion.minus_log_likelihood = std::numeric_limits<double>::infinity();
  if (smooth) motion.state.resize(2 * n, static_cast<Eigen::Index>(window.n_rows));
  SensitiveState state;
  plant.restart();
  RowStepper stepper(window, settings.smoothing_steps);
  Covariance<N> covariance(window, noise);
  const typename Of<N>::Transition start_covariance = covariance.covariance();
  RowModel<N> model;
  std::vector<RowMemory<N>> rows(smooth ? window.n_rows - 1 : 0);
  PerState x = start_of<N>(window);
  if (smooth) motion.state.col(0) = x;
  double sum = 0;
  for (std::size_t row = 0; row + 1 < window.n_rows; ++row) {
    stepper.step(x, row, nullptr, plant, state);
    const PerState before = x;
    x = state_vector<N>(state);
    if (!(x.cwiseAbs().maxCoeff() < kLargestState)) return motion;
    read_model(plant, state, window.period, model);
    loosen_at_rest(plant, window, noise, before, state, model);
    covariance.advance(model);
    PerAxis weighted_innovation = PerAxis::Zero(n);
    if (settings.compares(row + 1)) {
      covariance.compare();
      const PerAxis innovation = measured<N>(window, row + 1) - x.head(n);
      const PerAxis white = covariance.whitener() * innovation;
      weighted_innovation = covariance.whitener().transpose() * white;
      sum += white.squaredNorm() - 2 * covariance.whitener().diagonal().array().log().sum();
      x += covariance.gain() * innovation;
    }
    if (!smooth) continue;
    motion.state.col(static_cast<Eigen::Index>(row + 1)) = x;
    rows[row] = {model.transition,          model.input,         covariance.gain(),
                 covariance.covariance(),   weighted_innovation, model.force_sd,
                 settings.compares(row + 1)};
  }
  motion.minus_log_likelihood = sum;
  motion.valid = true;
  if (smooth) smooth_back(rows, start_covariance, motion);
  return motion;
}

template <int N>
Eigen::MatrixXd residuals(SensitivePlant& plant, const OutputErrorWindow& window,
                          const NoiseLevels& noise, const SmoothedMotion& motion,
                          const FilterSettings& settings) {
  using Table = typename Of<N>::Table;
  using PerState = typename Of<N>::PerState;
  const auto n = static_cast<Eigen::Index>(window.n_axes);
  const auto p = static_cast<Eigen::Index>(plant.first_input());
  const auto n_columns = static_cast<Eigen::Index>(plant.n_columns());
  const auto n_compared = static_cast<Eigen::Index>((window.n_rows - 1) / settings.compare_every);
  Eigen::MatrixXd rows(n_compared * n, p + 1);
  Eigen::Index next = 0;
  SensitiveState state, exact;
  plant.restart();
  SensitivePlant fine(plant.model(), {}, false);
  RowStepper stepper(window, settings.smoothing_steps), fine_stepper(window, settings.steps);
  Covariance<N> covariance(window, noise);
  RowModel<N> model;
  // Deviation from the smoothed motion, by each parameter and (last) as it is.
  typename Of<N>::StateColumns deviation = Of<N>::StateColumns::Zero(2 * n, p + 1),
                               moved = deviation;
  deviation.col(p) = start_of<N>(window) - motion.state.col(0);
  typename Of<N>::AxisColumns error(n, p + 1);
  for (std::size_t row = 0; row + 1 < window.n_rows; ++row) {
    const auto at = static_cast<Eigen::Index>(row);
    const double* correction = motion.correction.col(at).data();
    stepper.step(motion.state.col(at), row, correction, plant, state);
    fine_stepper.step(motion.state.col(at), row, correction, fine, exact);
    const PerState x = state_vector<N>(exact);
    if (!(x.cwiseAbs().maxCoeff() < kLargestState)) return {};
    read_model(plant, state, window.period, model);
    loosen_at_rest(plant, window, noise, motion.state.col(at), state, model);
    covariance.advance(model);
    moved = model.transition.lazyProduct(deviation);
    moved.topLeftCorner(n, p) +=
        Eigen::Map<const Table>(state.by_position.data(), n, n_columns).leftCols(p);
    moved.bottomLeftCorner(n, p) +=
        Eigen::Map<const Table>(state.by_velocity.data(), n, n_columns).leftCols(p);
    moved.col(p) += x - motion.state.col(at + 1) - model.input * motion.correction.col(at);
    deviation = moved;
    if (!settings.compares(row + 1)) continue;
    covariance.compare();
    error = moved.topRows(n);
    error.col(p) -= measured<N>(window, row + 1) - motion.state.col(at + 1).head(n);
    rows.middleRows(next, n) = covariance.whitener().lazyProduct(error);
    next += n;
    deviation -= covariance.gain().lazyProduct(error);
  }
  return rows;
}

}  // namespace

SmoothedMotion smooth_motion(SensitivePlant& plant, const OutputErrorWindow& window,
                             const NoiseLevels& noise, const FilterSettings& settings,
                             bool smooth) {
  if (window.n_axes == 1) return smoothed<1>(plant, window, noise, settings, smooth);
  if (window.n_axes == 2) return smoothed<2>(plant, window, noise, settings, smooth);
  return smoothed<Eigen::Dynamic>(plant, window, noise, settings, smooth);
}

Eigen::MatrixXd window_residuals(SensitivePlant& plant, const OutputErrorWindow& window,
                                 const NoiseLevels& noise, const SmoothedMotion& motion,
                                 const FilterSettings& settings) {
  if (window.n_axes == 1) return residuals<1>(plant, window, noise, motion, settings);
  if (window.n_axes == 2) return residuals<2>(plant, window, noise, motion, settings);
  return residuals<Eigen::Dynamic>(plant, window, noise, motion, settings);
}

}  // namespace cablefit
