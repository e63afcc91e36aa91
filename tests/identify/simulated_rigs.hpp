// Simulated logs of one pair of cables at several preloads.
#pragma once

#include <memory>

#include "cablefit/identify/identify.hpp"
#include "tests/support/recover.hpp"

namespace cablefit::test {

/// Logs of several preloads, without rig files: only their names distinguish them.
class PreloadedBench {
 public:
  void add(const std::string& preload, const truth::Log& log) {
    const std::string path = folder_->file(fmt::format("log{}.csv", logs_.size()));
    truth::write_csv(path, log);
    logs_.push_back(survey_log(plan_log(path, rig), preload));
  }
  const std::vector<LogSurvey>& logs() const { return logs_; }

  Rig rig = default_rig();

 private:
  std::unique_ptr<TempFolder> folder_ = std::make_unique<TempFolder>();
  std::vector<LogSurvey> logs_;
};

/// A blocked log of 20 s, one slow sweep and a half.
inline truth::Log blocked_log(const truth::Rig& rig, std::uint64_t seed, double range = 0.045) {
  truth::BlockedOptions options;
  options.duration = 20;
  options.seed = seed;
  options.range = range;
  return truth::simulate_blocked(rig, options);
}

inline truth::Log moving_log(const truth::Rig& rig, std::uint64_t seed, double load) {
  truth::MovingOptions options;
  options.load = load;
  options.seed = seed;
  return truth::simulate_moving(rig, options);
}

/// The low rig stretched by l_o of cable 1 and what balances it.
inline truth::Rig stretched(double l_o) {
  truth::Rig rig = truth::Rig::low();
  rig.cable_1.initial_elongation = l_o;
  rig.cable_2.initial_elongation = truth::elongation_for(rig.cable_2, rig.cable_1.torque(l_o));
  return rig;
}

}  // namespace cablefit::test
