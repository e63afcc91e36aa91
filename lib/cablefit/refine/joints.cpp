#include "cablefit/refine/joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/held_cables.hpp"
#include "cablefit/refine/kept_joint.hpp"
#include "cablefit/refine/rig_error.hpp"
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

template <typename List>
void append(List& to, const List& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// Lists one behind the other, warnings with their joint.
void append_lists(const RefineResult& r, RefineResult& all) {
  append(all.where, r.where);
  append(all.effects, r.effects);
  append(all.kept, r.kept);
  append(all.ranking, r.ranking);
  append(all.not_separable, r.not_separable);
  append(all.remainders, r.remainders);
  append(all.steps, r.steps);
  append(all.shifts, r.shifts);
  append(all.figures, r.figures);
  for (const std::string& warning : r.warnings)
    all.warnings.push_back(fmt::format("joint {}: {}", r.joint_name, warning));
}

/// Root mean square over the joints for which `known`.
template <typename Known, typename Get>
double rms_over(const std::vector<RefineResult>& joints, Known known, Get get) {
  double squares = 0, n = 0;
  for (const RefineResult& r : joints)
    if (known(r)) {
      squares += get(r) * get(r);
      ++n;
    }
  return n > 0 ? std::sqrt(squares / n) : 0;
}

GapStory rms_gap(const std::vector<RefineResult>& joints, GapStory RefineResult::*gap) {
  GapStory all;
  const auto known = [gap](const RefineResult& r) { return (r.*gap).known; };
  all.known = std::any_of(joints.begin(), joints.end(), known);
  for (double GapStory::*value :
       {&GapStory::train_before, &GapStory::train_after, &GapStory::test_before,
        &GapStory::test_after, &GapStory::noise_floor})
    all.*value = rms_over(joints, known, [&](const RefineResult& r) { return r.*gap.*value; });
  for (auto interval : {&GapStory::test_before_ci, &GapStory::test_after_ci})
    for (std::size_t i = 0; i < 2; ++i)
      (all.*interval)[i] =
          rms_over(joints, known, [&](const RefineResult& r) { return (r.*gap.*interval)[i]; });
  return all;
}

void take_gaps(RefineResult& all) {
  const auto is_done = [](const RefineResult& r) { return r.not_refined.empty(); };
  for (double RefineResult::*value :
       {&RefineResult::remainder_link, &RefineResult::remainder_motor, &RefineResult::floor_link,
        &RefineResult::floor_motor, &RefineResult::remainder_blocked, &RefineResult::floor_blocked})
    all.*value = rms_over(all.joints, is_done, [&](const RefineResult& r) { return r.*value; });
  all.torque = rms_gap(all.joints, &RefineResult::torque);
  all.simulation = rms_gap(all.joints, &RefineResult::simulation);
  double before = 0, after = 0, n = 0;
  for (const RefineResult& r : all.joints)
    if (is_done(r)) {
      before += r.rho_before;
      after += r.rho_after;
      ++n;
    }
  all.rho_before = before / n;
  all.rho_after = after / n;
}

/// The joint that decides: one with an effect, then one with a gap that nothing explains.
Verdict verdict_of(const std::vector<RefineResult>& joints) {
  for (const Verdict verdict : {Verdict::ambiguous, Verdict::named, Verdict::unexplained})
    for (const RefineResult& r : joints)
      if (r.not_refined.empty() && r.verdict == verdict) return verdict;
  return Verdict::none;
}

/// "named on joints 2 and 4, none on joint 1".
std::string reasons_of(const std::vector<RefineResult>& joints) {
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;
  for (const RefineResult& r : joints) {
    const std::string word =
        r.not_refined.empty() ? std::string(to_string(r.verdict)) : "not refined";
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& other) { return other.first == word; });
    if (group == groups.end()) group = groups.insert(groups.end(), {word, {}});
    group->second.push_back(r.joint_name);
  }
  std::string text;
  for (const auto& [word, names] : groups)
    text += fmt::format("{}{} on joint{} {}", text.empty() ? "" : "; ", word,
                        names.size() > 1 ? "s" : "", fmt::join(names, ", "));
  return text;
}

