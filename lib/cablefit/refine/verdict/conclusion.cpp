#include "cablefit/refine/verdict/conclusion.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cablefit {
namespace {

// Squared simulated gap over floor that is seen: parameters from other logs leave a simulation more
// than sensors do.
constexpr double kVisibleSimulated = 1.5;
// Growth of an invisible gap that is no worsening: of sums over thousands of rows, and of
// simulations, whose gap is as much that of the parameters.
constexpr double kAsGoodRows = 1.02, kAsGoodSimulated = 1.1;

/// Of squared gaps on held-out data. Where these show no gap in the first place, as when a drive
/// never saturates in them, nothing can shrink: it is enough that nothing grows beyond `as_good`.
bool is_better(double before, double after, double visible, double as_good) {
  return before > visible ? after < before : after < as_good * before;
}

constexpr double kLittle = 0.25;  // of the gap
// Times the noise floor: a larger residual is reported, however small it is in N m.
constexpr double kLikeNoise = 2;
constexpr double kLikely = 1;                // sd, that a gain on held-out rows is one
constexpr double kChanceOfSize = 0.01 / 40;  // 1 % over the rows of a search
constexpr double kChanceOfNothing = 0.05;    // coefficients of about 2 sd
constexpr double kLeastGain = 0.03;          // of the squared floor: less is no find
constexpr double kSureSize = 1e-6;           // of which the training rows leave no doubt

/// Share of the gap: of the held-out rows' where these are sure of it, of the training rows' else.
double closed_by(const HeldOutChange& change) {
  const bool is_sure = change.rho_before > kVisibleGap && change.sd_better >= kClearlyBetter;
  if (!change.is_after_event || !is_sure) return change.closed;
  const double gone = change.rho_before - change.rho_after;
  return std::max(change.closed, gone / (change.rho_before - 1));
}

/// Some date always fits a little of a low-frequency disturbance or a tone, and less on later logs.
bool is_stray_event(const HeldOutChange& change) {
  return change.row.is_event && change.leaves_remainder && closed_by(change) < kLittle;
}

/// A small gain on a visible gap, most of which stays, and clear neither way. Where most of the gap
/// goes, a few blocks may contain it, and an sd over blocks has no meaning.
bool is_small_gain(const HeldOutChange& change) {
  const double gone = change.rho_before - change.rho_after;
  return change.leaves_remainder && change.rho_before > kVisibleGap &&
         gone < kLittle * (change.rho_before - 1) && change.sd_better < kLikely &&
         change.chance_of_size > kSureSize;
}

/// Beside a remainder the sum over all rows is that of the equation that has it; rows weighted by
/// their residual decide then.
bool fits_better(const HeldOutChange& change) {
  if (is_better(change.rho_before, change.rho_after, kVisibleGap, kAsGoodRows)) return true;
  const bool as_good = change.rho_after < kAsGoodRows * change.rho_before;
  return change.leaves_remainder && as_good && change.sd_better > 0;
}

std::string in_words(double before, double after) {
  return fmt::format("{:.3g} times the squared floor before, {:.3g} after", before, after);
}

}  // namespace

std::string why_not_added(const HeldOutChange& change) {
  const bool no_say = change.row.is_event && !change.is_after_event;
  if (!no_say && !fits_better(change))
    return fmt::format("the equations of {} do not fit better with it ({})", change.data,
                       in_words(change.rho_before, change.rho_after));
  if (is_stray_event(change))
    return fmt::format("an event explains only {:.2g} % of the gap, and the rest stays unexplained",
                       100 * std::max(0.0, closed_by(change)));
  if (change.row.is_event) return "";
  if (change.chance_of_size > kChanceOfNothing)
    return fmt::format("its coefficients are not significant (p = {:.2g})", change.chance_of_size);
  if (change.gone < kLeastGain)
    return fmt::format("it reduces the squared residual by only {:.2g} of the squared noise floor",
                       change.gone);
  if (is_small_gain(change))
    return fmt::format(
        "with the unexplained remainder, the equations of {} are not significantly "
        "better with it ({:.2g} sd)",
        change.data, change.sd_better);
  const bool is_most = change.closed >= kLeastClosed;  // then it is no stray of the remainder
  if (change.leaves_remainder && !is_most && change.chance_of_size > kChanceOfSize)
    return fmt::format(
        "with the unexplained remainder, its size is not significant (p = {:.1g} of "
        "one effect)",
        change.chance_of_size);
  return "";
}

std::string why_not_simulated(const SimulatedGap& before, const SimulatedGap& after,
                              const SimulatedGap& floor) {
  if (!before.known() || !floor.known() || !(before.tau > 0)) return "";
  if (!after.known()) return "with it the simulation fails: " + after.failure;
  const double unit = in_floors(floor, floor);
  const double from = in_floors(before, floor), to = in_floors(after, floor);
  if (!is_better(from, to, kVisibleSimulated * unit, kAsGoodSimulated))
    return fmt::format("the simulation is not better with it ({})",
                       in_words(from / unit, to / unit));
  return "";
}

