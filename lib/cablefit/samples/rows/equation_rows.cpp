#include "cablefit/samples/rows/equation_rows.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <optional>

#include "cablefit/base/divided_up.hpp"
#include "cablefit/samples/rows/thinning.hpp"

namespace cablefit {
namespace {

// Number of slow rows in [0, i), so that "any slow row within m" is one subtraction.
std::vector<Eigen::Index> count_before(const Eigen::Array<bool, Eigen::Dynamic, 1>& flag) {
  std::vector<Eigen::Index> before(static_cast<std::size_t>(flag.size()) + 1, 0);
  for (Eigen::Index i = 0; i < flag.size(); ++i)
    before[static_cast<std::size_t>(i) + 1] = before[static_cast<std::size_t>(i)] + flag(i);
  return before;
}

class RowMask {
 public:
  RowMask(const Equation& equation, const Signals& signals, const RowSettings& settings)
      : n_(signals.n_rows()), reach_(settings.rest_margin + settings.decimate) {
    if (equation.speed && equation.rest_speed > 0)
      slow_before_ = count_before(equation.speed(signals).abs() < equation.rest_speed);
    if (equation.use) use_ = equation.use(signals);
  }
  bool at_rest(Eigen::Index i) const {
    if (slow_before_.empty()) return false;
    const auto from = static_cast<std::size_t>(std::max<Eigen::Index>(0, i - reach_));
    const auto to = static_cast<std::size_t>(std::min<Eigen::Index>(n_, i + reach_ + 1));
    return slow_before_[to] > slow_before_[from];
  }
  bool used(Eigen::Index i) const { return use_.size() == 0 || use_(i) != 0; }

 private:
  Eigen::Index n_, reach_;
  std::vector<Eigen::Index> slow_before_;
  Eigen::ArrayXd use_;
};

/// Rows from either end of a segment that cannot be trusted.
Eigen::Index edge_rows(const RowSettings& settings) {
  return std::max(settings.drop_edge, kDifferenceEdge);
}

/// The rows of a window that answer to an equation, and what became of the others.
struct ChosenRows {
  std::vector<Eigen::Index> centres;  ///< in window coordinates
  Eigen::Index first = 0, last = 0;   ///< those that can be trusted lie between these
  RowCounts counts;
};

ChosenRows choose_rows(const Equation& equation, const Signals& signals, const WindowPlace& window,
                       const RowSettings& settings) {
  const RowMask mask(equation, signals, settings);
  const Eigen::Index edge = edge_rows(settings);
  ChosenRows chosen;
  chosen.first = std::max<Eigen::Index>(0, edge - window.first);
  chosen.last = window.ends_segment ? signals.n_rows() - edge : signals.n_rows();
  RowCounts& counts = chosen.counts;
  // Of the rows edge, edge + decimate, ... of the segment.
  const Eigen::Index from = std::max(window.begin, window.first + chosen.first);
  const Eigen::Index to = std::min(window.end, window.first + chosen.last);
  for (Eigen::Index i = edge + divided_up(from - edge, settings.decimate) * settings.decimate;
       i < to; i += settings.decimate) {
    const Eigen::Index at = i - window.first;
    if (!mask.used(at)) {
      ++counts.rows_not_used;
    } else if (mask.at_rest(at)) {
      ++counts.rows_at_rest;
    } else {
      chosen.centres.push_back(at);
    }
  }
  counts.rows_used = chosen.centres.size();
  return chosen;
}

/// Columns over the rows of a window, formed when the first row of them is wanted.
struct FullColumns {
  const Signals* signals = nullptr;
  Eigen::MatrixXd values;

