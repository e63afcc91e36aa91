#include "cablefit/report/sections/refine_story.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "cablefit/refine/null/chance_tail.hpp"
#include "cablefit/refine/rows/regime_variables.hpp"
#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"
#include "cablefit/session/replayed_torque.hpp"

namespace cablefit {
namespace {

constexpr std::string_view kFrequency = "frequency";  // whose variable is Hz
constexpr std::size_t kPlaces = 2;                    // where the gap is, in the story
constexpr double kMovedSd = 2;

std::string percent_text(double share) {
  if (std::isnan(share)) return "an unknown share";
  return fmt::format("{:.0f} %", 100 * std::clamp(share, 0.0, 1.0));
}

/// Whether it says nothing new: the same kind of variable, or (theta, and theta - q of a blocked
/// link) the same stretch.
bool is_listed(const Regime& regime, const std::vector<Regime>& listed) {
  return std::any_of(listed.begin(), listed.end(), [&](const Regime& other) {
    constexpr double kSame = 1e-3;
    const double slack = kSame * (regime.to - regime.from);
    return other.regime == regime.regime ||
           (other.equation == regime.equation && std::abs(other.from - regime.from) < slack &&
            std::abs(other.to - regime.to) < slack);
  });
}

/// The places that stand out most, each by another kind of variable.
std::vector<SummaryLine> where_lines(const RefineResult& result) {
  std::vector<SummaryLine> lines;
  std::vector<Regime> listed;
  for (const Regime& r : result.where) {
    if (listed.size() == kPlaces) break;
    if (is_listed(r, listed)) continue;
    listed.push_back(r);
    lines.push_back(
        {lines.empty() ? "where" : "and",
         fmt::format("{} equation, {}: {} of its squared gap in {} of its {}; {} {} rms "
                     "there, noise floor {}",
                     r.equation, regime_text(r, result.axes), percent_text(r.share_of_squared_gap),
                     percent_text(r.share_of_rows), r.regime == kFrequency ? "band" : "rows",
                     short_number(r.rms), torque_unit(result.axes), short_number(r.noise))});
  }
  return lines;
}

SummaryLine verdict_line(const RefineResult& result) {
  std::string names;
  for (const NamedEffect& effect : result.effects)
    names += (names.empty() ? "" : ", ") + effect_text(effect, result);
  std::string text(to_string(result.verdict));
  if (result.verdict == Verdict::ambiguous) names += " or a similar effect";
  if (!names.empty()) text += ": " + names;
  return {"verdict", text + (names.empty() ? ": " : "; ") + result.reason};
}

std::string parameters_text(const NamedEffect& effect) {
  std::string text;
  for (const auto* some : {&effect.instance.parameters, &effect.derived})
    for (const Estimate& e : *some)
      text += fmt::format("{}{} = {}{}{}", text.empty() ? "" : ", ", e.name,
                          value_with_sd(e.value, e.sd), e.unit.empty() ? "" : " ", e.unit);
  return text;
}

/// Whether any of its coefficients stands out of its sd.
bool is_seen(const EffectInstance& instance) {
  const std::size_t n = instance.effect->n_linear();
  for (std::size_t p = 0; p < n; ++p) {
    const Estimate& e = instance.parameters[p];
    if (std::isfinite(e.sd) && std::abs(e.value) > kMovedSd * e.sd) return true;
  }
  return n == 0;
}

/// What the model has already: values as it says them, and in these logs.
SummaryLine kept_line(const KeptEffect& kept, const RefineResult& result) {
  std::string text;
  for (std::size_t p = 0; p < kept.given.size(); ++p) {
    const Estimate& e = kept.now.instance.parameters[p];
    text += fmt::format("{}{} {} -> {}{}{}", text.empty() ? "" : ", ", e.name,
                        value_text(kept.given[p].value, kept.given[p].sd),
                        value_with_sd(e.value, e.sd), e.unit.empty() ? "" : " ", e.unit);
  }
  if (!is_seen(kept.now.instance)) text += "; these logs do not show it";
  return {"kept", fmt::format("{}: {}", effect_text(kept.now, result), text)};
}

/// Where none of the draws came as far, p says of what: a fit, and no more than the draws support.
std::string chance_text(const RefineEvidence& e) {
  if (e.n_draws == 0)
    return fmt::format("p {} {:.1g} (test of what joints share)",
                       e.p_value < kLeastTestP ? "<" : "=", std::max(e.p_value, kLeastTestP));
  const double least = least_tail(e.n_draws);
  const bool is_least = e.is_fitted_tail && e.p_value <= least;
  return fmt::format("p {} {:.1g} ({} {} simulated data sets)", is_least ? "<" : "=",
                     std::max(e.p_value, least), e.is_fitted_tail ? "tail fitted to" : "counted in",
                     e.n_draws);
}

/// Whether it is in one log only, so that no other data can show it.
bool is_over(const NamedEffect& effect, bool held_out_blocks) {
  const EffectInstance& instance = effect.instance;
  return instance.effect->passes() || (instance.ends_with_log && !held_out_blocks);
}

SummaryLine evidence_line(const NamedEffect& effect, bool held_out_blocks) {
  const RefineEvidence& evidence = effect.evidence;
  const std::string of = evidence.is_beside_others
                             ? "residual on held-out data, the other values right"
                             : "gap above the noise floor on held-out data";
  std::string text =
      is_over(effect, held_out_blocks)
          ? "an event, judged on the log in which it happens"
          : fmt::format("removes {} of the squared {}", percent_text(evidence.gain), of);
  text += "; " + chance_text(evidence);
  if (std::isfinite(evidence.inclusion))
    text += fmt::format("; the best in {} of resamples", percent_text(evidence.inclusion));
  return {"evidence", text};
}

/// Whether it was not found by a search among simulated data sets, but from several joints.
bool is_of_joints(const NamedEffect& effect) { return effect.evidence.n_draws == 0; }

std::string rival_text(const Rival& rival, const NamedEffect& effect, const RefineResult& result) {
  const std::string name = effect_text(rival.name, rival.side, rival.joint, result);
  if (is_of_joints(effect) && !rival.by_rule) return name + " explains the logs as well";
  if (rival.by_rule) return name + " is the same in any log of the usual kind";
  return fmt::format("{} removes {}, {} sd less", name, percent_text(rival.gain),
                     significant(std::max(0.0, rival.difference), 2));
}

/// `is_first`: of its joint; further ones were chosen from another list of candidates.
SummaryLine rivals_line(const NamedEffect& effect, const RefineResult& result, bool is_first) {
  std::string text;
  for (const Rival& rival : effect.rivals)
    text += (text.empty() ? "" : "; ") + rival_text(rival, effect, result);
  if (!text.empty()) return {"rivals", text};
  if (is_of_joints(effect)) return {"rivals", "none"};
  const Effect& row = *effect.instance.effect;
  const std::vector<Rival>& ranking = result.ranking;
  const auto next = std::find_if(ranking.begin(), ranking.end(), [&](const Rival& r) {
    return r.refused.empty() && r.joint == effect.joint &&
           (r.name != row.name || r.side != to_string(row.site));
  });
  if (!is_first || next == ranking.end() || !(next->gain > 0)) return {"rivals", "none"};
  return {"rivals", fmt::format("none; the next best, {}, removes {} alone",
                                effect_text(next->name, next->side, next->joint, result),
                                percent_text(next->gain))};
}

std::string date_text(const EffectInstance& event, const RefineResult& result) {
  const std::string& path = result.inputs.at(event.event_log).path;
  if (event.event_time > 0)
    return fmt::format("at {} s of {}{}", short_number(event.event_time), path,
                       event.ends_with_log ? ", until that log ends" : "");
  return (event.ends_with_log ? "in all of " : "from the beginning of ") + path +
         (event.ends_with_log ? "" : " on");
}

Axes axes_of_joint(const RefineResult& result, int joint) {
  return result.joints.empty() ? result.axes
                               : result.joints.at(static_cast<std::size_t>(joint - 1)).axes;
}

void add_effect_lines(const RefineResult& result, std::vector<SummaryLine>& lines) {
  int last_joint = 0;
  for (const NamedEffect& effect : result.effects) {
    const Effect& row = *effect.instance.effect;
    const std::string name =
        result.joints.empty() ? std::string(row.name) : effect_text(effect, result);
    std::string text = fmt::format("{}: {}; {}", name, row.equation, parameters_text(effect));
    if (row.is_event) text += "; " + date_text(effect.instance, result);
    if (effect.torque_rms > 0)
      text += fmt::format("; carries {} {} rms", short_number(effect.torque_rms),
                          torque_unit(axes_of_joint(result, effect.joint)));
    lines.push_back({"effect", text});
    lines.push_back(evidence_line(effect, result.held_out_blocks));
    const bool is_first = effect.joint != std::exchange(last_joint, effect.joint);
    if (is_first || !effect.rivals.empty()) lines.push_back(rivals_line(effect, result, is_first));
  }
}

std::string interval_text(const std::array<double, 2>& ci) {
  return ci[1] > ci[0] ? fmt::format(" ({} .. {})", short_number(ci[0]), short_number(ci[1])) : "";
}

/// Not known before: where the joint could not be refined with the values of the rig file.
std::string before_after(double before, double after, bool changed) {
  if (!changed) return short_number(before);
  return (std::isnan(before) ? "not known" : short_number(before)) + " -> " + short_number(after);
}

SummaryLine gap_line(const RefineResult& result) {
  const GapStory& gap = result.torque;
  const bool changed = !result.effects.empty();
  return {
      "gap",
      fmt::format("torque, {} rms: train {}, test {}{}, noise floor {}", torque_unit(result.axes),
                  before_after(gap.train_before, gap.train_after, changed),
                  before_after(gap.test_before, gap.test_after, changed),
                  interval_text(gap.test_after_ci), short_number(gap.noise_floor)) +
          (result.held_out_blocks ? fmt::format("; test: the last third of every {} log",
                                                result.elastic_only ? "blocked" : "moving")
                                  : "")};
}

/// Why the simulation replays the torque of a log; nullptr in closed loop.
const Decision* replay_of(const RefineResult& result) {
  const auto found =
      std::find_if(result.decisions.begin(), result.decisions.end(),
                   [](const Decision& decision) { return decision.name == kReplayedTorque; });
  return found == result.decisions.end() ? nullptr : &*found;
}

/// What a replayed torque makes of the gap; nothing in closed loop.
std::string replay_text(const RefineResult& result) {
  const Decision* replay = replay_of(result);
  if (replay == nullptr) return "";
  return fmt::format(
      "; the torque of the log is replayed ({}): positions drift whatever the model, so judge by "
      "the torque gap",
      replay->reason);
}

SummaryLine simulation_line(const RefineResult& result) {
  const GapStory& gap = result.simulation;
  if (result.elastic_only) return {"simulation", "none: a blocked link does not move"};
  return {"simulation",
          fmt::format(
              "of the test logs, {} rms: {}{}, noise floor {}", unit_for(result.axes, "mrad"),
              before_after(1e3 * gap.test_before, 1e3 * gap.test_after, !result.effects.empty()),
              interval_text({1e3 * gap.test_after_ci[0], 1e3 * gap.test_after_ci[1]}),
              short_number(1e3 * gap.noise_floor)) +
              replay_text(result)};
}

SummaryLine remainder_line(const RefineResult& result) {
  const std::string unit = torque_unit(result.axes);
  std::string text;
  if (result.elastic_only)
    return {"remainder", fmt::format("blocked {} {} rms above the noise floor",
                                     short_number(result.remainder_blocked), unit)};
  if (!result.rigid) text = fmt::format("link {} {}, ", short_number(result.remainder_link), unit);
  return {"remainder", text + fmt::format("motor {} {} rms above the noise floor",
                                          short_number(result.remainder_motor), unit)};
}

std::string unexplained_text(const Unexplained& found, Axes axes) {
  const std::string size =
      fmt::format("{} {} rms above the noise floor", short_number(found.rms), torque_unit(axes));
  const std::string share = percent_text(found.share_of_squared_gap);
  if (found.kind == "mode")
    return fmt::format(
        "{} equation, {}: like a mode of {} Hz and damping ratio {}, {} {}, excited by "
        "the motion ({} of it)",
        found.equation, size, short_number(found.frequency), significant(found.damping, 2),
        significant(found.inertia, 2), unit_for(axes, "kg m^2"), share);
  if (found.kind == "hum")
    return fmt::format(
        "{} equation, {}: like a tone of {} Hz, independent of the motion ({} of it)",
        found.equation, size, short_number(found.frequency), share);
  return fmt::format(
      "{} equation, {}: low-frequency disturbance (correlation time {} s), no line, no mode",
      found.equation, size, significant(found.correlation_time, 2));
}

/// "[flexor]" where its only parameter is a value of this cable: a joint can have several.
std::string of_cable(const NamedEffect& effect) {
  const std::vector<Estimate>& parameters = effect.instance.parameters;
  if (parameters.size() != 1) return "";
  const std::string& name = parameters.front().name;
  const std::size_t open = name.find('[');
  return open == std::string::npos ? "" : name.substr(open);
}

bool shifts_any(const RefineResult& result) {
  return std::any_of(result.shifts.begin(), result.shifts.end(), is_shifted);
}

}  // namespace

std::string side_text(std::string_view side, int joint, const RefineResult& result) {
  return result.joints.empty() ? std::string(side) : fmt::format("{} {}", side, joint);
}

std::string effect_text(std::string_view name, std::string_view side, int joint,
                        const RefineResult& result) {
  return fmt::format("{} ({})", name, side_text(side, joint, result));
}

std::string effect_text(const NamedEffect& effect, const RefineResult& result) {
  const Effect& row = *effect.instance.effect;
  return effect_text(std::string(row.name) + of_cable(effect), to_string(row.site), effect.joint,
                     result);
}

std::string regime_text(const Regime& regime, Axes axes) {
  if (regime.regime == "direction")
    return fmt::format("{} = {}", regime.variable, regime.from < -0.5 ? -1 : 1);
  if (regime.regime == kFrequency)
    return fmt::format("from {} to {} Hz", short_number(regime.from), short_number(regime.to));
  const std::string unit = regime_unit(regime.regime, axes);
  return fmt::format("{} from {} to {}{}{}", regime.variable, short_number(regime.from),
                     short_number(regime.to), unit.empty() ? "" : " ", unit);
}

double moved_sd(const ParameterShift& shift) { return (shift.after - shift.before) / shift.sd; }

bool is_shifted(const ParameterShift& shift) {
  constexpr double kMovedShare = 0.02;  // where there is no sd
  const double moved = moved_sd(shift);
  if (std::isfinite(moved)) return std::abs(moved) > kMovedSd;
  return std::abs(shift.after - shift.before) > kMovedShare * std::abs(shift.before);
}

Headline refine_headline(const RefineResult& result) {
  constexpr std::array<std::pair<const char*, Tone>, 4> kWords{{{"identified effect", Tone::good},
                                                                {"nothing missing", Tone::good},
                                                                {"ambiguous", Tone::neutral},
                                                                {"unexplained", Tone::bad}}};
  Headline headline;
  std::tie(headline.word, headline.tone) = kWords.at(static_cast<std::size_t>(result.verdict));
  std::string names;
  for (const NamedEffect& effect : result.effects)
    names += (names.empty() ? "" : ", ") + effect_text(effect, result);
  headline.verdict = names.empty() ? result.reason : names + "; " + result.reason;
  const bool changed = !result.effects.empty();
  const std::string torque = torque_unit(result.axes);
  const auto numbers = [&](const GapStory& gap, double scale, const std::string& unit) {
    return fmt::format(
        "{} {}", before_after(scale * gap.test_before, scale * gap.test_after, changed), unit);
  };
  if (result.torque.known)
    headline.numbers = {{"torque gap on test data, rms", numbers(result.torque, 1, torque)}};
  if (result.simulation.known)
    headline.numbers.push_back({replay_of(result) != nullptr
                                    ? "simulation gap on test data (torque replayed), rms"
                                    : "simulation gap on test data, rms",
                                numbers(result.simulation, 1e3, unit_for(result.axes, "mrad"))});
  if (result.torque.known)
    headline.numbers.push_back(
        {"noise floor, torque",
         fmt::format("{} {}", short_number(result.torque.noise_floor), torque)});
  return headline;
}

std::vector<SummaryLine> refine_story(const RefineResult& result,
                                      const std::vector<std::string>& model_files) {
  std::vector<SummaryLine> lines = {verdict_line(result)};
  for (const KeptEffect& kept : result.kept) lines.push_back(kept_line(kept, result));
  add_effect_lines(result, lines);
  if (result.torque.known) lines.push_back(gap_line(result));
  if (result.simulation.known || result.elastic_only) lines.push_back(simulation_line(result));
  lines.push_back(remainder_line(result));
  if (result.unexplained)
    lines.push_back({"remainder", unexplained_text(*result.unexplained, result.axes)});
  if (result.verdict != Verdict::none)
    for (SummaryLine& line : where_lines(result)) lines.push_back(std::move(line));
  if (!result.effects.empty() && !shifts_any(result))
    lines.push_back({"shifts", fmt::format("no parameter moved by more than {:g} sd", kMovedSd)});
  if (!result.next_experiment.empty()) lines.push_back({"next run", result.next_experiment});
  if (!model_files.empty())
    lines.push_back({"model", fmt::format("{}", fmt::join(model_files, ", "))});
  return lines;
}

}  // namespace cablefit
