#include "cablefit/refine/joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/rig_errors/rig_error_steps.hpp"

namespace cablefit {
namespace {

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
double rms_of_joints(const std::vector<RefineResult>& joints, Known known, Get get) {
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
    all.*value = rms_of_joints(joints, known, [&](const RefineResult& r) { return r.*gap.*value; });
  for (auto interval : {&GapStory::test_before_ci, &GapStory::test_after_ci})
    for (std::size_t i = 0; i < 2; ++i)
      (all.*interval)[i] = rms_of_joints(
          joints, known, [&](const RefineResult& r) { return (r.*gap.*interval)[i]; });
  return all;
}

void take_gaps(RefineResult& all) {
  const auto is_done = [](const RefineResult& r) { return r.not_refined.empty(); };
  for (double RefineResult::*value :
       {&RefineResult::remainder_link, &RefineResult::remainder_motor, &RefineResult::floor_link,
        &RefineResult::floor_motor, &RefineResult::remainder_blocked, &RefineResult::floor_blocked})
    all.*value =
        rms_of_joints(all.joints, is_done, [&](const RefineResult& r) { return r.*value; });
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

std::string_view word_of(const RefineResult& r) {
  if (!r.not_refined.empty()) return "not refined";
  return r.verdict == Verdict::none ? "nothing missing" : to_string(r.verdict);
}

/// "named on joints 2, 4; nothing missing on joint 1".
std::string reasons_of(const std::vector<RefineResult>& joints) {
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;
  for (const RefineResult& r : joints) {
    const std::string word(word_of(r));
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

/// Not known where the joint could not be refined with the values of the rig file.
double gap_before(const RefineResult& r) {
  return std::isnan(r.rho_before) ? std::numeric_limits<double>::infinity() : r.rho_before;
}

/// Where the joint says so most: the largest squared gap, then the first.
const RefineResult& leading(const std::vector<RefineResult>& joints, Verdict verdict) {
  const RefineResult* best = nullptr;
  for (const RefineResult& r : joints) {
    const bool wanted = r.not_refined.empty() && r.verdict == verdict;
    if (wanted && (best == nullptr || gap_before(r) > gap_before(*best))) best = &r;
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

}  // namespace

RefineResult refine_joints(std::span<const Model> given, const RefineLogs& logs,
                           const RefineOptions& options, const RefineOne& refine_one) {
  RefineOptions own = options;
  own.significance /= static_cast<double>(given.front().joints.size());
  JointRun run = without_rig_errors(given, logs, own, refine_one);
  if (!run.is_refined()) throw Error(*run.error);
  return merged(run.models, std::move(run.joints));
}

}  // namespace cablefit