  const Eigen::MatrixXd& of(const Equation& equation) {
    if (values.size() == 0) {
      values.resize(signals->n_rows(), static_cast<Eigen::Index>(equation.columns.size()));
      equation.fill(*signals, values);
    }
    return values;
  }
};

EquationBatch equation_rows(const Equation& equation, FullColumns& columns,
                            const WindowPlace& window, Eigen::Index number_offset,
                            const RowSettings& settings) {
  const ChosenRows chosen = choose_rows(equation, *columns.signals, window, settings);
  EquationBatch batch;
  batch.counts = chosen.counts;
  if (chosen.centres.empty()) {
    batch.rows.resize(0, static_cast<Eigen::Index>(equation.columns.size()));
    return batch;
  }
  batch.rows = Decimation(settings.decimate)
                   .apply(columns.of(equation), chosen.centres, chosen.first, chosen.last,
                          equation.averaged);
  for (const Eigen::Index at : chosen.centres) {
    batch.numbers.push_back(number_offset +
                            (window.rows_before + window.first + at) / settings.decimate);
    batch.t.push_back(window.t0 + static_cast<double>(window.first + at) * window.period);
  }
  return batch;
}

/// The settings for windows thinned by `step` from `period`.
RowSettings thinned(RowSettings settings, int step, double period) {
  SignalSettings& signal = settings.signal;
  if (signal.torque_period == 0) signal.torque_period = period;  // not that of the rows kept
  settings.decimate /= step;
  settings.drop_edge = divided_up(settings.drop_edge, step);
  settings.rest_margin = divided_up(settings.rest_margin, step);
  return settings;
}

/// The settings of an equation with that cut-off (Hz; 0: theirs): what the filter smears around a
/// standstill is as much longer as the cut-off is lower.
RowSettings with_cutoff(RowSettings settings, double cutoff) {
  const double usual = settings.signal.cutoff;
  if (!(cutoff > 0) || cutoff == usual) return settings;
  settings.signal.cutoff = cutoff;
  if (usual > cutoff)
    settings.rest_margin = static_cast<Eigen::Index>(
        std::ceil(static_cast<double>(settings.rest_margin) * usual / cutoff));
  return settings;
}

/// Rows [begin, end) of a window that are within `edge` rows of either end of their segment.
std::size_t rows_at_edges(const Window& window, Eigen::Index edge) {
  const Eigen::Index inner_begin = std::max(window.begin, edge);
  Eigen::Index inner_end = window.end;
  if (window.ends_segment)
    inner_end = std::min(inner_end, window.first + window.data.rows() - edge);
  const Eigen::Index inner = std::max<Eigen::Index>(0, inner_end - inner_begin);
  return static_cast<std::size_t>(window.end - window.begin - inner);
}

RowBatch rows_of(const Window& window, const LogSurvey& log, Eigen::Index number_offset,
                 const RowSettings& settings, std::span<const Equation> equations) {
  RowBatch batch;
  batch.part = window.part;
  // Equations of one cut-off share their signals.
  std::map<double, Signals> signals;
  FullColumns columns;
  for (const Equation& equation : equations) {
    const RowSettings own = with_cutoff(settings, equation.cutoff);
    auto found = signals.find(own.signal.cutoff);
    if (found == signals.end()) {
      found = signals.emplace(own.signal.cutoff, make_signals(window, log.plan, own.signal)).first;
      found->second.log_began = log.parts.front().t_first;
    }
    if (!equation.shares_columns) columns = {&found->second, {}};
    assert(columns.signals == &found->second && "the columns of an equation of another cut-off");
    batch.equations.push_back(equation_rows(equation, columns, window, number_offset, own));
  }
  return batch;
}

}  // namespace

RowSettings at_rate(RowSettings settings, double rate) {
  if (!(settings.rate > 0) || rate <= kSameRate * settings.rate) return settings;
  const auto scaled = [&](Eigen::Index rows) {
    return static_cast<Eigen::Index>(std::ceil(static_cast<double>(rows) * rate / settings.rate));
  };
  settings.drop_edge = scaled(settings.drop_edge);
  settings.rest_margin = scaled(settings.rest_margin);
  settings.rate = rate;
  return settings;
}

void RowCounts::operator+=(const RowCounts& other) {
  rows_used += other.rows_used;
  rows_at_rest += other.rows_at_rest;
  rows_not_used += other.rows_not_used;
  rows_at_edges += other.rows_at_edges;
}

Eigen::Index row_halo(const RowSettings& settings, double rate) {
  const RowSettings own = at_rate(settings, rate);
  const Eigen::Index averaging = 1;
  const int step = thinning_step(own.signal, own.decimate, rate);
  const RowSettings thin = with_cutoff(thinned(own, step, 1 / rate), own.lowest_cutoff);
  const Eigen::Index needed =
      thinning_reach(step) + step * (signal_halo(thin.signal, rate / step) + averaging +
                                     Decimation(thin.decimate).half_width() + thin.rest_margin +
                                     thin.decimate + kDifferenceEdge);
  // A window is followed by more than its halo, or ends its segment: so the rows that the segment's
  // end takes are all in its last window.
  return std::max(needed, own.drop_edge);
}

Eigen::Index window_rows(const RowSettings& settings, Eigen::Index halo) {
  constexpr Eigen::Index kHalos = 8, kMostTimes = 8;  // the latter bounds the memory
  if (!settings.signal.quasi_static) return kWindowRows;
  const Eigen::Index times = divided_up(kHalos * halo, kWindowRows);
  return std::clamp<Eigen::Index>(times, 1, kMostTimes) * kWindowRows;
}

Eigen::Index expected_rows(std::span<const LogSurvey> logs, const PartFilter& wanted,
                           const RowSettings& settings) {
  Eigen::Index rows = 0;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts)
      if (wanted(part)) rows += static_cast<Eigen::Index>(part.n_rows) / settings.decimate;
  return rows;
}

RowBatch make_rows(const Window& window, const LogSurvey& log, Eigen::Index number_offset,
                   const RowSettings& settings, std::span<const Equation> equations) {
  const RowSettings own = at_rate(settings, 1 / window.period);
  const int step = thinning_step(own.signal, own.decimate, 1 / window.period);
  const RowSettings thin = thinned(own, step, window.period);
  std::optional<Window> slow;
  if (step > 1) slow = thinned(window, step);
  RowBatch batch = rows_of(slow ? *slow : window, log, number_offset, thin, equations);
  for (EquationBatch& equation : batch.equations)
    equation.counts.rows_at_edges = rows_at_edges(window, step * edge_rows(thin));
  return batch;
}

}  // namespace cablefit
