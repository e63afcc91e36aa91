// Rig files with one random mistake: is it named?
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <array>
#include <random>
#include <string>

#include "tests/cli/case_file.hpp"

namespace {

using namespace cablefit::test;

struct WrongRig {
  std::string columns;            // of the rig file
  std::vector<std::string> says;  // what the first message has to contain
  bool moving_only = false;       // the blocked log lacks a column
  bool stale = false;             // only beside a stage 1 of the right rig
};

// The distributions of <random> differ between libraries; its engines do not.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  std::size_t below(std::size_t n) { return engine_() % n; }
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
  }

 private:
  std::mt19937 engine_;
};

std::string column(const std::string& channel, const std::string& from, const std::string& more) {
  return fmt::format(R"("{}": {{"column": "{}"{}}})", channel, from, more);
}

WrongRig wrong_sign(Dice& dice) {
  constexpr std::array channels = {"q", "theta", "tau", "tau_load"};
  const std::string channel = channels[dice.below(4)];
  return {column(channel, channel, R"(, "scale": -1)"),
          {channel + " is reversed"},
          channel == "tau_load"};
}

WrongRig wrong_unit(Dice& dice) {
  switch (dice.below(4)) {
    case 0:
      return {column("q", "q", R"(, "unit": "deg")"), {"q not in degrees"}};
    case 1:
      return {column("theta", "theta", R"(, "unit": "deg")"), {"theta not in degrees"}};
    case 2: {
      constexpr std::array units = {"ms", "us", "ns"};
      return {column("t", "t", fmt::format(R"(, "unit": "{}")", units[dice.below(3)])),
              {"the time step is", "is t in s?"}};
    }
    default:
      return {column("tau", "tau", R"(, "unit": "mN m")"), {"tau is 0.00", "known load"}};
  }
}

WrongRig wrong_scale(Dice& dice) {
  const bool down = dice.below(2) == 1;
  if (dice.below(2) == 0) {
    const double reduction = dice.between(5, 50);
    const double sign = dice.below(2) == 1 ? -1 : 1;
    return {column("theta", "theta",
                   fmt::format(R"(, "scale": {})", sign * (down ? 1 / reduction : reduction))),
            {"theta moves", "a reduction?"}};
  }
  const double scale = dice.between(1.9, 20);
  return {column("tau", "tau", fmt::format(R"(, "scale": {})", down ? 1 / scale : scale)),
          {"tau is ", "times the torque that balances the known load"}};
}

WrongRig wrong_column(Dice& dice) {
  struct Pair {
    const char *a, *b;
    bool moving_only;
  };
  constexpr std::array<Pair, 4> pairs = {{{"q", "theta", false},
                                          {"tau", "tau_load", true},
                                          {"tau", "theta", true},
                                          {"tau", "q", true}}};
  const Pair pair = pairs[dice.below(4)];
  return {column(pair.a, pair.b, "") + ", " + column(pair.b, pair.a, ""),
          {"swapped?", pair.a, pair.b},
          pair.moving_only};
}

/// Too little for any log to show, so that only the result of stage 1 can.
WrongRig stale_stage(Dice& dice) {
  constexpr std::array channels = {"theta", "tau"};
  const std::string channel = channels[dice.below(2)];
  WrongRig rig{column(channel, channel, fmt::format(R"(, "scale": {})", dice.between(0.95, 0.99))),
               {"stage 1 was fitted with " + channel + " scale 1, the rig now says 0.9"}};
  rig.stale = true;
  return rig;
}

WrongRig wrong_rig(Dice& dice) {
  constexpr std::array kinds = {wrong_sign, wrong_unit, wrong_scale, wrong_column, stale_stage};
  return kinds[dice.below(kinds.size())](dice);
}

Outcome run_with(const WrongRig& rig) {
  Case wanted;
  wanted.files = {
      {"wrong.json",
       fmt::format(R"({{"schema": "cablefit/rig/1", "preload": "low", "load": {{"type": "column"}},
 "columns": {{{}}}}})",
                   rig.columns)}};
  const std::string low = std::string(CABLEFIT_DATA) + "/low/";
  const std::string command = rig.stale ? "dynamic --model poly" : "check";
  wanted.run = fmt::format("cablefit {} --quiet --rig wrong.json {}", command, low) +
               "moving_load30.csv " + low + "moving_load-40.csv";
  if (rig.stale) {
    wanted.prepare = {"cablefit elastic --quiet " + low + "blocked.csv"};
  } else if (!rig.moving_only) {
    wanted.run += " " + low + "blocked.csv";
  }
  return run_case(wanted);
}

TEST_CASE("of 30 random wrong rigs at least 28 are named and none passes") {
  const auto seed = GENERATE(24u, 1u, 2u, 3u);
  CAPTURE(seed);
  Dice dice(seed);
  int named = 0;
  for (int k = 0; k < 30; ++k) {
    const WrongRig rig = wrong_rig(dice);
    const Outcome outcome = run_with(rig);
    const std::string first = outcome.err.substr(0, outcome.err.find('\n'));
    CAPTURE(rig.columns, first);
    CHECK(outcome.exit_code == 3);
    bool all = true;
    for (const std::string& word : rig.says) all = all && first.find(word) != std::string::npos;
    CHECK_NOFAIL(all);
    named += all;
  }
  CHECK(named >= 28);
}

}  // namespace
