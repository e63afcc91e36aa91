// One pass over all rows of the equations, on several threads. Apart from equation_rows.hpp,
// because threads compile slowly and few files need them.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "cablefit/base/parallel.hpp"
#include "cablefit/samples/rows/equation_rows.hpp"
#include "cablefit/samples/survey/chosen_windows.hpp"

namespace cablefit {

/// Processes all wanted rows of all logs in order: map(RowBatch) on worker threads, reduce(its
/// result) in order on this thread. `keep`: windows for which it returns false are skipped, and the
/// others have no Window::approach.
template <class Map, class Reduce>
WindowCounts stream_rows(std::span<const LogSurvey> logs, const PartFilter& wanted,
                         const RowSettings& settings, std::span<const Equation> equations,
                         int threads, Map map, Reduce reduce, const WindowFilter& keep = {}) {
  struct Item {
    std::size_t log = 0;
    Eigen::Index offset = 0;
    Window window;
  };
  WindowCounts total;
  const auto produce = [&](auto emit) {
    Eigen::Index offset = 0;
    for (std::size_t k = 0; k < logs.size(); ++k) {
      double rate = 0, lowest = std::numeric_limits<double>::infinity();
      for (const PartSurvey& part : logs[k].parts) {
        if (!wanted(part)) continue;
        rate = std::max(rate, 1 / part.period);
        lowest = std::min(lowest, 1 / part.period);
      }
      if (rate == 0) continue;
      const Eigen::Index halo = row_halo(settings, rate);
      const Eigen::Index edge = at_rate(settings, lowest).drop_edge;
      const Eigen::Index min_rows = 2 * edge + 2 * kDifferenceEdge + settings.decimate;
      const double bridge = bridge_seconds(settings.signal);
      const auto take = [&](Window&& window) { return emit(Item{k, offset, std::move(window)}); };
      const WindowCounts counts =
          keep ? for_chosen_windows(logs[k], wanted, halo, min_rows, bridge, keep, take)
               : for_each_window(logs[k], wanted, halo, min_rows, bridge, take,
                                 window_rows(settings, halo));
      total.rows_read += counts.rows_read;
      total.rows_resampled += counts.rows_resampled;
      total.rows_too_short += counts.rows_too_short;
      total.segments += counts.segments;
      offset += static_cast<Eigen::Index>(counts.rows_out) / settings.decimate + 1;
    }
  };
  ordered_pipeline<Item>(
      threads, produce,
      [&](Item item) {
        RowBatch batch = make_rows(item.window, logs[item.log], item.offset, settings, equations);
        batch.log = item.log;
        return map(std::move(batch));
      },
      reduce);
  return total;
}

}  // namespace cablefit
