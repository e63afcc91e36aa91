#include "cablefit/dynamic/output_error/window_pass.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "cablefit/base/parallel.hpp"

namespace cablefit {
namespace {

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

/// Places of the compared rows of every axis on the time grid of all windows.
std::vector<Eigen::Index> numbers_of(const OutputErrorWindow& window, std::size_t every) {
  std::vector<Eigen::Index> numbers;
  for (std::size_t row = every; row < window.n_rows; row += every)
    numbers.insert(numbers.end(), window.n_axes,
                   static_cast<Eigen::Index>(window.first_number + row));
  return numbers;
}

// A noise-free motion is followed as it is: the recorded torque, which does not belong to it, gets
// so much more noise than it has.
constexpr double kLooseForce = 100;

/// Parameter columns along noise-free positions.
Eigen::MatrixXd instruments_of(const OutputErrorWindow& noise_free, SensitivePlant& plant,
                               const NoiseLevels& noise, const FilterSettings& settings) {
  SensitivePlant bare(plant.model(), {}, true);
  const NoiseLevels loose{noise.position, kLooseForce * noise.force};
  const SmoothedMotion motion = smooth_motion(bare, noise_free, loose, settings);
  if (!motion.valid) return {};
  Eigen::MatrixXd rows = window_residuals(plant, noise_free, noise, motion, settings);
  return rows.leftCols(std::max<Eigen::Index>(0, rows.cols() - 1)).eval();
}

/// Rows of instrumented_pass() of one window; none where it diverged.
Eigen::MatrixXd instrumented_rows(const OutputErrorWindow& window,
                                  const OutputErrorWindow& noise_free, SensitivePlant& plant,
                                  const NoiseLevels& noise, const FilterSettings& settings) {
  SensitivePlant bare(plant.model(), {}, true);
  const SmoothedMotion motion = smooth_motion(bare, window, noise, settings);
  if (!motion.valid) return {};
  const Eigen::MatrixXd rows = window_residuals(plant, window, noise, motion, settings);
  const Eigen::MatrixXd instruments = instruments_of(noise_free, plant, noise, settings);
  if (rows.rows() == 0 || instruments.rows() != rows.rows()) return {};
  Eigen::MatrixXd all(rows.rows(), rows.cols() + instruments.cols());
  all << rows, instruments;
  return all;
}

WindowPart part_of(const OutputErrorWindow& window, SensitivePlant& plant, const NoiseLevels& noise,
                   const FilterSettings& settings, const RowStatistics& empty) {
  WindowPart part;
  SensitivePlant bare(plant.model(), {}, true);
  const SmoothedMotion motion = smooth_motion(bare, window, noise, settings);
  if (!motion.valid) return part;
  const Eigen::MatrixXd rows = window_residuals(plant, window, noise, motion, settings);
  if (rows.rows() == 0) return part;
  part.statistics = empty.empty_copy();
  part.statistics->add(rows, numbers_of(window, settings.compare_every));
  add_lags(rows, static_cast<Eigen::Index>(window.n_axes), part);
  part.valid = true;
  return part;
}

}  // namespace

WindowPass pass_over(const std::vector<OutputErrorWindow>& windows, const Model& model,
                     const std::vector<ModelParameter>& parameters, const Eigen::VectorXd& values,
                     const NoiseLevels& noise, const PassSettings& settings) {
  const std::size_t n_numbers = windows.back().first_number + windows.back().n_rows;
  const RowStatistics empty(values.size() + 1, static_cast<Eigen::Index>(n_numbers));
  WindowPass pass;
  pass.statistics = empty.empty_copy();
  pass.valid = true;
  ordered_pipeline<std::size_t>(
      settings.threads,
      [&](auto emit) {
        for (std::size_t k = settings.every / 2; k < windows.size(); k += settings.every)
          emit(std::size_t{k});
      },
      [&](std::size_t k) {
        SensitivePlant plant(model, parameters, true);
        if (!plant.set_parameters(values.data())) return WindowPart{};
        return part_of(windows[k], plant, noise, settings.filter, empty);
      },
      [&](WindowPart&& part) {
        pass.valid = pass.valid && part.valid;
        if (!part.valid) return;
        pass.statistics.add(std::move(*part.statistics));
        pass.lag_product += part.lag_product;
        pass.lag_square += part.lag_square;
      });
  return pass;
}

RowStatistics instrumented_pass(const std::vector<OutputErrorWindow>& windows,
                                const std::vector<OutputErrorWindow>& noise_free,
                                const Model& model, const std::vector<ModelParameter>& parameters,
                                const Eigen::VectorXd& values, const NoiseLevels& noise,
                                const PassSettings& settings) {
  const std::size_t n_numbers = windows.back().first_number + windows.back().n_rows;
  const RowStatistics empty(2 * values.size() + 1, static_cast<Eigen::Index>(n_numbers));
  RowStatistics all = empty.empty_copy();
  bool valid = true;
  ordered_pipeline<std::size_t>(
      settings.threads,
      [&](auto emit) {
        for (std::size_t k = 0; k < windows.size(); ++k) emit(std::size_t{k});
      },
      [&](std::size_t k) {
        WindowPart part;
        SensitivePlant plant(model, parameters, true);
        if (!plant.set_parameters(values.data())) return part;
        const Eigen::MatrixXd rows =
            instrumented_rows(windows[k], noise_free[k], plant, noise, settings.filter);
        if (rows.rows() == 0) return part;
        part.statistics = empty.empty_copy();
        part.statistics->add(rows, numbers_of(windows[k], settings.filter.compare_every));
        part.valid = true;
        return part;
      },
      [&](WindowPart&& part) {
        valid = valid && part.valid;
        if (valid) all.add(std::move(*part.statistics));
      });
  return valid ? all : empty;
}

}  // namespace cablefit
