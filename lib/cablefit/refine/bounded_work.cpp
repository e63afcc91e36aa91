#include "cablefit/refine/bounded_work.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

constexpr double kSlowRate = 100;      // Hz; 100,000 rows of a faster log are searched within 60 s
constexpr double kMostSeconds = 1000;  // of all moving parts of slow logs

}  // namespace

void require_bounded_work(const RefineLogs& logs) {
  double seconds = 0;
  for (const auto* some : {&logs.train, &logs.test})
    for (const LogSurvey& log : *some) {
      double rate = kUnbounded;
      for (const PartSurvey& part : log.parts) {
        if (part.phase != Phase::moving || 1 / part.period >= kSlowRate) continue;
        seconds += part.period * static_cast<double>(part.n_rows);
        rate = std::min(rate, 1 / part.period);
      }
      if (seconds <= kMostSeconds) continue;
      throw input_error(
          {log.plan.path},
          fmt::format("refine would take too long: {:.0f} s at {:.3g} Hz", seconds, rate),
          fmt::format("record at {:g} Hz or more, or give at most {:g} s", kSlowRate,
                      kMostSeconds));
    }
}

}  // namespace cablefit
