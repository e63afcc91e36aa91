#include "cablefit/refine/named_radius.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/refine/verdict/conclusion.hpp"

namespace cablefit {
namespace {

const Effect& row_of(const Pulley& pulley) {
  const std::span<const Effect> rows = rig_errors();
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const Effect& row) { return row.site == site_of(pulley.side); });
}

/// "radius[flexor]".
std::string with_cable(std::string_view name, const Pulley& pulley, const Model& model) {
  return fmt::format("{}[{}]", name, model.transmission.cables[pulley.cable].name);
}

EffectInstance instance_of(const WrongRadius& wrong, const Model& model) {
  const Effect& row = row_of(wrong.pulley);
  EffectInstance instance{&row, {}};
  Estimate& e = instance.parameters.emplace_back();
  e.name = e.symbol = with_cable(row.parameters.front().name, wrong.pulley, model);
  e.unit = row.parameters.front().unit;
  e.value = wrong.radius;
  e.sd = wrong.sd;
  set_interval(e, wrong.dof);
  return instance;
}

/// The radius in the rig file, beside that which was found.
Estimate given_radius(const WrongRadius& wrong, const Model& model) {
  Estimate e;
  e.name = e.symbol = with_cable("given", wrong.pulley, model);
  e.unit = row_of(wrong.pulley).parameters.front().unit;
  e.value = wrong.given;
  return e;
}

std::vector<Rival> rivals_of(const WrongRadius& wrong, const Model& model) {
  std::vector<Rival> rivals;
  for (const Pulley& pulley : wrong.rivals) {
    const Effect& row = row_of(pulley);
    Rival& rival = rivals.emplace_back();
    rival.name = with_cable(row.name, pulley, model);
    rival.side = to_string(row.site);
    rival.gain = wrong.share;
    rival.experiment = row.experiment;
    rival.joint = pulley.joint + 1;
  }
  return rivals;
}

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

/// The gaps of a joint before are those with the radius of the rig file.
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

void name_radius(const WrongRadius& wrong, const Model& model,
                 const std::vector<RefineResult>& given, std::vector<RefineResult>& right) {
  NamedEffect effect;
  effect.instance = instance_of(wrong, model);
  effect.derived = {given_radius(wrong, model)};
  effect.rivals = rivals_of(wrong, model);
  effect.joint = wrong.pulley.joint + 1;
  const double before = test_excess(given, right), after = test_excess(right, given);
  effect.evidence.gain = before > 0 ? 1 - after / before : wrong.share;
  effect.evidence.p_value = wrong.chance;
  effect.evidence.inclusion = 1;
  RefineResult& own = right[static_cast<std::size_t>(wrong.pulley.joint)];
  const RefineResult& own_given = given[static_cast<std::size_t>(wrong.pulley.joint)];
  effect.evidence.rho_before = is_done(own_given) ? own_given.rho_before : own.rho_before;
  effect.evidence.rho_after = own.rho_before;
  if (own_given.torque.known && own.torque.known)
    effect.torque_rms = std::sqrt(std::max(
        0.0, std::pow(own_given.torque.test_before, 2) - std::pow(own.torque.test_before, 2)));
  for (std::size_t k = 0; k < right.size(); ++k) take_before(given[k], right[k]);
  const std::string reason = fmt::format(
      "the {} radius of cable '{}' is {:.4g} mm by the motion of the joints (sd {:.1g} um), "
      "{:.4g} mm in the rig file",
      to_string(wrong.pulley.side), model.transmission.cables[wrong.pulley.cable].name,
      1e3 * wrong.radius, 1e6 * wrong.sd, 1e3 * wrong.given);
  own.reason = own.verdict == Verdict::none ? reason : reason + "; " + own.reason;
  if (!effect.rivals.empty()) own.next_experiment = effect.instance.effect->experiment;
  own.effects.insert(own.effects.begin(), std::move(effect));
  own.verdict = verdict_by_rivals(own);
}

}  // namespace cablefit
