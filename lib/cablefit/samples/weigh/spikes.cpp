#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

/// The row in the log of a place among the rows of a part.
std::size_t row_of(const LogSurvey& log, std::size_t part, std::size_t place) {
  std::size_t row = 0;
  for (const SamplePiece& piece : log.samples->pieces()) {
    const auto n = static_cast<std::size_t>(piece.n_rows);
    if (piece.part == part && place < n) return row + place;
    if (piece.part == part) place -= n;
    row += n;
  }
  return row;
}

Spike spike_of(const LogSurvey& log, std::size_t part, std::size_t slot) {
  const ChannelSurvey& channel = log.parts[part].channels[slot];
  // The quantiles cost a sort: only where the range is not the usual one.
  if (!(channel.lone.height > 0.5 * channel.range())) return {};
  const double usual = usual_range(log, part, static_cast<Eigen::Index>(slot) + 1);
  return {usual > 0 ? channel.lone.height / usual : 0, channel.lone.value,
          row_of(log, part, channel.lone.place)};
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
        const Spike spike = spike_of(log, p, k);
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
