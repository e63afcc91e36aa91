// From logs to rows of an equation: filter, differentiate, form every column at the full rate,
// average and decimate all columns alike, drop edges and rest. All stages use this code; an
// equation only defines its columns.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "cablefit/base/parallel.hpp"
#include "cablefit/samples/rows/decimation.hpp"
#include "cablefit/samples/rows/signals.hpp"
#include "cablefit/samples/survey/windows.hpp"

namespace cablefit {

/// All numbers that decide which rows result. SI; counts of rows are in raw samples.
struct RowSettings {
  SignalSettings signal;
  /// Hz, the lowest cut-off of any equation: windows are long enough for it to settle. 0: none is
  /// below that of `signal`.
  double lowest_cutoff = 0;
  int decimate = 1;
  Eigen::Index drop_edge = kDifferenceEdge;  ///< rows dropped at both ends of each segment
  Eigen::Index rest_margin = 0;              ///< rows dropped on either side of a slow row
  /// Hz, rate of the log in which `drop_edge` and `rest_margin` count rows. A faster log drops
  /// proportionally more rows. 0: every log drops the same number.
  double rate = 0;
};

/// The settings for a log of this rate (Hz).
RowSettings at_rate(RowSettings settings, double rate);

/// An equation as columns over full-rate rows.
struct Equation {
  std::string name;  ///< "link", "motor", "blocked"
  std::vector<std::string> columns;
  std::vector<bool> averaged;  ///< per column: averaged over the triangle (all but a held torque)
  /// Converts signals of the full rate to those that `fill` needs; empty: no change.
  std::function<void(Signals&)> prepare;
  /// Writes rows x columns.
  std::function<void(const Signals&, Eigen::Ref<Eigen::MatrixXd>)> fill;
  double cutoff = 0;      ///< Hz, low-pass of this equation; 0: that of the settings
  double rest_speed = 0;  ///< rad/s; slower rows are dropped; 0: all rows are kept
  /// Speed that decides on rest, n rows.
  std::function<Eigen::ArrayXd(const Signals&)> speed;
  /// Rows with value 0 are left out and counted as "not used"; empty function: all rows are used.
  std::function<Eigen::ArrayXd(const Signals&)> use;
};

struct RowCounts {
  std::size_t rows_used = 0;      ///< after decimation
  std::size_t rows_at_rest = 0;   ///< after decimation, dropped
  std::size_t rows_not_used = 0;  ///< after decimation, left out by Equation::use
  std::size_t rows_at_edges = 0;  ///< raw rows
  void operator+=(const RowCounts& other);
};

/// Rows of one equation from one window.
struct EquationBatch {
  Eigen::MatrixXd rows;               ///< n x columns
  std::vector<Eigen::Index> numbers;  ///< place on the decimated time grid of all logs
  std::vector<double> t;              ///< s
  RowCounts counts;
};

struct RowBatch {
  std::size_t log = 0;
  std::size_t part = 0;
  std::vector<EquationBatch> equations;
};

using PartFilter = std::function<bool(const PartSurvey&)>;
using WindowFilter = std::function<bool(const WindowPlace&)>;

RowBatch make_rows(const Window& window, const LogSurvey& log, Eigen::Index number_offset,
                   const RowSettings& settings, std::span<const Equation> equations);

/// Rows beside a window that its own rows depend on.
Eigen::Index row_halo(const RowSettings& settings, double rate);

/// Approximate number of rows per equation.
Eigen::Index expected_rows(std::span<const LogSurvey> logs, const PartFilter& wanted,
                           const RowSettings& settings);

/// Processes all wanted rows of all logs in order: map(RowBatch) on worker threads, reduce(its
/// result) in order on this thread. `keep`: windows for which it returns false are skipped.
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
      const WindowCounts counts = for_each_window(
          logs[k], wanted, halo, 2 * edge + 2 * kDifferenceEdge + settings.decimate,
          bridge_seconds(settings.signal), [&](Window&& window) {
            return (keep && !keep(window)) || emit(Item{k, offset, std::move(window)});
          });
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
