#include "cablefit/refine/rows/residual_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace cablefit {
namespace {

bool is_same(double period, double other) {
  constexpr double kApart = 0.02;  // clocks are not
  return std::abs(period - other) < kApart * other;
}

/// Of most rows of a kind: lags of logs of another rate are others. 0: there are none.
double usual_row_period(const Design& design, RowKind kind) {
  struct Rate {
    double period = 0;
    std::size_t n = 0;
  };
  std::vector<Rate> rates;
  for (std::size_t s = 0; s < design.rows.size(); ++s) {
    const double period = design.smoothing_of(s).row_period();
    auto rate = std::find_if(rates.begin(), rates.end(),
                             [&](const Rate& one) { return is_same(period, one.period); });
    if (rate == rates.end()) rate = rates.insert(rates.end(), {period, 0});
    for (const KindRows& rows : design.rows[s].kinds)
      if (rows.kind == kind) rate->n += rows.at.size();
  }
  const auto most = std::max_element(rates.begin(), rates.end(),
                                     [](const Rate& a, const Rate& b) { return a.n < b.n; });
  return most != rates.end() && most->n > 0 ? most->period : 0;
}

}  // namespace

ResidualMemory residual_memory(const Design& design, const Eigen::VectorXd& x, RowKind kind,
                               std::size_t n_lags) {
  Autocovariance sums(n_lags);
  ResidualMemory memory;
  memory.period = usual_row_period(design, kind);
  Eigen::Index offset = 0;
  for (std::size_t s = 0; s < design.rows.size(); ++s) {
    const Smoothing smoothing = design.smoothing_of(s);
    if (!is_same(smoothing.row_period(), memory.period)) continue;
    for (const KindRows& rows : design.rows[s].kinds) {
      if (rows.kind != kind) continue;
      std::vector<Eigen::Index> numbers;
      for (const Eigen::Index at : rows.at) numbers.push_back(offset + at / smoothing.stride);
      sums.add(numbers, rows.response - rows.base * x);
    }
    offset += design.stretches[s].recording.theta.size() / smoothing.stride +
              static_cast<Eigen::Index>(n_lags) + 1;
  }
  memory.covariance = sums.values();
  memory.n_values = sums.n_values();
  if (memory.n_values == 0) memory.period = 0;
  return memory;
}

Spectrum spectrum_of(const ResidualMemory& memory, Eigen::Index n_bands) {
  const Eigen::Index n = memory.covariance.size();
  Spectrum spectrum;
  if (!(memory.period > 0) || n == 0) return spectrum;
  spectrum.width = 0.5 / memory.period / static_cast<double>(n_bands);
  spectrum.power.resize(n_bands);
  const double pi = std::numbers::pi, bands = static_cast<double>(n_bands);
  const auto integral = [&](Eigen::Index lag, double band) {  // of cos(2 pi f lag) up to its edge
    const auto l = static_cast<double>(lag);
    return lag == 0 ? band / bands : std::sin(pi * l * band / bands) / (pi * l);
  };
  for (Eigen::Index b = 0; b < n_bands; ++b) {
    double power = 0;
    for (Eigen::Index lag = 0; lag < n; ++lag) {
      const double window =
          0.5 + 0.5 * std::cos(pi * static_cast<double>(lag) / static_cast<double>(n));
      const double twice = lag == 0 ? 1 : 2;
      power += twice * window * memory.covariance(lag) *
               (integral(lag, static_cast<double>(b) + 1) - integral(lag, static_cast<double>(b)));
    }
    spectrum.power(b) = std::max(0.0, power);
  }
  return spectrum;
}

}  // namespace cablefit
