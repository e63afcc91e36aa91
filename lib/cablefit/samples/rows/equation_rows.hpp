// From logs to rows of an equation: filter, differentiate, form every column at the full rate,
// average and decimate all columns alike, drop edges and rest. All stages use this code; an
// equation only defines its columns.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/samples/rows/decimation.hpp"
#include "cablefit/samples/rows/signals.hpp"
#include "cablefit/samples/survey/windows.hpp"

namespace cablefit {

/// Ratio of two rates that count as one: clocks are never quite alike.
inline constexpr double kSameRate = 1.01;

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
  /// Writes rows x columns.
  std::function<void(const Signals&, Eigen::Ref<Eigen::MatrixXd>)> fill;
  /// Its columns and its cut-off are those of the equation before it, formed once; only `speed`,
  /// `use` and `rest_speed` are its own.
  bool shares_columns = false;
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

/// Samples of a window with this halo: kWindowRows. For quasi-static signals a multiple of it:
/// their halo is long, and every window filters its halo again.
Eigen::Index window_rows(const RowSettings& settings, Eigen::Index halo);

/// Approximate number of rows per equation.
Eigen::Index expected_rows(std::span<const LogSurvey> logs, const PartFilter& wanted,
                           const RowSettings& settings);

}  // namespace cablefit
