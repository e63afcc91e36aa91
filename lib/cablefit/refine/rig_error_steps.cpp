#include "cablefit/refine/rig_error_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/refine/rig_error.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMostErrors = 3;
// Of the squared residual: an error that removes less is not the first of several that explain it.
constexpr double kFirstShare = 0.2;

struct Attempt {
  std::vector<Model> given;
  RefineLogs logs;  ///< with the rig of the models
  JointRun run;
};

/// One error after the other.
struct Step {
  RigError error;
  Attempt right;  ///< with the right values of this error and, as they were then, of those before
};
using Steps = std::vector<Step>;

struct Refiner {
  const RefineOptions& options;
  const RefineOne& refine_one;

  JointRun run(std::span<const Model> given, const RefineLogs& logs) const {
    return run_joints(given, logs, options, refine_one);
  }
  RigErrorSearch search(const Attempt& attempt, const std::vector<Model>& fitted) const {
    return {attempt.given, fitted, attempt.logs, options.significance, options.threads};
  }
};

bool is_same(const RigError& one, const RigError& other) {
  constexpr double kNearSd = 0.1;
  for (std::size_t k = 0; k < one.instance.parameters.size(); ++k) {
    const Estimate &a = one.instance.parameters[k], &b = other.instance.parameters[k];
    if (!(std::abs(a.value - b.value) <= kNearSd * b.sd)) return false;
  }
  return true;
}

/// Each value again, with the right values of the others: it was found beside wrong ones. False:
/// one is not determined so, or does not differ any more.
bool fit_together(Steps& steps, const Refiner& refiner) {
  constexpr int kRounds = 5;
  Attempt& last = steps.back().right;
  bool any_moved = true;
  for (int round = 0; round < kRounds && any_moved; ++round) {
    any_moved = false;
    for (Step& step : steps) {
      auto again = step.error.again(refiner.search(last, last.given));
      if (!again || !(again->chance < refiner.options.significance)) return false;
      again->joint = step.error.joint;
      any_moved = any_moved || !is_same(step.error, *again);
      last.given = again->models;
      last.logs = with_rig(std::move(last.logs), again->change);
      step.error = *std::move(again);
    }
  }
  return true;
}

/// Empty: the values are not right together.
Steps with_error(Steps steps, const Attempt& start, RigError error, const Refiner& refiner) {
  RefineLogs logs = with_rig(start.logs, error.change);
  std::vector<Model> given = error.models;
  steps.push_back({std::move(error), {std::move(given), std::move(logs), {}}});
  if (steps.size() > 1 && !fit_together(steps, refiner)) return {};
  Step& last = steps.back();
  last.right.run = refiner.run(last.right.given, last.right.logs);
  last.error.joint = listing_joint(last.error, start.run.joints, last.right.run.joints);
  return steps;
}

/// Whether each error has a joint whose result can list it.
bool are_listed(const Steps& steps) {
  const std::vector<RefineResult>& joints = steps.back().right.run.joints;
  return std::all_of(steps.begin(), steps.end(), [&](const Step& step) {
    return joints[static_cast<std::size_t>(*step.error.joint)].not_refined.empty();
  });
}

struct Explanation {
  Steps steps;
  bool is_whole = false;  ///< the steps explain what the joints show
};

/// The steps and more, so that right values explain what the joints show after the first
/// `n_accepted` of them. Each time the error that removes most is taken. Otherwise the steps and
/// the first of these. `given`: with the rig file as it is.
Explanation explanation(const Steps& steps, const Attempt& given, std::size_t n_accepted,
                        const Refiner& refiner) {
  const Attempt& start = steps.empty() ? given : steps.back().right;
  const JointRun& shown = n_accepted == 0 ? given.run : steps[n_accepted - 1].right.run;
  const std::size_t n_more = steps.size() + 1 - n_accepted;
  if (steps.size() == kMostErrors || !may_explain(shown.joints, n_more)) return {steps};
  std::vector<const RigError*> found;
  for (const Step& step : steps) found.push_back(&step.error);
  RigErrorSearch search = refiner.search(start, start.run.models);
  search.found = found;
  Steps first;
  for (RigError& error : rig_errors_of(search)) {
    const bool is_large = error.share > kFirstShare;
    Steps more = with_error(steps, start, std::move(error), refiner);
    if (more.empty()) continue;
    if (are_listed(more) && is_explained(shown.joints, more.back().right.run.joints, n_more))
      return {std::move(more), true};
    if (first.empty() && is_large) first = std::move(more);
  }
  if (first.empty()) return {steps};
  Explanation longer = explanation(first, given, n_accepted, refiner);
  return longer.is_whole ? longer : Explanation{std::move(first)};
}

/// Warns at the joint that would list the error, where a joint has a remainder that nothing
/// explains.
void warn_of(const RigError& error, std::vector<RefineResult>& joints) {
  if (std::none_of(joints.begin(), joints.end(),
                   [](const RefineResult& r) { return r.unexplained.has_value(); }))
    return;
  joints[static_cast<std::size_t>(*error.joint)].warnings.push_back(fmt::format(
      "the rig file may be wrong in more than one value: {} ({} {}) alone removes "
      "{:.3g} % of the squared residual; measure radii and the direction of gravity "
      "again",
      error.name, to_string(error.instance.effect->site), *error.joint + 1, 1e2 * error.share));
}

/// The last run, with all errors in its results.
JointRun named(const Attempt& given, Steps steps) {
  std::vector<RigError> errors;
  for (Step& step : steps) errors.push_back(std::move(step.error));
  JointRun last = std::move(steps.back().right.run);
  name_rig_errors(errors, given.run.joints, last.joints);
  return last;
}

}  // namespace

JointRun without_rig_errors(std::span<const Model> models, const RefineLogs& logs,
                            const RefineOptions& options, const RefineOne& refine_one) {
  const Refiner refiner{options, refine_one};
  Attempt given{{models.begin(), models.end()}, logs, refiner.run(models, logs)};
  Steps steps;
  while ((steps.empty() ? given : steps.back().right).run.any_gap()) {
    Explanation more = explanation(steps, given, steps.size(), refiner);
    if (!more.is_whole) {
      if (more.steps.size() > steps.size())
        warn_of(more.steps[steps.size()].error,
                (steps.empty() ? given : steps.back().right).run.joints);
      break;
    }
    steps = std::move(more.steps);
  }
  return steps.empty() ? std::move(given.run) : named(given, std::move(steps));
}

}  // namespace cablefit
