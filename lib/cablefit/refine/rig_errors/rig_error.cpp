#include "cablefit/refine/rig_errors/rig_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/refine/bases/own_base.hpp"
#include "cablefit/refine/rig_errors/wrong_gravity.hpp"
#include "cablefit/refine/rig_errors/wrong_radius.hpp"
#include "cablefit/refine/verdict/conclusion.hpp"

namespace cablefit {
namespace {

constexpr std::optional<RigError> (*kSearches[])(const RigErrorSearch&) = {wrong_radius,
                                                                           wrong_gravity};

bool is_done(const RefineResult& joint) { return joint.not_refined.empty(); }

/// What is above the floor, over the joints that `given` has results of.
double excess(const std::vector<RefineResult>& of, const std::vector<RefineResult>& given,
              double RefineResult::*rho) {
  double sum = 0;
  for (std::size_t k = 0; k < of.size(); ++k)
    if (is_done(given[k])) sum += std::max(0.0, of[k].*rho - 1);
  return sum;
}

/// Squared gap on test rows above the noise, over the joints that both have; before any effect.
double test_excess(const std::vector<RefineResult>& of, const std::vector<RefineResult>& others) {
  double sum = 0;
  for (std::size_t k = 0; k < of.size(); ++k) {
    const GapStory& gap = of[k].torque;
    if (!gap.known || !others[k].torque.known) continue;
    sum += std::max(0.0, std::pow(gap.test_before / gap.noise_floor, 2) - 1);
  }
  return sum;
}

std::size_t n_effects(const std::vector<RefineResult>& joints) {
  std::size_t n = 0;
  for (const RefineResult& joint : joints) n += joint.effects.size();
  return n;
}

/// What the right values change and leave, larger than the noise: something else is missing, or the
/// value takes the place of others that are wrong.
bool leaves_unexplained(const std::vector<RefineResult>& given,
                        const std::vector<RefineResult>& right) {
  constexpr double kChanged = 0.02, kTwiceTheNoise = 2;
  for (std::size_t k = 0; k < given.size(); ++k)
    if (is_done(given[k]) && right[k].rho_after > kTwiceTheNoise &&
        std::abs(right[k].rho_before - given[k].rho_before) > kChanged * given[k].rho_before)
      return true;
  return false;
}

/// The gap of joints that could be refined with the given values.
struct Left {
  double same = 0;   ///< what counts as no gap
  double given = 0;  ///< after the effects that were found with the given values

  explicit Left(const std::vector<RefineResult>& results)
      : same(kSame * excess(results, results, &RefineResult::rho_before)),
        given(excess(results, results, &RefineResult::rho_after)) {}
  bool is_none() const { return given <= 2 * same; }

 private:
  static constexpr double kSame = 0.02;
};

bool is_rival(const WrongValue& value, const Rival& rival) {
  return value.name == rival.name && to_string(value.instance.effect->site) == rival.side &&
         *value.joint + 1 == rival.joint;
}

/// `is_only`: no other value is wrong, so that the results of refine show what this one does.
NamedEffect named_effect(const WrongValue& value, bool is_only,
                         const std::vector<RefineResult>& given,
                         const std::vector<RefineResult>& right) {
  NamedEffect effect;
  effect.instance = value.instance;
  effect.derived = value.given;
  effect.rivals = value.rivals;
  const auto joint = static_cast<std::size_t>(*value.joint);
  effect.joint = static_cast<int>(joint) + 1;
  const double before = test_excess(given, right), after = test_excess(right, given);
  effect.evidence.gain = is_only && before > 0 ? 1 - after / before : value.share;
  effect.evidence.p_value = value.chance;
  effect.evidence.inclusion = kNotKnown;
  effect.evidence.is_beside_others = !is_only;
  const RefineResult &own_given = given[joint], &own = right[joint];
  effect.evidence.rho_before = is_done(own_given) ? own_given.rho_before : kNotKnown;
  effect.evidence.rho_after = own.rho_before;
  if (is_only && own_given.torque.known && own.torque.known)
    effect.torque_rms = std::sqrt(std::max(
        0.0, std::pow(own_given.torque.test_before, 2) - std::pow(own.torque.test_before, 2)));
  return effect;
}

/// The gaps of a joint before are those with the values of the rig file. Not known where the joint
/// could not be refined with these.
void take_before(const RefineResult& given, RefineResult& right) {
  if (!is_done(right)) return;
  right.rho_before = is_done(given) ? given.rho_before : kNotKnown;
  for (GapStory RefineResult::*gap : {&RefineResult::torque, &RefineResult::simulation}) {
    const bool is_known = is_done(given) && (given.*gap).known;
    (right.*gap).train_before = is_known ? (given.*gap).train_before : kNotKnown;
    (right.*gap).test_before = is_known ? (given.*gap).test_before : kNotKnown;
    (right.*gap).test_before_ci =
        is_known ? (given.*gap).test_before_ci : std::array{kNotKnown, kNotKnown};
  }
}

}  // namespace

std::vector<RigError> rig_errors_of(const RigErrorSearch& search) {
  std::vector<RigError> all;
  for (const auto find : kSearches)
    if (auto error = find(search)) all.push_back(*std::move(error));
  std::stable_sort(all.begin(), all.end(), [](const RigError& a, const RigError& b) {
    return a.values.front().share > b.values.front().share;
  });
  return all;
}

const Effect& rig_error_row(std::string_view name, Site site) {
  const std::span<const Effect> rows = rig_errors();
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const Effect& row) { return row.name == name && row.site == site; });
}

