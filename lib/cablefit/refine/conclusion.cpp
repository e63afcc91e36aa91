#include "cablefit/refine/conclusion.hpp"

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

/// Of squared gaps on unseen logs. Where these show no gap in the first place, as when a drive
/// never saturates in them, nothing can shrink: it is enough that nothing grows beyond `as_good`.
bool is_better(double before, double after, double visible, double as_good) {
  return before > visible ? after < before : after < as_good * before;
}

constexpr double kLittle = 0.25;             // of the gap
constexpr double kLikely = 1;                // sd, that a gain on unseen rows is one
constexpr double kChanceOfSize = 0.01 / 40;  // 1 % over the rows of a search
constexpr double kSureSize = 1e-6;           // of which the training rows leave no doubt

/// Share of the gap: of the unseen rows' where these are sure of it, of the training rows' else.
double closed_by(const UnseenChange& change) {
  const bool is_sure = change.rho_before > kVisibleGap && change.sd_better >= kClearlyBetter;
  if (!change.is_after_event || !is_sure) return change.closed;
  const double gone = change.rho_before - change.rho_after;
  return std::max(change.closed, gone / (change.rho_before - 1));
}

/// Some date always fits a little of what wanders or hums, and on logs after it less than that.
bool is_stray_event(const UnseenChange& change) {
  return change.row.is_event && change.leaves_remainder && closed_by(change) < kLittle;
}

/// Little of a visible gap, most of which stays, and sure neither here nor there. Where most of it
/// goes a few blocks may carry that, and an sd over blocks tells nothing.
bool is_crumb(const UnseenChange& change) {
  const double gone = change.rho_before - change.rho_after;
  return change.leaves_remainder && change.rho_before > kVisibleGap &&
         gone < kLittle * (change.rho_before - 1) && change.sd_better < kLikely &&
         change.chance_of_size > kSureSize;
}

/// Beside a remainder the sum over all rows is that of the equation that has it; rows weighted by
/// what they leave have the say then.
bool fits_better(const UnseenChange& change) {
  if (is_better(change.rho_before, change.rho_after, kVisibleGap, kAsGoodRows)) return true;
  const bool as_good = change.rho_after < kAsGoodRows * change.rho_before;
  return change.leaves_remainder && as_good && change.sd_better > 0;
}

std::string in_words(double before, double after) {
  return fmt::format("{:.3g} times the squared floor before, {:.3g} after", before, after);
}

}  // namespace

std::string why_not_added(const UnseenChange& change) {
  const bool no_say = change.row.is_event && !change.is_after_event;
  if (!no_say && !fits_better(change))
    return fmt::format("the equations of unseen logs do not fit better with it ({})",
                       in_words(change.rho_before, change.rho_after));
  if (is_stray_event(change))
    return fmt::format("a date explains {:.2g} % of the gap only, and the rest stays unexplained",
                       100 * std::max(0.0, closed_by(change)));
  if (change.row.is_event) return "";
  if (is_crumb(change))
    return fmt::format(
        "beside what stays unexplained the equations of unseen logs are not clearly better with it "
        "({:.2g} sd)",
        change.sd_better);
  if (change.leaves_remainder && change.chance_of_size > kChanceOfSize)
    return fmt::format(
        "beside what stays unexplained a size like its own is not beyond chance (p = {:.1g} of one "
        "effect)",
        change.chance_of_size);
  if (!change.before.known() || !change.floor.known()) return "";
  if (!change.after.known()) return "with it the simulation fails: " + change.after.failure;
  const double floor = in_floors(change.floor, change.floor);
  const double before = in_floors(change.before, change.floor);
  const double after = in_floors(change.after, change.floor);
  if (!is_better(before, after, kVisibleSimulated * floor, kAsGoodSimulated))
    return fmt::format("unseen logs are not simulated better with it ({})",
                       in_words(before / floor, after / floor));
  return "";
}

std::string why_not_both(const UnseenChange& change) {
  if (change.row.is_event) return "one of two effects at once may not be an event";
  std::string reason = why_not_added(change);
  if (!reason.empty()) return reason;
  if (change.rho_after > kRemainder)
    return fmt::format(
        "two effects at once should leave nothing in the equations of unseen logs "
        "({})",
        in_words(change.rho_before, change.rho_after));
  if (!change.after.known() || !change.floor.known()) return "";
  const double floor = in_floors(change.floor, change.floor);
  const double after = in_floors(change.after, change.floor);
  if (after > kVisibleSimulated * floor)
    return fmt::format(
        "two effects at once should leave nothing in the simulation of unseen logs "
        "({})",
        in_words(in_floors(change.before, change.floor) / floor, after / floor));
  return "";
}

void conclude(RefineResult& result) {
  const double rho = result.rho_before;
  if (!result.effects.empty()) {
    const std::vector<Rival>& rivals = result.effects.front().rivals;
    result.verdict = rivals.empty() ? Verdict::named : Verdict::ambiguous;
    const double closed = (rho - result.rho_after) / std::max(1e-9, rho - 1);
    result.reason = fmt::format("it closes {:.0f} % of the squared gap above the noise floor",
                                100 * std::clamp(closed, 0.0, 1.0));
    if (result.rho_after > kRemainder) {
      result.reason += "; a remainder is unexplained";
      if (result.whitened)
        result.reason += ", which wanders: the effect was told from rows freed of that";
    }
    const auto other = std::find_if(rivals.begin(), rivals.end(),
                                    [](const Rival& rival) { return !rival.by_rule; });
    if (!rivals.empty())
      result.next_experiment = (other != rivals.end() ? *other : rivals.front()).experiment;
    return;
  }
  const bool refused = !result.steps.empty();
  const std::string level =
      fmt::format("the squared residual is {:.3g} times what the sensors' noise leaves", rho);
  // At the floor there is nothing to explain, whatever was tried and refused.
  if (rho < (refused ? kNoGap : kRemainder)) {
    result.verdict = Verdict::none;
    result.reason = level + (refused ? "; what fits best, " + result.steps.front().added +
                                           ", was refused: " + result.steps.front().reason
                                     : "; no effect of the catalogue improves on it beyond chance");
    return;
  }
  result.verdict = Verdict::unexplained;
  result.reason = level + (refused ? ", and what fits best, " + result.steps.front().added +
                                         ", was refused: " + result.steps.front().reason
                                   : ", and no effect of the catalogue explains it");
}

}  // namespace cablefit
