#include "cablefit/refine/joint_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/bases/kept_joint.hpp"
#include "cablefit/refine/held_cables.hpp"
#include "cablefit/refine/torque_gains.hpp"

namespace cablefit {
namespace {

/// Simulations of one joint move the others too: all of them with values that fit.
std::vector<Model> with_base_fits(std::span<const Model> given, const RefineLogs& logs) {
  std::vector<Model> models(given.begin(), given.end());
  for (int joint = 0; joint < static_cast<int>(given.front().joints.size()); ++joint) {
    try {
      const std::vector<Model> fitted = with_base_fit(one_joint(models, joint), logs);
      for (std::size_t m = 0; m < models.size(); ++m) models[m] = whole_of(fitted[m]);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_identifiable) throw;  // the joint says so in its turn
    }
  }
  return models;
}

std::string of_joint(const std::string& name, int joint) {
  return fmt::format("{}[{}]", name, joint);
}

/// "stribeck (motor 2)" of "stribeck (motor)".
std::string with_number(const std::string& effect, int joint) {
  if (!effect.ends_with(')')) return effect;
  return fmt::format("{} {})", effect.substr(0, effect.size() - 1), joint);
}

/// What the result of one joint says, as that of one among several.
void set_joint(RefineResult& r) {
  for (Regime& regime : r.where) regime.equation = of_joint(regime.equation, r.joint);
  for (EquationRemainder& e : r.remainders) e.equation = of_joint(e.equation, r.joint);
  for (NamedEffect& effect : r.effects) {
    effect.joint = r.joint;
    for (Rival& rival : effect.rivals) rival.joint = r.joint;
  }
  for (KeptEffect& kept : r.kept) kept.now.joint = r.joint;
  for (Rival& row : r.ranking) row.joint = r.joint;
  for (RefineStep& step : r.steps) step.joint = r.joint;
  for (ParameterShift& shift : r.shifts) shift.name = name_in_whole(r.models.front(), shift.name);
  if (r.unexplained) r.unexplained->equation = of_joint(r.unexplained->equation, r.joint);
  for (NotSeparable& group : r.not_separable) {
    for (std::string& effect : group.effects) effect = with_number(effect, r.joint);
    for (std::string& effect : group.still_together) effect = with_number(effect, r.joint);
  }
  for (Figure& figure : r.figures)
    figure.section = fmt::format("Joint {}: {}", r.joint_name, figure.section);
}

/// Holds cables where the training samples alone do not separate them.
RefineResult refined_joint(std::vector<Model> one, const RefineLogs& logs,
                           const RefineOptions& options, const RefineOne& refine_one) {
  try {
    return refine_one(one, logs, options);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_identifiable || !hold_cables(one)) throw;
  }
  return refine_one(one, logs, options);
}

}  // namespace

JointRun run_joints(std::span<const Model> given, const RefineLogs& logs,
                    const RefineOptions& options, const RefineOne& refine_one) {
  const std::vector<Model> own_given = without_shown_gains(given, logs);
  JointRun run{with_base_fits(own_given, logs), {}, {}};
  const std::vector<Model>& models = run.models;
  std::vector<Model> refined = models;  // with the cables of joints that have been refined
  RefineOptions own = options;
  const ComparedTorques torques = compared_torques(models, logs, own.significance);
  run.joints.resize(models.front().joints.size());
  for (const int joint : refining_order(models.front())) {
    RefineResult& r = run.joints[static_cast<std::size_t>(joint)];
    const std::string& name = models.front().rig.joints[static_cast<std::size_t>(joint)];
    if (options.progress)
      own.progress = [&](std::string_view what, double share) {
        options.progress(fmt::format("joint {}, {}", name, what), share);
      };
    try {
      const std::vector<Model>& begun = holds_cables(models.front(), joint) ? refined : models;
      r = refined_joint(start_of(joint, begun, torques), logs, own, refine_one);
      warn_of_held_cables(r);
      take_refined_cables(r.models, refined);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_identifiable) throw;
      if (!run.error) run.error = error;
      r.not_refined = error.what();
      KeptJoint kept = kept_joint(own_given, models, joint, logs);
      r.models = std::move(kept.models);
      r.warnings.push_back(fmt::format("not refined: {}; {}", r.not_refined, kept.source));
    }
    r.joint = joint + 1;
    r.joint_name = name;
  }
  for (RefineResult& r : run.joints) set_joint(r);
  if (run.is_refined()) name_torque_gains(logs, own.significance, run.joints);
  return run;
}

}  // namespace cablefit
