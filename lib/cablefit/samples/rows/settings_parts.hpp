// What the settings of blocked and of moving logs have in common. Internal to blocked_settings.cpp
// and moving_settings.cpp.
#pragma once

#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit {

inline constexpr double kMaxShareOfRate = 0.2;  // beyond it a five-point difference is off by 1 %
inline constexpr const char* kByOption = "given";

/// Worst position_noise() of the parts wanted.
double worst_noise(std::span<const LogSurvey> logs, const PartFilter& wanted, Channel channel,
                   int joint);

void decide(ChosenSettings& chosen, std::string name, std::string value, std::string reason);

/// Settings that name the filter's order only, and a warning of unequal rates. Throws Error(usage)
/// for options that no log can meet.
ChosenSettings begin_settings(std::span<const LogSurvey> logs, const PartFilter& wanted,
                              const SampleOptions& options, const RateRange& rates);
void choose_decimation(ChosenSettings& chosen, const SampleOptions& options, double rate);
/// The rows around a standstill or reversal over which the filter smears friction's step.
void choose_rest_margin(ChosenSettings& chosen, double rate);
void choose_edges(ChosenSettings& chosen, const SampleOptions& options, const RateRange& rates);

}  // namespace cablefit
