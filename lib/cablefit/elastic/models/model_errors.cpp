#include "cablefit/elastic/models/model_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "cablefit/elastic/models/held_out.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {
namespace {

/// What held-out blocks say of cables of some orders.
struct OrderTrials {
  const ElasticJob& job;
  const BlockedRows& rows;
  std::span<const Nuisance> nuisance;
  HeldOut held_out;

  /// Mean squared error of every block.
  Eigen::VectorXd errors(std::span<const int> orders) const {
    const ElasticCandidate candidate = poly_candidate(job, rows, orders, nuisance);
    return held_out.block_errors(held_out.fits(candidate, rows.torque_response()));
  }
};

/// The lowest order of all cables that no higher one beats.
std::vector<int> common_order(const OrderTrials& trials, std::vector<std::string>& words) {
  const std::size_t n_cables = trials.job.basis.cables.size();
  const int most = trials.job.options.max_order;
  std::vector<Eigen::VectorXd> errors;
  for (int order = 1; order <= most; ++order)
    errors.push_back(trials.errors(std::vector<int>(n_cables, order)));
  const auto is_beaten = [&](std::size_t low) {
    return std::any_of(errors.begin() + static_cast<std::ptrdiff_t>(low) + 1, errors.end(),
                       [&](const Eigen::VectorXd& high) { return beats(high, errors[low]); });
  };
  std::size_t low = 0;
  while (low + 1 < errors.size() && is_beaten(low)) ++low;
  words.push_back(fmt::format(
      "order {} is the lowest that no order up to {} beats on held-out blocks (rms "
      "{:.3g} against {:.3g} N m of order {})",
      low + 1, most, std::sqrt(errors[low].mean()), std::sqrt(errors.back().mean()), most));
  return std::vector<int>(n_cables, static_cast<int>(low) + 1);
}

/// Cable after cable, the lowest order that the ones so far do not beat.
std::vector<int> lowered(const OrderTrials& trials, std::vector<int> orders,
                         std::vector<std::string>& words) {
  Eigen::VectorXd errors = trials.errors(orders);
  for (std::size_t c = 0; c < orders.size(); ++c)
    for (int order = 1; order < orders[c]; ++order) {
      std::vector<int> lower = orders;
      lower[c] = order;
      const Eigen::VectorXd own = trials.errors(lower);
      if (beats(errors, own)) continue;
      words.push_back(fmt::format("cable {}: order {} will do, order {} does not beat it",
                                  trials.job.basis.cables[c].name, order, orders[c]));
      orders = std::move(lower);
      errors = own;
      break;
    }
  return orders;
}

}  // namespace

std::vector<int> choose_orders(const ElasticJob& job, const BlockedRows& rows,
                               std::span<const Nuisance> nuisance,
                               std::vector<std::string>& words) {
  const OrderTrials trials{job, rows, nuisance, HeldOut(*rows.rows)};
  const std::vector<int> common = common_order(trials, words);
  return lowered(trials, common, words);
}

void measure_errors(const BlockedRows& rows, const std::vector<ElasticCandidate>& candidates,
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
  // Of the curve: the straight line's is extrapolated to a zero that may lie far outside.
  const double curve = preload.fits.back().offset;
  const double offset = std::isfinite(curve) ? curve : preload.fits.front().offset;
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

namespace {

/// Squares and extremes of one fit's residuals on one joint's rows.
struct ResidualSums {
  double squares = 0, largest = 0, n = 0;
  void add(const Eigen::VectorXd& errors) {
    squares += errors.squaredNorm();
    largest = std::max(largest, errors.size() > 0 ? errors.cwiseAbs().maxCoeff() : 0.0);
    n += static_cast<double>(errors.size());
  }
  double rms() const { return n > 0 ? std::sqrt(squares / n) : 0; }
};

/// Residuals of rows in `fold` by the fit to the other folds; `folds`: one combination per fold.
Eigen::VectorXd held_out_residuals(const Eigen::MatrixXd& rows,
                                   std::span<const Eigen::Index> numbers, const HeldOut& held_out,
                                   const std::vector<Eigen::VectorXd>& folds) {
  Eigen::VectorXd errors(rows.rows());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const auto fold =
        static_cast<std::size_t>(held_out.fold_of_row(numbers[static_cast<std::size_t>(i)]));
    errors(i) = rows.row(i).dot(folds[fold]);
  }
  return errors;
}

}  // namespace

void measure_joint_errors(const std::vector<BlockedRows>& joints, const BlockedRows& all,
                          const std::vector<ElasticCandidate>& candidates,
                          const std::vector<LinearSolution>& solutions, ElasticPreload& preload) {
  const HeldOut held_out(*all.rows);
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const auto folds = held_out.fits(candidates[k], all.torque_response());
    ElasticFit& fit = preload.fits[k];
    ResidualSums all_in, all_out;
    for (const BlockedRows& joint : joints) {
      ResidualSums in, out;
      joint.archive->for_each([&](const Eigen::MatrixXd& r, std::span<const Eigen::Index> numbers) {
        const Eigen::VectorXd errors = r * solutions[k].residual_combination;
        const Eigen::VectorXd unseen = held_out_residuals(r, numbers, held_out, folds);
        for (ResidualSums* sums : {&in, &all_in}) sums->add(errors);
        for (ResidualSums* sums : {&out, &all_out}) sums->add(unseen);
      });
      fit.joints.push_back({in.rms(), in.largest, out.rms(), out.largest});
    }
    fit.rms_error = all_in.rms();
    fit.max_abs_error = all_in.largest;
    fit.held_out_rms = all_out.rms();
    fit.held_out_max = all_out.largest;
  }
  const int n = static_cast<int>(joints.size());
  for (int joint = 0; joint < n; ++joint) {
    const auto k = static_cast<std::size_t>(joint);
    const Estimate* e = find_estimate(preload.fits.front().parameters,
                                      joint_parameter_name("offset", joint + 1, n));
    const double offset = e != nullptr && e->not_identifiable.empty() ? e->value : 0;
    double& peak = preload.joints[k].peak_torque;
    joints[k].archive->for_each([&](const Eigen::MatrixXd& r, std::span<const Eigen::Index>) {
      peak = std::max(peak, (r.col(all.columns.tau).array() - offset).abs().maxCoeff());
    });
    preload.peak_torque = std::max(preload.peak_torque, peak);
  }
}

}  // namespace cablefit