/// Where the joint says so most: the largest squared gap, then the first.
const RefineResult& leading(const std::vector<RefineResult>& joints, Verdict verdict) {
  const RefineResult* best = nullptr;
  for (const RefineResult& r : joints) {
    const bool wanted = r.not_refined.empty() && r.verdict == verdict;
    if (wanted && (best == nullptr || r.rho_before > best->rho_before)) best = &r;
  }
  return best != nullptr ? *best : joints.front();
}

/// Of every preload the model with what each joint's fit says.
std::vector<Model> joined_models(std::span<const Model> models,
                                 const std::vector<RefineResult>& joints) {
  std::vector<Model> all;
  for (std::size_t m = 0; m < models.size(); ++m) {
    std::vector<Model> own;
    for (const RefineResult& r : joints)
      if (m < r.models.size()) own.push_back(r.models[m]);
    all.push_back(own.empty() ? models[m] : joined(own));
  }
  return all;
}

/// A page begins with one joint only.
void begin_with(int joint, std::vector<RefineResult>& joints) {
  for (RefineResult& r : joints)
    for (Figure& figure : r.figures)
      if (figure.rank == FigureRank::main && r.joint != joint) figure.rank = FigureRank::shown;
}

RefineResult merged(std::span<const Model> models, std::vector<RefineResult> joints) {
  RefineResult all;
  all.models = joined_models(models, joints);
  all.verdict = verdict_of(joints);
  begin_with(leading(joints, all.verdict).joint, joints);
  for (const RefineResult& r : joints) append_lists(r, all);
  all.joints = std::move(joints);
  all.reason = reasons_of(all.joints);
  const RefineResult& first = leading(all.joints, all.verdict);
  all.inputs = first.inputs;
  all.preloads = first.preloads;
  all.rig_path = first.rig_path;
  all.axes = models.front().rig.axes.all();
  all.rigid = first.rigid;
  all.held_out_blocks = first.held_out_blocks;
  all.elastic_only = first.elastic_only;
  all.unexplained = first.unexplained;
  all.next_experiment = first.next_experiment;
  all.next_run = first.next_run;
  const auto n = static_cast<double>(all.joints.size());
  for (const RefineResult& r : all.joints) {
    if (!r.not_refined.empty() || n * r.search_p >= all.search_p) continue;
    all.search_p = n * r.search_p;
    all.search_p_is_fitted = r.search_p_is_fitted;
    all.n_draws = r.n_draws;
  }
  take_gaps(all);
  return all;
}

/// Each joint from the same models.
struct JointRun {
  std::vector<Model> models;  ///< of all joints, with base fits
  std::vector<RefineResult> joints;
  std::optional<Error> error;  ///< of the first joint that could not be refined

  bool is_refined() const {
    return std::any_of(joints.begin(), joints.end(),
                       [](const RefineResult& r) { return r.not_refined.empty(); });
  }
  bool any_gap() const {
    return std::any_of(joints.begin(), joints.end(), [](const RefineResult& r) {
      return !r.not_refined.empty() || r.verdict != Verdict::none;
    });
  }
};

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

/// Again with the right value where one of the rig file is wrong, and that explains what the joints
/// show.
void try_rig_errors(std::span<const Model> given, const RefineLogs& logs,
                    const RefineOptions& options, const RefineOne& refine_one, JointRun& run) {
  const RigErrorSearch search{given, run.models, logs, options.significance, options.threads};
  for (const RigError& error : rig_errors_of(search)) {
    JointRun right = run_joints(error.models, with_rig(logs, error.change), options, refine_one);
    const int joint = listing_joint(error, run.joints, right.joints);
    const RefineResult& own = right.joints[static_cast<std::size_t>(joint)];
    if (!own.not_refined.empty() || !is_explained(run.joints, right.joints)) continue;
    name_rig_error(error, run.joints, right.joints);
    run = std::move(right);
    return;
  }
}

}  // namespace

RefineResult refine_joints(std::span<const Model> given, const RefineLogs& logs,
                           const RefineOptions& options, const RefineOne& refine_one) {
  RefineOptions own = options;
  own.significance /= static_cast<double>(given.front().joints.size());
  JointRun run = run_joints(given, logs, own, refine_one);
  if (run.any_gap()) try_rig_errors(given, logs, own, refine_one, run);
  if (!run.is_refined()) throw Error(*run.error);
  return merged(run.models, std::move(run.joints));
}

}  // namespace cablefit
