#include "cablefit/elastic/model_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "cablefit/elastic/held_out.hpp"

namespace cablefit {
namespace {

constexpr double kSignificant = 2;  // paired block test, standard errors
constexpr double kWorthwhile =
    0.01;  // relative gain in mean squared error below which nobody cares

}  // namespace

int choose_order(const ElasticJob& job, const BlockedRows& rows, const Nuisance& nuisance,
                 std::vector<std::string>& words) {
  const HeldOut held_out(*rows.rows);
  std::vector<Eigen::VectorXd> errors;
  for (int order = 1; order <= job.options.max_order; ++order) {
    const Candidate candidate = poly_candidate(job, rows, order, nuisance);
    errors.push_back(held_out.block_errors(held_out.fits(candidate, rows.torque_response())));
  }
  const auto beats = [&](std::size_t high, std::size_t low) {
    const Eigen::ArrayXd gain = (errors[low] - errors[high]).array();
    const double n = static_cast<double>(gain.size());
    const double mean = gain.mean();
    const double spread = std::sqrt((gain - mean).square().sum() / std::max(1.0, n - 1) / n);
    return n >= 4 && mean > kSignificant * spread && mean > kWorthwhile * errors[low].mean();
  };
  for (std::size_t low = 0; low < errors.size(); ++low) {
    bool beaten = false;
    for (std::size_t high = low + 1; high < errors.size(); ++high) beaten |= beats(high, low);
    if (beaten) continue;
    words.push_back(
        fmt::format("order {} is the lowest that no order up to {} beats on held-out blocks (rms "
                    "{:.3g} against {:.3g} N m of order {})",
                    low + 1, job.options.max_order, std::sqrt(errors[low].mean()),
                    std::sqrt(errors.back().mean()), job.options.max_order));
    return static_cast<int>(low) + 1;
  }
  return job.options.max_order;
}

void measure_errors(const BlockedRows& rows, const std::vector<Candidate>& candidates,
                    const std::vector<LinearSolution>& solutions, ElasticPreload& preload) {
  const HeldOut held_out(*rows.rows);
  std::vector<std::vector<Eigen::VectorXd>> folds;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    folds.push_back(held_out.fits(candidates[k], rows.torque_response()));
    preload.fits[k].held_out_rms = std::sqrt(held_out.block_errors(folds[k]).mean());
  }
  struct Extremes {
    double peak = 0;
    std::vector<double> worst, worst_held_out;
  };
  Extremes total;
  total.worst.assign(candidates.size(), 0);
  total.worst_held_out.assign(candidates.size(), 0);
  const double offset = preload.fits.front().offset;
  const auto absolute = [](const Eigen::MatrixXd& r, const Eigen::VectorXd& combination) {
    return (r * combination).cwiseAbs().eval();
  };
  rows.archive->for_each([&](const Eigen::MatrixXd& r, std::span<const Eigen::Index> numbers) {
    total.peak = std::max(total.peak, (r.col(rows.columns.tau).array() - offset).abs().maxCoeff());
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      total.worst[k] =
          std::max(total.worst[k], absolute(r, solutions[k].residual_combination).maxCoeff());
      for (std::size_t fold = 0; fold < folds[k].size(); ++fold) {
        const Eigen::VectorXd errors = absolute(r, folds[k][fold]);
        for (Eigen::Index i = 0; i < errors.size(); ++i)
          if (held_out.fold_of_row(numbers[static_cast<std::size_t>(i)]) ==
              static_cast<Eigen::Index>(fold))
            total.worst_held_out[k] = std::max(total.worst_held_out[k], errors(i));
      }
    }
  });
  preload.deflection_low = rows.deflection_low;
  preload.deflection_high = rows.deflection_high;
  preload.peak_torque = total.peak;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    preload.fits[k].max_abs_error = total.worst[k];
    preload.fits[k].held_out_max = total.worst_held_out[k];
  }
}

}  // namespace cablefit
