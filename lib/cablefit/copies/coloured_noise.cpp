#include "cablefit/copies/coloured_noise.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/spread/autoregression.hpp"

namespace cablefit {
namespace {

constexpr int kSettlingTimes = 20;   // of the order, before noise counts as stationary
constexpr int kLeastSettling = 500;  // values

}  // namespace

void Autocovariance::add(std::span<const Eigen::Index> numbers,
                         const Eigen::Ref<const Eigen::VectorXd>& values) {
  const std::size_t n_lags = products_.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Value value{numbers[i], values(static_cast<Eigen::Index>(i))};
    if (recent_.size() < n_lags) {
      recent_.push_back(value);
    } else {
      recent_[next_] = value;
    }
    next_ = (next_ + 1) % n_lags;
    for (const Value& other : recent_) {
      const auto lag = static_cast<std::size_t>(value.number - other.number);
      if (lag >= n_lags) continue;
      products_[lag] += value.value * other.value;
      ++n_pairs_[lag];
    }
  }
}

Eigen::VectorXd Autocovariance::values() const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(products_.size()));
  for (std::size_t k = 0; k < products_.size(); ++k)
    if (n_pairs_[k] > 0)
      all(static_cast<Eigen::Index>(k)) = products_[k] / static_cast<double>(n_pairs_[k]);
  return all;
}

ArModel fit_ar(const Eigen::VectorXd& r, double period, std::size_t n_values) {
  ArModel model;
  model.period = period;
  const Autoregression found = fit_autoregression(r, static_cast<double>(n_values));
  if (!(found.innovation_variance > 0)) return model;
  model.coefficients = found.coefficients;
  model.innovation_sd = std::sqrt(found.innovation_variance);
  model.sd = std::sqrt(r(0));
  return model;
}

Eigen::ArrayXd draw(const ArModel& model, Eigen::Index n_rows, double period, Random& random) {
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(n_rows);
  if (!(model.sd > 0) || n_rows == 0) return out;
  const auto order = static_cast<Eigen::Index>(model.coefficients.size());
  const Eigen::Index settling = std::max<Eigen::Index>(kLeastSettling, kSettlingTimes * order);
  const auto n_values =
      static_cast<Eigen::Index>(static_cast<double>(n_rows) * period / model.period) + 2;
  Eigen::ArrayXd x = Eigen::ArrayXd::Zero(order + settling + n_values);
  for (Eigen::Index i = order; i < x.size(); ++i) {
    x(i) = model.innovation_sd * random.normal();
    for (Eigen::Index k = 0; k < order; ++k)
      x(i) += model.coefficients[static_cast<std::size_t>(k)] * x(i - 1 - k);
  }
  const double* const values = x.data() + order + settling;
  for (Eigen::Index i = 0; i < n_rows; ++i) {
    const double at = static_cast<double>(i) * period / model.period;
    const auto before = static_cast<Eigen::Index>(at);
    const double fraction = at - static_cast<double>(before);
    out(i) = values[before] + fraction * (values[before + 1] - values[before]);
  }
  return out;
}

}  // namespace cablefit
