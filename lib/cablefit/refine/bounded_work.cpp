#include "cablefit/refine/bounded_work.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

constexpr double kSlowRate = 40;       // Hz; 100,000 rows of a faster log are searched within 60 s
constexpr double kMostSeconds = 1000;  // of all moving parts of a slow log

}  // namespace

void require_bounded_work(const RefineLogs& logs) {
  for (const auto* some : {&logs.train, &logs.test})
    for (const LogSurvey& log : *some) {
      double seconds = 0, rate = 0;
      for (const PartSurvey& part : log.parts) {
        if (part.phase != Phase::moving) continue;
        seconds += part.period * static_cast<double>(part.n_rows);
        rate = std::max(rate, 1 / part.period);
      }
      if (seconds <= kMostSeconds || rate >= kSlowRate) continue;
      throw input_error(
          {log.plan.path},
          fmt::format("{:.0f} s at {:.3g} Hz: too long a log for so slow a rate", seconds, rate),
          fmt::format("record at {:g} Hz or more, or give at most {:g} s", kSlowRate,
                      kMostSeconds));
    }
}

}  // namespace cablefit
