#include "cablefit/refine/rig_errors/rig_error_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "cablefit/refine/rig_errors/rig_error.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMostValues = 3;
// Of the squared residual: a value that removes less is not the first of several that explain it.
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

std::vector<const WrongValue*> values_of(const Steps& steps, std::size_t n_steps) {
  std::vector<const WrongValue*> values;
  for (std::size_t k = 0; k < n_steps; ++k)
    for (const WrongValue& value : steps[k].error.values) values.push_back(&value);
  return values;
}

bool is_same(const WrongValue& one, const WrongValue& other) {
  for (std::size_t k = 0; k < one.instance.parameters.size(); ++k) {
    const Estimate &a = one.instance.parameters[k], &b = other.instance.parameters[k];
    if (std::isnan(b.sd)) continue;  // not determined
    if (!(std::abs(a.value - b.value) <= kSettledSd * b.sd)) return false;
  }
  return true;
}

bool are_same(const RigError& one, const RigError& other) {
  return std::equal(one.values.begin(), one.values.end(), other.values.begin(), is_same);
}

bool are_significant(const RigError& error, double significance) {
  return std::all_of(error.values.begin(), error.values.end(),
                     [&](const WrongValue& value) { return value.chance < significance; });
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
      if (!again || !are_significant(*again, refiner.options.significance)) return false;
      for (std::size_t k = 0; k < again->values.size(); ++k)
        again->values[k].joint = step.error.values[k].joint;
      any_moved = any_moved || !are_same(step.error, *again);
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
  for (WrongValue& value : last.error.values)
    value.joint = listing_joint(value, start.run.joints, last.right.run.joints);
  return steps;
}

/// Whether each value has a joint whose result can list it.
bool are_listed(const Steps& steps) {
  const std::vector<RefineResult>& joints = steps.back().right.run.joints;
  const auto values = values_of(steps, steps.size());
  return std::all_of(values.begin(), values.end(), [&](const WrongValue* value) {
    return joints[static_cast<std::size_t>(*value->joint)].not_refined.empty();
  });
}

struct Explanation {
  Steps steps;
  bool is_whole = false;  ///< the steps explain what the joints show
};

/// What the joints show after the first `n_accepted` steps, and whether more steps explain it.
class Shown {
 public:
  Shown(const Steps& steps, const Attempt& given, std::size_t n_accepted)
      : joints_((n_accepted == 0 ? given : steps[n_accepted - 1].right).run.joints),
        n_accepted_(values_of(steps, n_accepted).size()) {}
  /// `n_values`: with those of the accepted steps.
  bool may_be_explained(std::size_t n_values) const {
    return n_values <= kMostValues && may_explain(joints_, n_values - n_accepted_);
  }
  /// How many more than `n_values` may explain it.
  std::size_t n_most_beside(std::size_t n_values) const {
    std::size_t n = 0;
    while (may_be_explained(n_values + n + 1)) ++n;
    return n;
  }
  bool is_explained_by(const Steps& more) const {
    return !more.empty() && are_listed(more) &&
           is_explained(joints_, more.back().right.run.joints,
                        values_of(more, more.size()).size() - n_accepted_);
  }

 private:
  const std::vector<RefineResult>& joints_;
  std::size_t n_accepted_;  ///< values
};

/// The values of the error and one more of their kind, if so many may be the answer.
std::optional<RigError> next_of(const RigError& error, const RigErrorSearch& search) {
  if (!error.with_one_more || error.values.size() >= search.n_most) return {};
  return error.with_one_more(search);
}

/// Values by name, side and joint, those fitted together in one text. Which of them were right in a
/// run of refine before?
using Tried = std::set<std::vector<std::string>>;

