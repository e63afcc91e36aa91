#include "cablefit/samples/rows/agreement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "cablefit/samples/plan/rig_files.hpp"

namespace cablefit {
namespace {

/// The load is known without the law of a rig file. A blocked link feels none.
bool has_own_load(const LogPlan& plan, Phase phase) {
  const LoadLaw* law = plan.rig.load.law;
  if (law != nullptr) return law->from_column;
  return phase == Phase::blocked || plan.has_for_all(Channel::tau_load);
}

void require_same_rig(const LogPart& first, const LogPart& part, const std::string& preload) {
  if (is_same_bench(first, part)) return;
  const auto name = [](const Rig& rig) { return rig.path.empty() ? "no rig file" : rig.path; };
  const std::string key = compare_rig_files(first.plan->rig, part.plan->rig).key;
  throw input_error(
      {part.plan->path, 0, 0},
      fmt::format("preload '{:.40}' has logs of two rigs, {} and {}{}", preload,
                  name(first.plan->rig), name(part.plan->rig),
                  key.empty() ? "" : fmt::format(", which differ in \"{}\"", key)),
      "give them one rig file, or files that differ in \"load\" alone, each with its load (none: "
      "{\"type\": \"none\"}); or fit them separately");
}

/// "q2, theta2, tau2" of a log that is read as one of one joint.
std::string second_joint(const LogPlan& plan) {
  std::string names;
  if (plan.rig.n_joints() > 1 || plan.rig.columns.contains("tau")) return names;
  for (std::size_t k = 0; k < plan.header.columns.size(); ++k) {
    const std::string& name = plan.header.columns[k].name;
    const bool is_read = std::any_of(plan.slots.begin(), plan.slots.end(),
                                     [&](const Slot& slot) { return slot.column == k; });
    const bool is_second = std::any_of(kChannels.begin(), kChannels.end(), [&](Channel channel) {
      return name == fmt::format("{}2", channel_name(channel));
    });
    if (is_second && !is_read) names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

std::vector<std::string> unread_joints(std::span<const LogSurvey> logs) {
  std::vector<std::string> warnings;
  for (const LogSurvey& log : logs)
    if (const std::string names = second_joint(log.plan); !names.empty())
      warnings.push_back(
          fmt::format("{}: columns {} are not used: the log is read as that of one joint; name the "
                      "joints in a rig file",
                      log.plan.path, names));
  return warnings;
}

}  // namespace

bool is_same_bench(const LogPart& a, const LogPart& b) {
  const RigDifference difference = compare_rig_files(a.plan->rig, b.plan->rig).difference;
  if (difference == RigDifference::none) return true;
  return difference == RigDifference::load && has_own_load(*a.plan, a.phase) &&
         has_own_load(*b.plan, b.phase);
}

RateRange sample_rates(std::span<const LogSurvey> logs, const PartFilter& wanted) {
  RateRange rates{kUnbounded, 0};
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts) {
      if (!wanted(part)) continue;
      rates.lowest = std::min(rates.lowest, 1 / part.period);
      rates.highest = std::max(rates.highest, 1 / part.period);
    }
  return rates;
}

void require_agreement(std::span<const LogSurvey> logs, const PartFilter& wanted,
                       const std::string& preload) {
  // Of each phase the first: a blocked log needs no load, beside which a moving one may lack it.
  std::map<Phase, LogPart> firsts;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts) {
      if (!wanted(part)) continue;
      const LogPart own{&log.plan, part.phase};
      firsts.try_emplace(part.phase, own);
      for (const auto& [phase, first] : firsts) require_same_rig(first, own, preload);
      const Load& load = log.plan.rig.load;
      if (part.phase == Phase::moving && load.law != nullptr && load.law->from_column)
        require_channel(log.plan, Channel::tau_load, "the load that the rig file says is a column");
    }
}

std::vector<std::string> unloaded_warnings(std::span<const LogSurvey> logs,
                                           const PartFilter& wanted) {
  std::vector<std::string> names;  // of the missing columns
  std::string first;
  int more = -1;
  for (const LogSurvey& log : logs) {
    const int n = log.plan.rig.n_joints();
    if (log.plan.rig.load.law != nullptr ||
        std::none_of(log.parts.begin(), log.parts.end(), wanted))
      continue;
    bool any = false;
    for (int joint = 0; joint < n; ++joint) {
      if (log.plan.has(Channel::tau_load, joint)) continue;
      any = true;
      std::string name = "tau_load" + (n > 1 ? std::to_string(joint + 1) : "");
      if (std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(std::move(name));
    }
    if (any && ++more == 0) first = log.plan.path;
  }
  if (names.empty()) return {};
  const std::string others =
      more > 0 ? fmt::format(" (and {} more log{})", more, more > 1 ? "s" : "") : "";
  return {
      fmt::format("{}{}: no {} column and no load law in the rig file: the load torque is taken "
                  "as 0; give \"load\" in the rig file, {{\"type\": \"none\"}} where there is none",
                  first, others, fmt::join(names, ", "))};
}

bool has_trusted_finding(std::span<const LogSurvey> logs, const PartFilter& wanted) {
  return std::any_of(logs.begin(), logs.end(), [&](const LogSurvey& log) {
    return log.has_trusted_finding && std::any_of(log.parts.begin(), log.parts.end(), wanted);
  });
}

std::vector<std::string> input_warnings(std::span<const LogSurvey> logs) {
  std::vector<std::string> warnings;
  for (const LogSurvey& log : logs)
    warnings.insert(warnings.end(), log.warnings.begin(), log.warnings.end());
  const std::vector<std::string> unread = unread_joints(logs);
  warnings.insert(warnings.end(), unread.begin(), unread.end());
  return warnings;
}

}  // namespace cablefit