RefineLogs with_rig(RefineLogs logs, const std::function<void(Rig&)>& change) {
  for (auto* some : {&logs.blocked, &logs.train, &logs.test})
    for (LogSurvey& log : *some) change(log.plan.rig);
  return logs;
}

bool take_arm(const RefineLogs& logs, int threads, std::vector<Model>& models) {
  try {
    for (const Model& started : own_base(logs, threads).models)
      for (Model& model : models)
        if (model.preload == started.preload) model.arm = started.arm;
    return true;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_identifiable) throw;
    return false;
  }
}

bool RigErrorSearch::has(std::string_view name, Site site, std::optional<int> joint) const {
  return std::any_of(found.begin(), found.end(), [&](const WrongValue* value) {
    return value->name == name && value->instance.effect->site == site &&
           (!joint || value->joint == joint);
  });
}

bool may_explain(const std::vector<RefineResult>& given, std::size_t n_values) {
  return n_values == 1 || n_values <= n_effects(given) || !Left(given).is_none() ||
         !std::all_of(given.begin(), given.end(), is_done);
}

bool is_explained(const std::vector<RefineResult>& given, const std::vector<RefineResult>& right,
                  std::size_t n_values) {
  bool any_opened = false;
  for (std::size_t k = 0; k < given.size(); ++k) {
    if (is_done(given[k]) && !is_done(right[k])) return false;
    if (is_done(given[k]) || !is_done(right[k])) continue;
    if (right[k].verdict == Verdict::unexplained) return false;
    any_opened = true;
  }
  if (leaves_unexplained(given, right)) return false;
  const Left shown(given);
  const double left = excess(right, given, &RefineResult::rho_after);
  // With the given values a joint could not even be refined.
  if (any_opened) return left <= shown.given + shown.same;
  if (n_effects(right) + n_values <= n_effects(given) && left <= shown.given + shown.same)
    return true;
  if (n_values == 1)
    return excess(right, given, &RefineResult::rho_before) <= shown.given + shown.same;
  // Several right values fit more: they count where effects alone leave a gap and these do not.
  return left <= shown.same && !shown.is_none() && n_effects(right) <= n_effects(given);
}

int listing_joint(const WrongValue& value, const std::vector<RefineResult>& given,
                  const std::vector<RefineResult>& right) {
  if (value.joint) return *value.joint;
  int most = 0;
  double largest = 0;
  for (std::size_t k = 0; k < given.size(); ++k) {
    if (!is_done(right[k])) continue;
    const double fall = is_done(given[k]) ? given[k].rho_before - right[k].rho_before : 0;
    if (!(fall > largest)) continue;
    largest = fall;
    most = static_cast<int>(k);
  }
  return most;
}

void name_rig_errors(const std::vector<WrongValue>& values, const std::vector<RefineResult>& given,
                     std::vector<RefineResult>& right) {
  std::vector<NamedEffect> effects;
  for (const WrongValue& value : values) {
    effects.push_back(named_effect(value, values.size() == 1, given, right));
    std::erase_if(effects.back().rivals, [&](const Rival& rival) {
      return std::any_of(values.begin(), values.end(),
                         [&](const WrongValue& other) { return is_rival(other, rival); });
    });
  }
  for (std::size_t k = 0; k < right.size(); ++k) take_before(given[k], right[k]);
  for (std::size_t k = values.size(); k-- > 0;) {
    RefineResult& own = right[static_cast<std::size_t>(effects[k].joint - 1)];
    const std::string& reason = values[k].reason;
    own.reason = own.verdict == Verdict::none ? reason : reason + "; " + own.reason;
    if (!effects[k].rivals.empty()) own.next_experiment = effects[k].instance.effect->experiment;
    own.effects.insert(own.effects.begin(), std::move(effects[k]));
    own.verdict = verdict_by_rivals(own);
  }
}

}  // namespace cablefit
