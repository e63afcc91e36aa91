#include "cablefit/refine/rig_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/refine/own_base.hpp"
#include "cablefit/refine/verdict/conclusion.hpp"
#include "cablefit/refine/wrong_gravity.hpp"
#include "cablefit/refine/wrong_radius.hpp"

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

/// The gaps of a joint before are those with the values of the rig file.
void take_before(const RefineResult& given, RefineResult& right) {
  if (!is_done(given) || !is_done(right)) return;
  right.rho_before = given.rho_before;
  for (GapStory RefineResult::*gap : {&RefineResult::torque, &RefineResult::simulation}) {
    if (!(given.*gap).known || !(right.*gap).known) continue;
    (right.*gap).train_before = (given.*gap).train_before;
    (right.*gap).test_before = (given.*gap).test_before;
    (right.*gap).test_before_ci = (given.*gap).test_before_ci;
  }
}

}  // namespace

std::vector<RigError> rig_errors_of(const RigErrorSearch& search) {
  std::vector<RigError> all;
  for (const auto find : kSearches)
    if (auto error = find(search)) all.push_back(*std::move(error));
  std::stable_sort(all.begin(), all.end(),
                   [](const RigError& a, const RigError& b) { return a.share > b.share; });
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

bool is_explained(const std::vector<RefineResult>& given, const std::vector<RefineResult>& right) {
  constexpr double kSame = 0.02;  // of the gap
  for (std::size_t k = 0; k < given.size(); ++k)
    if (is_done(given[k]) && !is_done(right[k])) return false;
  const auto n_effects = [](const std::vector<RefineResult>& joints) {
    std::size_t n = 0;
    for (const RefineResult& joint : joints) n += joint.effects.size();
    return n;
  };
  const bool is_simpler = n_effects(right) + 1 <= n_effects(given);
  const double before = excess(given, given, &RefineResult::rho_before);
  const double left = excess(given, given, &RefineResult::rho_after) + kSame * before;
  return excess(right, given, &RefineResult::rho_before) <= left ||
         (is_simpler && excess(right, given, &RefineResult::rho_after) <= left);
}

int listing_joint(const RigError& error, const std::vector<RefineResult>& given,
                  const std::vector<RefineResult>& right) {
  if (error.joint) return *error.joint;
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

void name_rig_error(const RigError& error, const std::vector<RefineResult>& given,
                    std::vector<RefineResult>& right) {
  NamedEffect effect;
  effect.instance = error.instance;
  effect.derived = error.given;
  effect.rivals = error.rivals;
  const int joint = listing_joint(error, given, right);
  effect.joint = joint + 1;
  const double before = test_excess(given, right), after = test_excess(right, given);
  effect.evidence.gain = before > 0 ? 1 - after / before : error.share;
  effect.evidence.p_value = error.chance;
  effect.evidence.inclusion = 1;
  RefineResult& own = right[static_cast<std::size_t>(joint)];
  const RefineResult& own_given = given[static_cast<std::size_t>(joint)];
  effect.evidence.rho_before = is_done(own_given) ? own_given.rho_before : own.rho_before;
  effect.evidence.rho_after = own.rho_before;
  if (own_given.torque.known && own.torque.known)
    effect.torque_rms = std::sqrt(std::max(
        0.0, std::pow(own_given.torque.test_before, 2) - std::pow(own.torque.test_before, 2)));
  for (std::size_t k = 0; k < right.size(); ++k) take_before(given[k], right[k]);
  own.reason = own.verdict == Verdict::none ? error.reason : error.reason + "; " + own.reason;
  if (!effect.rivals.empty()) own.next_experiment = effect.instance.effect->experiment;
  own.effects.insert(own.effects.begin(), std::move(effect));
  own.verdict = verdict_by_rivals(own);
}

}  // namespace cablefit