std::string why_not_both(const HeldOutChange& change) {
  if (change.row.is_event) return "of two effects at once none may be an event";
  std::string reason = why_not_added(change);
  if (!reason.empty()) return reason;
  if (change.rho_after > kRemainder)
    return fmt::format("two effects at once must leave no residual in the equations of {} ({})",
                       change.data, in_words(change.rho_before, change.rho_after));
  return "";
}

namespace {

/// Says that the residual of every equation is too small to matter; empty: it is not.
std::string immaterial(const RefineResult& result) {
  const std::string unit = torque_unit(result.axes);
  std::string text;
  for (const EquationRemainder& e : result.remainders) {
    const bool is_seen = !result.material_given && e.above > kLikeNoise * e.noise;
    if (!(e.at_least < e.material) || is_seen) return "";
    const std::string surely =
        e.above < e.material ? "" : fmt::format(", lower 95 % bound {:.2g} {}", e.at_least, unit);
    text += fmt::format("{}{:.2g} {} of {:.2g} ({} equation{})", text.empty() ? "" : ", ", e.above,
                        unit, e.material, e.equation, surely);
  }
  return text.empty() ? ""
                      : "the residual beyond the sensors' noise is too small to matter: " + text;
}

/// Why held-out samples contradict a model that fits the training samples: an equation whose
/// residual matters; empty: none has one.
std::string contradiction_by_test(const RefineResult& result) {
  const bool of_logs = !result.held_out_blocks;
  for (const EquationRemainder& e : result.test_remainders)
    if (e.at_least >= e.material && (result.material_given || e.above > kLikeNoise * e.noise))
      return fmt::format(
          "the residual of {} is {:.3g} {} beyond the noise of {:.2g} ({} equation), and the {} "
          "show what is missing: {}",
          of_logs ? "the test logs" : "the last third of the logs", e.above,
          torque_unit(result.axes), e.noise, e.equation,
          of_logs ? "training logs do not" : "samples before it do not",
          of_logs ? "train with logs like these too" : "record longer, or train with more logs");
  return "";
}

/// `reason`: why nothing is missing in the training logs.
void conclude_none(const std::string& reason, RefineResult& result) {
  const std::string contradiction = contradiction_by_test(result);
  result.verdict = contradiction.empty() ? Verdict::none : Verdict::unexplained;
  result.reason = contradiction.empty() ? reason : contradiction;
}

}  // namespace

bool shows_gap(const Gaps& gaps) { return gaps.held_out_before > kVisibleGap && !gaps.has_event; }

double closed_share(const Gaps& gaps) {
  const bool shown = shows_gap(gaps);
  const double before = shown ? gaps.held_out_before : gaps.before;
  const double after = shown ? gaps.held_out_after : gaps.after;
  return (before - after) / std::max(1e-9, before - 1);
}

Verdict verdict_by_rivals(const RefineResult& result) {
  const bool is_open = std::any_of(result.effects.begin(), result.effects.end(),
                                   [](const NamedEffect& e) { return !e.rivals.empty(); });
  return is_open ? Verdict::ambiguous : Verdict::named;
}

void conclude(RefineResult& result) {
  const double rho = result.rho_before;
  if (!result.effects.empty()) {
    const std::vector<Rival>& rivals = result.effects.front().rivals;
    result.verdict = rivals.empty() ? Verdict::named : Verdict::ambiguous;
    const double closed = (rho - result.rho_after) / std::max(1e-9, rho - 1);
    result.reason = fmt::format("it closes {:.0f} % of the squared gap above the noise floor",
                                100 * std::clamp(closed, 0.0, 1.0));
    if (result.rho_after > kRemainder) result.reason += "; a remainder is unexplained";
    const auto other = std::find_if(rivals.begin(), rivals.end(),
                                    [](const Rival& rival) { return !rival.by_rule; });
    if (!rivals.empty())
      result.next_experiment = (other != rivals.end() ? *other : rivals.front()).experiment;
    return;
  }
  const bool refused = !result.steps.empty();
  const std::string level =
      fmt::format("the squared residual is {:.3g} times that of the sensors' noise", rho);
  // At the floor there is nothing to explain, whatever was tried and refused.
  if (rho < (refused ? kNoGap : kRemainder)) {
    conclude_none(level + (refused ? "; what fits best, " + result.steps.front().added +
                                         ", was refused: " + result.steps.front().reason
                                   : fmt::format("; no effect of the catalogue is both "
                                                 "significant and large enough (p = {:.2g})",
                                                 result.search_p)),
                  result);
    return;
  }
  const std::string nothing = immaterial(result);
  if (!nothing.empty()) {
    conclude_none(nothing, result);
    return;
  }
  result.verdict = Verdict::unexplained;
  result.reason = level + (refused ? ", and what fits best, " + result.steps.front().added +
                                         ", was refused: " + result.steps.front().reason
                                   : ", and no effect of the catalogue explains it");
}

}  // namespace cablefit
