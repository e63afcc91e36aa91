// Why an equation has few rows in motion: by its rest speed against the motion's own speed.
#include "cablefit/dynamic/rows/requirements.hpp"
#include "tests/samples/rows_of_logs.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// theta = sin(2 pi t / 4 s), whose speed is at most 1.57 rad/s; `wraps`: a single sample each 4 s
/// is a turn off.
std::string motion(double rate, bool wraps) {
  std::string text = "t,theta,tau\n";
  for (int i = 0; i < 8 * rate; ++i) {
    const double t = i / rate;
    const bool is_off = wraps && i % static_cast<int>(4 * rate) == static_cast<int>(rate);
    const double jump = is_off ? 2 * std::numbers::pi : 0;
    text += fmt::format("{},{},{}\n", t, std::sin(std::numbers::pi * t / 2) - jump, i % 3);
  }
  return text;
}

/// What stage 2 says of a motor with no row in motion.
std::string message(double rate, bool wraps, double rest_speed, const SampleOptions& samples = {}) {
  Bench bench;
  bench.add_text(motion(rate, wraps));
  DynamicOptions options;
  options.samples = samples;
  DynamicJob job{bench.logs(), options, "low", kAllParts, {}, {"rigid"}, true, {}, {}};
  EquationRows rows;
  rows.columns.n_effects = 4;
  rows.equation.name = "motor";
  rows.equation.rest_speed = rest_speed;
  rows.equation.speed = [](const Signals& signals) { return signals.joints[0].thetad; };
  return message_of([&] { require_rows(rows, job); });
}

const char* const kFew =
    "preload 'low': only 0 rows in motion on the motor side; record a longer or faster motion, or "
    "lower --rest-speed";

TEST_CASE("the error of the speed hides the motion", "[samples]") {
  // The faster tenth of a sine begins at sin(0.9 pi/2) of its peak: 1.55 rad/s.
  CHECK(message(1000, false, 2.3) ==
        "preload 'low': the speed's error on the motor side (2.3 rad/s) hides the motion (1.6 "
        "rad/s): encoder jumps, or too slow a motion; look at the positions, or set --rest-speed");
  CHECK(message(100, false, 2.3) ==
        "preload 'low': the speed's error on the motor side (2.3 rad/s) hides the motion (1.6 "
        "rad/s): encoder jumps, or too low a rate (100 Hz), or too slow a motion; look at the "
        "positions, or set --rest-speed");
}

TEST_CASE("a rest speed well below the motion hides nothing", "[samples]") {
  CHECK(message(1000, false, 0.5) == kFew);
  CHECK(message(1000, false, 0) == kFew);
  SampleOptions given;
  given.rest_speed = 2.3;
  CHECK(message(1000, false, 2.3, given) == kFew);
}

TEST_CASE("jumps of an encoder are no motion", "[samples]") {
  CHECK(message(1000, true, 60) ==
        "preload 'low': the speed's error on the motor side (60 rad/s) hides the motion (1.6 "
        "rad/s): encoder jumps, or too slow a motion; look at the positions, or set --rest-speed");
}

TEST_CASE("noise that lowers the cut-off hides the motion", "[samples]") {
  Bench bench;
  bench.add_text(motion(100, false));
  const DynamicOptions options;
  DynamicJob job{bench.logs(), options, "low", kAllParts, {}, {"rigid"}, true, {}, {}};
  job.settings.rows.signal.cutoff = 0.9;
  job.settings.decisions = {{"cut-off", "0.9 Hz", "position noise below 0.25 %"}};
  EquationRows rows;
  rows.columns.n_effects = 4;
  rows.equation.name = "motor";
  rows.equation.rest_speed = 0.1;
  rows.equation.speed = [](const Signals& signals) { return signals.joints[0].thetad; };
  const std::string text = message_of([&] { require_rows(rows, job); });
  CHECK(text.starts_with("preload 'low': the noise of theta ("));
  CHECK(
      text.ends_with(" rad) lowers the cut-off to 0.9 Hz, too low for the motion on the motor "
                     "side: encoder jumps, or too low a rate (100 Hz); look at the positions, or "
                     "set --cutoff"));
}

}  // namespace
