#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/samples/weigh/channel_pass.hpp"
#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kOddHeight = 5, kWrongHeight = 50;  // times the range of 98 % of the samples
constexpr std::size_t kQuantileSamples = 20000;
constexpr double kLeastScale = 1e-3;  // of the median, for a channel that hardly varies

struct Spike {
  double ratio = 0, value = 0;
  std::size_t row = 0;  // in the log
};

bool is_measured(const Slot& slot) { return !slot.integrated; }

/// The range that 98 % of the samples of one slot lie in, from every n-th of them.
double usual_range(const LogSurvey& log, std::size_t part, Eigen::Index column) {
  const std::size_t stride = log.parts[part].n_rows / kQuantileSamples + 1;
  std::vector<double> values;
  Eigen::MatrixXd rows;
  std::size_t row = 0;
  for (const SamplePiece& piece : log.samples->pieces()) {
    if (piece.part != part) continue;
    log.samples->read(piece, rows);
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      if (row++ % stride == 0) values.push_back(rows(i, column));
  }
  const auto quantile = [&](double share) {
    const auto at = values.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  const double low = quantile(0.01), high = quantile(0.99);
  return std::max(high - low, kLeastScale * std::abs(quantile(0.5)));
}

/// How far a sample lies beyond both of its neighbours, on the same side.
double lone_height(double before, double x, double after) {
  const double a = x - before, b = x - after;
  return a * b > 0 ? std::min(std::abs(a), std::abs(b)) : 0;
}

/// The sample of one channel that lies furthest beyond both of its neighbours.
class LoneSamples {
 public:
  using Values = Eigen::Map<const Eigen::ArrayXd>;

  void begin() { n_ = 0; }
  void add(const Values& /*t*/, const Values& x, std::size_t row) {
    const Eigen::Index n = x.size(), n_edge = std::min<Eigen::Index>(2, n);
    for (Eigen::Index i = 0; i < n_edge; ++i) {
      if (n_ >= 2) look_at(before_, middle_, x(i), row + static_cast<std::size_t>(i) - 1);
      before_ = middle_, middle_ = x(i), n_ = std::min(2, n_ + 1);
    }
    if (n <= n_edge) return;
    // All at once first: hardly any stretch has a sample beyond all that were seen.
    if (highest(x) > height_)
      for (Eigen::Index i = 2; i < n; ++i)
        look_at(x(i - 2), x(i - 1), x(i), row + static_cast<std::size_t>(i) - 1);
    before_ = x(n - 2), middle_ = x(n - 1);
  }
  Spike result(const LogSurvey& log, std::size_t part, std::size_t slot) const {
    // The quantiles cost a sort: only where the range is not the usual one.
    if (!(height_ > 0.5 * log.parts[part].channels[slot].range())) return {};
    const double usual = usual_range(log, part, static_cast<Eigen::Index>(slot) + 1);
    Spike spike = largest_;
    spike.ratio = usual > 0 ? height_ / usual : 0;
    return spike;
  }

 private:
  /// The largest lone_height(), negative for none: of x - before and x - after the smaller one
  /// where both are positive, as below the neighbours.
  static double highest(const Values& x) {
    const Eigen::Index m = x.size() - 2;
    const auto a = x.segment(1, m) - x.head(m), b = x.segment(1, m) - x.tail(m);
    return a.min(b).max(-a.max(b)).maxCoeff();
  }
  void look_at(double before, double x, double after, std::size_t row) {
    const double lone = lone_height(before, x, after);
    if (lone > height_) height_ = lone, largest_ = {0, x, row};
  }

  int n_ = 0;  // values before, as far as that matters: no more than 2
  double before_ = 0, middle_ = 0, height_ = 0;
  Spike largest_;
};

}  // namespace

Findings spikes(const Logs& logs) {
  Findings findings;
  for (std::size_t l = 0; l < logs.logs.size(); ++l) {
    const LogSurvey& log = logs.logs[l];
    std::vector<std::vector<LoneSamples>> lone(log.parts.size(),
                                               std::vector<LoneSamples>(log.plan.slots.size()));
    over_channels(log, is_measured, lone);
    for (std::size_t p = 0; p < log.parts.size(); ++p)
      for (std::size_t k = 0; k < log.plan.slots.size(); ++k) {
        const Slot& slot = log.plan.slots[k];
        if (!is_measured(slot)) continue;
        const Spike spike = lone[p][k].result(log, p, k);
        if (spike.ratio < kOddHeight) continue;
        findings.push_back(
            {l, spike.row, spike.ratio > kWrongHeight,
             fmt::format("{} = {:.3g} is a single sample, {:.2g} times the range of all others",
                         weighed_name(log.plan, slot.channel, slot.joint), spike.value,
                         spike.ratio),
             "correct it, or leave the row out"});
      }
  }
  return findings;
}

}  // namespace cablefit::weighing