std::string text_of(const RigError& error) {
  std::vector<std::string> names;
  for (const WrongValue& value : error.values)
    names.push_back(fmt::format("{} {} {}", value.name, to_string(value.instance.effect->site),
                                value.joint.value_or(-1)));
  std::sort(names.begin(), names.end());
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Whether the values of the steps and the error are new.
bool is_new(const Steps& steps, const RigError& error, Tried& tried) {
  std::vector<std::string> names{text_of(error)};
  for (const Step& step : steps) names.push_back(text_of(step.error));
  std::sort(names.begin(), names.end());
  return tried.insert(std::move(names)).second;
}

/// A search for more steps, so that right values explain what the joints show after the first
/// `n_accepted` ones.
struct StepSearch {
  const Attempt& given;  ///< with the rig file as it is
  std::size_t n_accepted;
  const Refiner& refiner;
  Tried& tried;
};

/// One more value; otherwise the steps and the one that removes most, if that is much.
Explanation explained_by_one(const Steps& steps, const std::vector<RigError>& errors,
                             const StepSearch& search) {
  const Attempt& start = steps.empty() ? search.given : steps.back().right;
  const Shown shown(steps, search.given, search.n_accepted);
  Steps first;
  for (const RigError& error : errors) {
    if (!is_new(steps, error, search.tried)) continue;
    Steps more = with_error(steps, start, error, search.refiner);
    if (shown.is_explained_by(more)) return {std::move(more), true};
    const bool is_large = error.values.size() == 1 && error.values.front().share > kFirstShare;
    if (first.empty() && !more.empty() && is_large) first = std::move(more);
  }
  if (first.empty()) return {steps};
  return {std::move(first)};
}

/// Errors beside the steps, and the search that found them.
struct Beside {
  std::vector<const WrongValue*> found;
  RigErrorSearch search;
  std::vector<RigError> errors;
};

Beside beside(const Steps& steps, const StepSearch& search) {
  const Attempt& start = steps.empty() ? search.given : steps.back().right;
  const Shown shown(steps, search.given, search.n_accepted);
  Beside all{values_of(steps, steps.size()), search.refiner.search(start, start.run.models), {}};
  all.search.found = all.found;
  all.search.n_most = shown.n_most_beside(all.found.size());
  if (all.search.n_most > 0) all.errors = rig_errors_of(all.search);
  return all;
}

/// Several values of one kind that are wrong together.
Explanation explained_by_several(const Steps& steps, const Beside& from, const StepSearch& search) {
  const Attempt& start = steps.empty() ? search.given : steps.back().right;
  const Shown shown(steps, search.given, search.n_accepted);
  for (const RigError& error : from.errors) {
    auto several = next_of(error, from.search);
    for (; several; several = next_of(*several, from.search)) {
      if (!is_new(steps, *several, search.tried)) continue;
      Steps more = with_error(steps, start, *several, search.refiner);
      if (shown.is_explained_by(more)) return {std::move(more), true};
    }
  }
  return {steps};
}

/// Whether the value that removes most is the only one of its kind. Further values of the kind
/// found before may only stand for it.
bool is_single_kind_first(const std::vector<RigError>& errors) {
  return !errors.empty() && !errors.front().with_one_more;
}

/// By the value that removes most, by several of one kind that are wrong together, or by the value
/// that removes most and others. Otherwise the steps and the single value that removes most.
/// `from`: beside the steps.
Explanation explanation(const Steps& steps, const Beside& from, const StepSearch& search) {
  Explanation one = explained_by_one(steps, from.errors, search);
  if (one.is_whole) return one;
  const auto several = [&] { return explained_by_several(steps, from, search); };
  if (one.steps.size() == steps.size()) return several();
  const Beside next = beside(one.steps, search);
  const auto longer = [&] { return explanation(one.steps, next, search); };
  const bool is_longer_first = is_single_kind_first(next.errors);
  Explanation whole = is_longer_first ? longer() : several();
  if (!whole.is_whole) whole = is_longer_first ? several() : longer();
  return whole.is_whole ? whole : one;
}

/// Warns at the joint that would list the value, where a joint has a remainder that nothing
/// explains.
void warn_of(const WrongValue& value, std::vector<RefineResult>& joints) {
  if (std::none_of(joints.begin(), joints.end(),
                   [](const RefineResult& r) { return r.unexplained.has_value(); }))
    return;
  joints[static_cast<std::size_t>(*value.joint)].warnings.push_back(fmt::format(
      "the rig file may be wrong in more than one value: {} ({} {}) alone removes "
      "{:.3g} % of the squared residual; measure radii and the direction of gravity "
      "again",
      value.name, to_string(value.instance.effect->site), *value.joint + 1, 1e2 * value.share));
}

/// The last run, with all values in its results.
JointRun named(const Attempt& given, Steps steps) {
  std::vector<WrongValue> values;
  for (Step& step : steps)
    for (WrongValue& value : step.error.values) values.push_back(std::move(value));
  JointRun last = std::move(steps.back().right.run);
  name_rig_errors(values, given.run.joints, last.joints);
  return last;
}

}  // namespace

JointRun without_rig_errors(std::span<const Model> models, const RefineLogs& logs,
                            const RefineOptions& options, const RefineOne& refine_one) {
  const Refiner refiner{options, refine_one};
  Attempt given{{models.begin(), models.end()}, logs, refiner.run(models, logs)};
  Steps steps;
  while ((steps.empty() ? given : steps.back().right).run.any_gap()) {
    Tried tried;
    const StepSearch search{given, steps.size(), refiner, tried};
    Explanation more = explanation(steps, beside(steps, search), search);
    if (!more.is_whole) {
      if (more.steps.size() > steps.size())
        warn_of(more.steps[steps.size()].error.values.front(),
                (steps.empty() ? given : steps.back().right).run.joints);
      break;
    }
    steps = std::move(more.steps);
  }
  return steps.empty() ? std::move(given.run) : named(given, std::move(steps));
}

}  // namespace cablefit
