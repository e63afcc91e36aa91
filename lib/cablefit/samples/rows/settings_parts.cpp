#include "cablefit/samples/rows/settings_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/samples/survey/noise.hpp"

namespace cablefit {
namespace {

constexpr double kSamplesPerPeriod = 2.5;  // rows per period of the cut-off after decimation
// Periods of the cut-off on either side of a standstill or reversal that carry the filter's smear
// of friction's step. Of noise-free logs of the paper's rig (cut-off 50 to 200 Hz) one period
// leaves J_link within 0.03 %; a quarter left 0.4 % at the high preload, 6 % of the rows of a
// blocked sweep (half a period) carried 97 % of its residual.
constexpr double kSmear = 1;

/// Options that no log can meet.
void check_options(std::span<const LogSurvey> logs, const PartFilter& wanted,
                   const SampleOptions& options, double rate) {
  double longest = 0;  // s
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts)
      if (wanted(part)) longest = std::max(longest, part.period * static_cast<double>(part.n_rows));
  if (options.cutoff && *options.cutoff > 0 && *options.cutoff * longest < 2)
    throw usage_error(
        fmt::format("--cutoff {:g} Hz has a period as long as the longest log ({:.3g} s)",
                    *options.cutoff, longest),
        "choose a higher cut-off, or 0 for no filter");
  if (options.drop_edge && static_cast<double>(*options.drop_edge) > longest * rate / 2)
    throw usage_error(fmt::format("--drop-edge {} leaves nothing of the longest log ({:.0f} rows)",
                                  *options.drop_edge, longest * rate),
                      "drop fewer rows");
  if (options.decimate && *options.decimate > longest * rate / 10)
    throw usage_error(fmt::format("--decimate {} leaves fewer than ten rows", *options.decimate),
                      "decimate less");
  if (options.cutoff && *options.cutoff >= 0.45 * rate)
    throw usage_error(fmt::format("--cutoff {:g} is not below 0.45 of the sample rate of {:.4g} Hz",
                                  *options.cutoff, rate),
                      "choose a lower cut-off, or 0 for no filter");
}

void choose_filter_order(ChosenSettings& chosen, const SampleOptions& options) {
  chosen.rows.signal.filter_order = options.filter_order.value_or(4);
  decide(chosen, "filter order", std::to_string(chosen.rows.signal.filter_order),
         options.filter_order ? kByOption : "Butterworth, forward and backward");
}

/// What the logs are read as, once for all that are read alike.
void add_reading(std::span<const LogSurvey> logs, const PartFilter& wanted,
                 ChosenSettings& chosen) {
  for (const LogSurvey& log : logs) {
    if (std::none_of(log.parts.begin(), log.parts.end(), wanted)) continue;
    for (const Decision& decision : log.plan.decisions) {
      const auto same = [&](const Decision& other) {
        return other.name == decision.name && other.value == decision.value;
      };
      if (std::none_of(chosen.decisions.begin(), chosen.decisions.end(), same))
        chosen.decisions.push_back(decision);
    }
  }
}

bool are_one(const RateRange& rates) { return rates.highest <= kSameRate * rates.lowest; }

}  // namespace

double worst_noise(std::span<const LogSurvey> logs, const PartFilter& wanted, Channel channel,
                   int joint) {
  double worst = 0;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts)
      if (wanted(part)) worst = std::max(worst, position_noise(log, part, channel, joint));
  return worst;
}

void decide(ChosenSettings& chosen, std::string name, std::string value, std::string reason) {
  chosen.decisions.push_back({std::move(name), std::move(value), std::move(reason)});
}

ChosenSettings begin_settings(std::span<const LogSurvey> logs, const PartFilter& wanted,
                              const SampleOptions& options, const RateRange& rates) {
  ChosenSettings chosen;
  if (!are_one(rates))
    chosen.warnings.push_back(
        fmt::format("the logs have rates of {:.4g} to {:.4g} Hz: the lowest limits the filter of "
                    "all",
                    rates.lowest, rates.highest));
  check_options(logs, wanted, options, rates.lowest);
  add_reading(logs, wanted, chosen);
  choose_filter_order(chosen, options);
  return chosen;
}

void choose_decimation(ChosenSettings& chosen, const SampleOptions& options, double rate) {
  RowSettings& rows = chosen.rows;
  if (options.decimate) {
    rows.decimate = *options.decimate;
    decide(chosen, "decimation", std::to_string(rows.decimate), kByOption);
    return;
  }
  if (rows.signal.cutoff > 0)
    rows.decimate = std::max(1, static_cast<int>(rate / (kSamplesPerPeriod * rows.signal.cutoff)));
  decide(chosen, "decimation", std::to_string(rows.decimate),
         rows.signal.cutoff > 0
             ? fmt::format("{:g} rows a period of the cut-off", kSamplesPerPeriod)
             : "no filter, no decimation");
}

void choose_rest_margin(ChosenSettings& chosen, double rate) {
  RowSettings& rows = chosen.rows;
  const double cutoff = rows.signal.cutoff;
  if (!(cutoff > 0)) return;
  rows.rest_margin = static_cast<Eigen::Index>(std::ceil(kSmear * rate / cutoff));
  decide(chosen, "rest margin",
         fmt::format("{:.3g} s", static_cast<double>(rows.rest_margin) / rate),
         "the filter spreads a step of friction over one period of the cut-off on "
         "either side");
}

void choose_edges(ChosenSettings& chosen, const SampleOptions& options, const RateRange& rates) {
  RowSettings& rows = chosen.rows;
  rows.rate = rates.lowest;
  const double rate = are_one(rates) ? rates.highest : rates.lowest;
  if (options.drop_edge) {
    rows.drop_edge = std::max<Eigen::Index>(*options.drop_edge, kDifferenceEdge);
    decide(chosen, "edge rows", std::to_string(rows.drop_edge), kByOption);
    return;
  }
  const double cutoff = rows.signal.cutoff;
  rows.drop_edge =
      cutoff > 0 ? std::max<Eigen::Index>(kDifferenceEdge,
                                          static_cast<Eigen::Index>(std::ceil(2 * rate / cutoff)))
                 : kDifferenceEdge;
  decide(chosen, "edge rows", std::to_string(rows.drop_edge),
         cutoff > 0 ? "two periods of the cut-off" : "rows that differences do not reach");
}

SampleOptions with_wide_band(SampleOptions options, double rate) {
  constexpr double kWideBand = 0.15;  // of the rate: the widest band the differences allow
  if (!options.cutoff) options.cutoff = kWideBand * rate;
  return options;
}

}  // namespace cablefit
