#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kOdd = 5, kWrong = 50;  // times the range of 98 % of the samples
constexpr std::size_t kQuantileSamples = 20000;
constexpr double kLeastScale = 1e-3;  // of the median, for a channel that hardly varies

struct Spike {
  double ratio = 0, value = 0;
  std::size_t row = 0;  // in the log
};

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

Spike largest_spike(const LogSurvey& log, std::size_t part, Eigen::Index column) {
  Spike largest;
  double height = 0;
  std::size_t row = 0;
  Eigen::MatrixXd rows;
  for (const SamplePiece& piece : log.samples->pieces()) {
    const std::size_t begin = row;
    row += static_cast<std::size_t>(piece.n_rows);
    if (piece.part != part) continue;
    log.samples->read(piece, rows);
    const auto x = rows.col(column);
    for (Eigen::Index i = 1; i + 1 < x.size(); ++i) {
      const double lone = lone_height(x(i - 1), x(i), x(i + 1));
      if (lone > height) height = lone, largest = {0, x(i), begin + static_cast<std::size_t>(i)};
    }
  }
  // The quantiles cost a sort: only where the range is not the usual one.
  const ChannelSurvey& seen = log.parts[part].channels[static_cast<std::size_t>(column - 1)];
  if (!(height > 0.5 * seen.range())) return {};
  const double usual = usual_range(log, part, column);
  largest.ratio = usual > 0 ? height / usual : 0;
  return largest;
}

}  // namespace

Findings spikes(const Logs& logs) {
  Findings findings;
  for (std::size_t l = 0; l < logs.logs.size(); ++l) {
    const LogSurvey& log = logs.logs[l];
    for (std::size_t p = 0; p < log.parts.size(); ++p)
      for (std::size_t k = 0; k < log.plan.slots.size(); ++k) {
        const Slot& slot = log.plan.slots[k];
        if (slot.integrated) continue;
        const Spike spike = largest_spike(log, p, static_cast<Eigen::Index>(k) + 1);
        if (spike.ratio < kOdd) continue;
        findings.push_back(
            {l, line_of_row(log.plan, spike.row), spike.ratio > kWrong,
             fmt::format("{} = {:.3g} is a single sample, {:.2g} times the range of all others",
                         weighed_name(log.plan, slot.channel, slot.joint), spike.value,
                         spike.ratio),
             "correct it, or leave the row out"});
      }
  }
  return findings;
}

}  // namespace cablefit::weighing
