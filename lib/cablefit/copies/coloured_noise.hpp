// Coloured noise like a residual: the residual's autocovariance, an autoregressive model of it, and
// new noise from that model.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cablefit/base/random.hpp"

namespace cablefit {

/// Autocovariance of a series with holes. Only pairs with both values count.
class Autocovariance {
 public:
  explicit Autocovariance(std::size_t n_lags) : products_(n_lags), n_pairs_(n_lags) {}
  /// Adds the next values with their places on the grid, ascending over all calls.
  void add(std::span<const Eigen::Index> numbers, const Eigen::Ref<const Eigen::VectorXd>& values);

  /// Lag 0, 1, ...; 0 where there was no pair. It is about zero, not about the mean: the mean of a
  /// residual is part of its error.
  Eigen::VectorXd values() const;
  std::size_t n_values() const { return n_pairs_.empty() ? 0 : n_pairs_.front(); }

 private:
  struct Value {
    Eigen::Index number;
    double value;
  };
  std::vector<double> products_;
  std::vector<std::size_t> n_pairs_;
  std::vector<Value> recent_;  // ring with one value per lag
  std::size_t next_ = 0;
};

/// x_i = sum_k coefficients[k] x_(i-1-k) + innovation, `period` s apart.
struct ArModel {
  double period = 0;
  std::vector<double> coefficients;
  double innovation_sd = 0;
  double sd = 0;  ///< of x
};

/// fit_autoregression() of a series with that period. An autocovariance that is not positive at lag
/// 0 gives no noise, sd 0.
ArModel fit_ar(const Eigen::VectorXd& autocovariance, double period, std::size_t n_values);

/// n_rows values `period` s apart, interpolated linearly between the model's own values, from its
/// stationary state.
Eigen::ArrayXd draw(const ArModel& model, Eigen::Index n_rows, double period, Random& random);

}  // namespace cablefit
