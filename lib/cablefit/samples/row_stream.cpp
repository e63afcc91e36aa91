#include "cablefit/samples/row_stream.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

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

/// Quasi-static rows are decimated in two steps, the last of them by this at least. In between, at
/// that many times the final rate, columns are formed: powers of a deflection reach to higher
/// frequencies than the deflection does, and the torque's part up there must not be filtered away
/// alone (4 would move stiffnesses by 5e-5, 1 by 1e-3).
constexpr int kLastStep = 8;

/// Factor of the first of two decimations; 1 when there is one only.
int first_step(const RowSettings& settings) {
  if (!settings.signal.quasi_static) return 1;
  int step = std::max(1, settings.decimate / kLastStep);
  while (settings.decimate % step != 0) --step;
  return step;
}

/// The rows of a window that answer to an equation, and what became of the others.
struct ChosenRows {
  std::vector<Eigen::Index> centres;  ///< in window coordinates
  Eigen::Index first = 0, last = 0;   ///< those that can be trusted lie between these
  RowCounts counts;
};

ChosenRows choose_rows(const Equation& equation, const Signals& signals, const Window& window,
                       const RowSettings& settings) {
  const RowMask mask(equation, signals, settings);
  const Eigen::Index edge = std::max(settings.drop_edge, kDifferenceEdge);
  ChosenRows chosen;
  chosen.first = std::max<Eigen::Index>(0, edge - window.first);
  chosen.last = window.ends_segment ? signals.n_rows() - edge : signals.n_rows();
  RowCounts& counts = chosen.counts;
  for (Eigen::Index i = window.begin; i < window.end; ++i) {
    const Eigen::Index at = i - window.first;
    if (at < chosen.first || at >= chosen.last) {
      ++counts.rows_at_edges;
    } else if ((i - edge) % settings.decimate == 0) {
      if (!mask.used(at)) {
        ++counts.rows_not_used;
      } else if (mask.at_rest(at)) {
        ++counts.rows_at_rest;
      } else {
        chosen.centres.push_back(at);
      }
    }
  }
  counts.rows_used = chosen.centres.size();
  return chosen;
}

/// Signals at the given rows of the window, from rows [first, last) of it.
Signals decimated(const Signals& signals, std::span<const Eigen::Index> centres, Eigen::Index first,
                  Eigen::Index last, const Decimation& decimation) {
  Signals slow = signals;
  for (JointSignals& s : slow.joints) {
    std::vector<Eigen::ArrayXd*> arrays;
    for (Eigen::ArrayXd* array :
         {&s.q, &s.qd, &s.theta, &s.thetad, &s.tau, &s.tau_load, &s.approach, &s.theta_direction})
      if (array->size() > 0) arrays.push_back(array);
    Eigen::MatrixXd columns(signals.n_rows(), static_cast<Eigen::Index>(arrays.size()));
    for (std::size_t k = 0; k < arrays.size(); ++k)
      columns.col(static_cast<Eigen::Index>(k)) = *arrays[k];
    columns = decimation.apply(columns, centres, first, last, {});
    for (std::size_t k = 0; k < arrays.size(); ++k)
      *arrays[k] = columns.col(static_cast<Eigen::Index>(k));
  }
  return slow;
}

Eigen::MatrixXd columns_of(const Equation& equation, const Signals& signals) {
  Eigen::MatrixXd columns(signals.n_rows(), static_cast<Eigen::Index>(equation.columns.size()));
  equation.fill(signals, columns);
  return columns;
}

/// In one go: columns at the full rate, then every column decimated.
Eigen::MatrixXd rows_at_once(const Equation& equation, const Signals& signals,
                             const ChosenRows& chosen, const RowSettings& settings) {
  return Decimation(settings.decimate)
      .apply(columns_of(equation, signals), chosen.centres, chosen.first, chosen.last,
             equation.averaged);
}

/// In two: signals that the low-pass has made slow are decimated to some times the final rate,
/// where they still are what they were; then columns are formed and decimated for the rest, all
/// alike.
Eigen::MatrixXd rows_in_two_steps(const Equation& equation, const Signals& signals,
                                  const ChosenRows& chosen, const RowSettings& settings) {
  if (chosen.centres.empty()) return rows_at_once(equation, signals, chosen, settings);
  const int step = first_step(settings);
  // A grid that the centres are on.
  const Eigen::Index begin =
      chosen.centres.front() - (chosen.centres.front() - chosen.first) / step * step;
  std::vector<Eigen::Index> grid, centres;
  for (Eigen::Index at = begin; at < chosen.last; at += step) grid.push_back(at);
  for (const Eigen::Index at : chosen.centres) centres.push_back((at - begin) / step);
  const Signals slow = decimated(signals, grid, chosen.first, chosen.last, Decimation(step));
  return Decimation(settings.decimate / step)
      .apply(columns_of(equation, slow), centres, 0, static_cast<Eigen::Index>(grid.size()),
             equation.averaged);
}

EquationBatch equation_rows(const Equation& equation, const Signals& signals, const Window& window,
                            const RowSettings& settings, Eigen::Index offset) {
  const ChosenRows chosen = choose_rows(equation, signals, window, settings);
  EquationBatch batch;
  batch.counts = chosen.counts;
  batch.rows = first_step(settings) > 1 ? rows_in_two_steps(equation, signals, chosen, settings)
                                        : rows_at_once(equation, signals, chosen, settings);
  for (const Eigen::Index at : chosen.centres) {
    batch.numbers.push_back(offset + (window.rows_before + window.first + at) / settings.decimate);
    batch.t.push_back(window.t0 + static_cast<double>(window.first + at) * window.period);
  }
  return batch;
}

}  // namespace

void RowCounts::operator+=(const RowCounts& other) {
  rows_used += other.rows_used;
  rows_at_rest += other.rows_at_rest;
  rows_not_used += other.rows_not_used;
  rows_at_edges += other.rows_at_edges;
}

Eigen::Index row_halo(const RowSettings& settings, double rate) {
  const Eigen::Index averaging = 1;
  const Eigen::Index needed =
      signal_halo(settings.signal, rate) + Decimation(settings.decimate).half_width() + averaging +
      Decimation(first_step(settings)).half_width() + settings.rest_margin + settings.decimate;
  // A window is followed by more than its halo, or ends its segment: so the rows that the segment's
  // end takes are all in its last window.
  return std::max(needed, settings.drop_edge);
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
  RowBatch batch;
  batch.part = window.part;
  // Equations of one cut-off share their signals.
  std::map<double, Signals> signals;
  for (const Equation& equation : equations) {
    SignalSettings own = settings.signal;
    if (equation.cutoff > 0) own.cutoff = equation.cutoff;
    auto found = signals.find(own.cutoff);
    if (found == signals.end())
      found = signals.emplace(own.cutoff, make_signals(window, log.plan, own)).first;
    std::optional<Signals> prepared;
    if (equation.prepare) equation.prepare(prepared.emplace(found->second));
    batch.equations.push_back(equation_rows(equation, prepared ? *prepared : found->second, window,
                                            settings, number_offset));
  }
  return batch;
}

}  // namespace cablefit
