// From logs to rows of an equation: filter, differentiate, form every column at the full rate,
// average and decimate all columns alike, drop edges and rest. The same few lines serve stage 1,
// stage 2 and everything after; an equation only says what its columns are.
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

/// Every number that decides which rows come out. SI, rows count raw samples.
struct RowSettings {
  SignalSettings signal;
  /// Hz, of any equation with a cut-off of its own: windows leave it room to settle. 0: there is
  /// none below signal's.
  double lowest_cutoff = 0;
  int decimate = 1;
  Eigen::Index drop_edge = kDifferenceEdge;  ///< rows dropped at both ends of each segment
  Eigen::Index rest_margin = 0;              ///< rows around a slow one that go with it
  /// Hz, of the log that edge and margin count rows of; of a faster one they are as many more. 0:
  /// the same number in every log.
  double rate = 0;
};

/// For a log of this rate (Hz).
RowSettings at_rate(RowSettings settings, double rate);

/// An equation as columns over full-rate rows.
struct Equation {
  std::string name;  ///< "link", "motor", "blocked"
  std::vector<std::string> columns;
  std::vector<bool> averaged;  ///< per column: averaged over the triangle (not: a held torque)
  /// Changes signals of the full rate to what `fill` needs; empty: no change.
  std::function<void(Signals&)> prepare;
  /// Writes rows x columns.
  std::function<void(const Signals&, Eigen::Ref<Eigen::MatrixXd>)> fill;
  double cutoff = 0;      ///< Hz; its own low-pass; 0: that of the settings
  double rest_speed = 0;  ///< rad/s; rows slower than this are dropped; 0: keep all
  /// Speed by which rest is judged, n rows.
  std::function<Eigen::ArrayXd(const Signals&)> speed;
  /// Rows where this is 0 are left out and counted as "not used"; empty function: all are used.
  std::function<Eigen::ArrayXd(const Signals&)> use;
};

struct RowCounts {
  std::size_t rows_used = 0;      ///< after decimation
  std::size_t rows_at_rest = 0;   ///< after decimation, dropped
  std::size_t rows_not_used = 0;  ///< after decimation, by Equation::use
  std::size_t rows_at_edges = 0;  ///< raw rows
  void operator+=(const RowCounts& other);
};

/// Rows of one equation from one window.
struct EquationBatch {
  Eigen::MatrixXd rows;               ///< n x columns
  std::vector<Eigen::Index> numbers;  ///< place on the decimated time grid over all logs
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

/// Rows beside a window on which values of its rows depend.
Eigen::Index row_halo(const RowSettings& settings, double rate);

/// About how many rows will come out, per equation.
Eigen::Index expected_rows(std::span<const LogSurvey> logs, const PartFilter& wanted,
                           const RowSettings& settings);

/// Runs over all wanted rows of all logs in order: map(RowBatch) on worker threads, reduce(its
/// result) in order on this one. `keep`: windows for which it says false are passed over.
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
