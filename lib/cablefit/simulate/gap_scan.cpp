#include "cablefit/simulate/gap_scan.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {

double GapScan::Sums::rms() const { return n > 0 ? std::sqrt(squares / n) : 0.0; }

void GapScan::close_window(double* worst_rms, double* t_of_worst) const {
  if (window_.rms() <= *worst_rms) return;
  *worst_rms = window_.rms();
  *t_of_worst = t_window_;
}

void GapScan::start_window(double t) {
  close_window(&worst_rms_, &t_of_worst_);
  window_ = {};
  t_window_ = t;
}

void GapScan::add(const Eigen::Ref<const Eigen::ArrayXd>& measured,
                  const Eigen::Ref<const Eigen::ArrayXd>& simulated, double t0, double period) {
  if (measured.size() == 0) return;
  const Eigen::ArrayXd error = (simulated - measured).abs();
  Eigen::Index at = 0;
  const double largest = error.maxCoeff(&at);
  if (all_.n == 0) shift_ = measured(0);
  if (all_.n == 0 || largest > max_abs_) {
    max_abs_ = largest;
    t_of_max_ = t0 + static_cast<double>(at) * period;
  }
  const auto n = static_cast<double>(error.size());
  const double squares = error.square().sum();
  all_ = {all_.n + n, all_.squares + squares};
  window_ = {window_.n + n, window_.squares + squares};
  sum_ += (measured - shift_).sum();
  sum_squares_ += (measured - shift_).square().sum();
}

void GapScan::fill(SignalGap& gap) const {
  const double mean = sum_ / all_.n;
  const double spread = std::sqrt(std::max(0.0, sum_squares_ / all_.n - mean * mean));
  gap.rms = all_.rms();
  gap.max_abs = max_abs_;
  gap.t_of_max = t_of_max_;
  gap.relative = gap.rms / spread;
  gap.worst_window_rms = worst_rms_;
  gap.t_of_worst_window = t_of_worst_;
  close_window(&gap.worst_window_rms, &gap.t_of_worst_window);
}

void BandScan::add(const Eigen::Ref<const Eigen::ArrayXd>& gap,
                   const Eigen::Ref<const Eigen::ArrayXd>& half_width, double noise) {
  const double of_noise = kNormal975 * noise;
  n_rows_ += static_cast<double>(gap.size());
  squares_ += half_width.square().sum();
  const Eigen::ArrayXd allowed = (half_width.square() + of_noise * of_noise).sqrt();
  n_inside_ += static_cast<double>((gap.abs() <= allowed).count());
}

void BandScan::fill(SignalGap& gap) const {
  if (n_rows_ == 0 || !std::isfinite(squares_)) return;
  gap.band = SignalBand{std::sqrt(squares_ / n_rows_), n_inside_ / n_rows_};
}

void TensionScan::add(const Eigen::ArrayXXd& tension) {
  if (tension.size() == 0) return;
  if (n_rows_ == 0) {
    min_ = max_ = tension.row(0).transpose();
    n_slack_ = Eigen::ArrayXd::Zero(tension.cols());
  }
  n_rows_ += static_cast<double>(tension.rows());
  min_ = min_.min(tension.colwise().minCoeff().transpose());
  max_ = max_.max(tension.colwise().maxCoeff().transpose());
  n_slack_ += (tension <= 0).cast<double>().colwise().sum().transpose();
  n_closed_ += static_cast<double>((tension > 0).rowwise().all().count());
}

std::vector<CableTension> TensionScan::cables(const Transmission& transmission,
                                              const std::string& unit) const {
  std::vector<CableTension> list;
  for (Eigen::Index k = 0; k < min_.size(); ++k) {
    const Cable& cable = transmission.cables[static_cast<std::size_t>(k)];
    list.push_back({cable.name, unit, min_(k), max_(k), n_slack_(k) / n_rows_});
  }
  return list;
}

double TensionScan::closure_share() const { return n_closed_ / n_rows_; }

}  // namespace cablefit
