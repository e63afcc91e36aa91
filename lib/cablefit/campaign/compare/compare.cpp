#include "cablefit/campaign/compare/compare.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "cablefit/base/error.hpp"
#include "cablefit/campaign/compare/compared_pairs.hpp"
#include "cablefit/estimate/spread/tail_probability.hpp"

namespace cablefit {
namespace {

/// With so many, Student's t is the normal distribution to five digits.
constexpr double kMostDof = 1e5;

/// The degrees of freedom that an interval was made with: its half width is t sd, but for profiles.
double dof_of(const Estimate& e) {
  constexpr double kTail = 0.05;
  const double t = (e.ci_high - e.value) / e.sd;
  if (e.profiled || !e.active_bound.empty() || !(t > t_quantile(kTail, kMostDof))) return kMostDof;
  double low = 1, high = kMostDof;
  while (high - low > 1e-6 * high) {
    const double middle = std::sqrt(low * high);
    (t_quantile(kTail, middle) > t ? low : high) = middle;
  }
  return high;
}

double welch_dof(double variance_1, double dof_1, double variance_2, double dof_2) {
  const double sum = variance_1 + variance_2;
  return sum * sum / (variance_1 * variance_1 / dof_1 + variance_2 * variance_2 / dof_2);
}

/// Why two estimates of one name cannot be compared; empty: they can.
std::string why_not(const EstimatePair& pair) {
  const Estimate &first = *pair.first, &second = *pair.second;
  const bool is_coefficient = first.name.find('_') != std::string::npos &&
                              (first.name.starts_with('K') || first.name.starts_with("k["));
  if (is_coefficient && pair.first_set->order != pair.second_set->order)
    return fmt::format("of order {} in A, {} in B: the coefficients are not comparable",
                       pair.first_set->order, pair.second_set->order);
  for (const Estimate* e : {&first, &second})
    if (!e->not_identifiable.empty()) return "not identifiable: " + e->not_identifiable;
  if (first.unit != second.unit)
    return fmt::format("in {} in A, in {} in B", first.unit, second.unit);
  for (const Estimate* e : {&first, &second})
    if (!std::isfinite(e->value) || !std::isfinite(e->sd)) return "without a standard deviation";
  return {};
}

ComparedParameter parameter_of(const EstimatePair& pair, const CompareOptions& options) {
  const auto both = [](const std::string& first, const std::string& second) {
    return first == second ? first : fmt::format("{} / {}", first, second);
  };
  ComparedParameter p;
  p.stage = both(pair.first_set->stage, pair.second_set->stage);
  p.preload = both(pair.first_set->preload, pair.second_set->preload);
  p.model = both(pair.first_set->model, pair.second_set->model);
  p.name = pair.first->name;
  p.unit = pair.first->unit;
  p.first = pair.first->value;
  p.first_sd = pair.first->sd;
  p.second = pair.second->value;
  p.second_sd = pair.second->sd;
  const double scale = scale_of_zero(*pair.first_set, *pair.first);
  p.is_relative = !is_ideally_zero(p.name);
  p.margin = options.margin * (p.is_relative ? std::abs(p.first) : scale);
  return p;
}

/// A log, not an earlier result.
bool is_log(const InputFile& input) { return input.rows > 0; }

/// What was fitted, by content: the same log may be named by two paths.
std::set<std::string> hashes(const RecordedResult& result) {
  std::set<std::string> all;
  for (const InputFile& input : result.inputs) all.insert(input.sha256);
  return all;
}

std::size_t n_logs(const RecordedResult& result) {
  std::set<std::string> logs;
  for (const InputFile& input : result.inputs)
    if (is_log(input)) logs.insert(input.sha256);
  return logs.size();
}

/// "estimator: iv, then wls"
void add_change(std::string_view what, const std::set<std::string>& first,
                const std::set<std::string>& second, std::vector<std::string>& out) {
  if (first != second && !first.empty() && !second.empty())
    out.push_back(fmt::format("{}: {}, then {}", what, fmt::join(first, " and "),
                              fmt::join(second, " and ")));
}

void add_settings(const std::vector<EstimatePair>& pairs, CompareResult& result) {
  add_change("made by", {"cablefit " + result.first.version}, {"cablefit " + result.second.version},
             result.settings);
  add_change("command", {result.first.command}, {result.second.command}, result.settings);
  std::set<std::string> preloads[2], models[2], estimators[2];
  for (const EstimatePair& pair : pairs)
    for (const int i : {0, 1}) {
      const EstimateSet& set = i == 0 ? *pair.first_set : *pair.second_set;
      preloads[i].insert(set.preload);
      models[i].insert(set.model);
      if (!set.estimator.empty()) estimators[i].insert(set.estimator);
    }
  add_change("preload", preloads[0], preloads[1], result.settings);
  add_change("model", models[0], models[1], result.settings);
  add_change("estimator", estimators[0], estimators[1], result.settings);
}

/// Paths of what was fitted in both: the logs, or the earlier results.
std::vector<std::string> fitted_in_both(const RecordedResult& first, const RecordedResult& second,
                                        bool logs) {
  const std::set<std::string> there = hashes(second);
  std::set<std::string> seen;
  std::vector<std::string> both;
  for (const InputFile& input : first.inputs)
    if (is_log(input) == logs && there.contains(input.sha256) && seen.insert(input.sha256).second)
      both.push_back(input.path);
  return both;
}

/// "the only log of a.json", "all 2 logs of a.json", "1 of 2 logs of a.json".
std::string share_of_logs(std::size_t n, const RecordedResult& result) {
  const std::size_t all = n_logs(result);
  if (all == 1) return "the only log of " + result.path;
  if (n == all) return fmt::format("all {} logs of {}", all, result.path);
  return fmt::format("{} of {} logs of {}", n, all, result.path);
}

/// What both results rest on: it makes them more alike than independent results are.
std::string shared_warning(const RecordedResult& first, const RecordedResult& second) {
  const std::vector<std::string> logs = fitted_in_both(first, second, true);
  const std::vector<std::string> stage1 = fitted_in_both(first, second, false);
  std::string shared;
  if (!logs.empty())
    shared = fmt::format("both results were fitted to {} ({}, {})", fmt::join(logs, ", "),
                         share_of_logs(logs.size(), first), share_of_logs(logs.size(), second));
  if (!stage1.empty())
    shared += fmt::format("{}{}", shared.empty() ? "both results use " : " and use ",
                          fmt::join(stage1, ", "));
  if (shared.empty()) return {};
  return shared +
         ": their errors are correlated; the test assumes independent errors and finds "
         "fewer differences";
}

/// Two preloads of one result share its list of logs, not their logs.
bool are_same_preloads(const std::vector<EstimatePair>& pairs) {
  return std::all_of(pairs.begin(), pairs.end(), [](const EstimatePair& pair) {
    return pair.first_set->preload == pair.second_set->preload;
  });
}

}  // namespace

std::string_view to_string(Sameness sameness) {
  constexpr std::array<std::string_view, 3> kNames{"equal", "different", "undecided"};
  return kNames[static_cast<std::size_t>(sameness)];
}

double ComparedParameter::percent() const {
  return is_relative && first != 0 ? 100 * difference / std::abs(first)
                                   : std::numeric_limits<double>::quiet_NaN();
}

std::size_t CompareResult::count(Sameness wanted) const {
  return static_cast<std::size_t>(
      std::count_if(parameters.begin(), parameters.end(),
                    [wanted](const ComparedParameter& p) { return p.sameness == wanted; }));
}

Sameness CompareResult::sameness() const {
  if (count(Sameness::different) > 0) return Sameness::different;
  return count(Sameness::undecided) > 0 ? Sameness::undecided : Sameness::equal;
}

void judge_difference(ComparedParameter& p, double first_dof, double second_dof,
                      std::size_t n_tests, bool same_logs, const CompareOptions& options) {
  p.difference = p.second - p.first;
  const double size = std::abs(p.difference);
  if (same_logs || (p.first_sd == 0 && p.second_sd == 0)) {
    p.low = p.high = p.difference;
    p.is_within_margin = size <= p.margin;
    p.p_value = p.p_together = size == 0 ? 1 : 0;
    p.sameness = p.is_within_margin || size == 0 ? Sameness::equal
                 : std::isnan(p.margin)          ? Sameness::undecided
                                                 : Sameness::different;
    return;
  }
  const double variance_1 = p.first_sd * p.first_sd, variance_2 = p.second_sd * p.second_sd;
  p.sd = std::sqrt(variance_1 + variance_2);
  p.dof = std::min(kMostDof, welch_dof(variance_1, first_dof, variance_2, second_dof));
  const auto n = static_cast<double>(n_tests);
  p.p_value = t_tail(size / p.sd, p.dof);
  p.p_together = -std::expm1(n * std::log1p(-p.p_value));
  const double reach = t_quantile(-std::expm1(std::log1p(-options.significance) / n), p.dof) * p.sd;
  p.low = p.difference - reach;
  p.high = p.difference + reach;
  const double one_sided = t_quantile(2 * options.significance, p.dof) * p.sd;
  p.is_within_margin = size + one_sided < p.margin;
  p.sameness = size > reach         ? Sameness::different
               : p.is_within_margin ? Sameness::equal
                                    : Sameness::undecided;
  p.more_data = one_sided * one_sided / (p.margin * p.margin);
}

CompareResult compare(RecordedResult first, RecordedResult second, const CompareOptions& options) {
  CompareResult result;
  result.options = options;
  std::vector<EstimatePair> pairs = estimate_pairs(first, second, options, result.not_compared);
  std::erase_if(pairs, [&](const EstimatePair& pair) {
    std::string reason = why_not(pair);
    if (reason.empty()) return false;
    result.not_compared.push_back({pair.first_set->preload, pair.first->name, std::move(reason)});
    return true;
  });
  if (pairs.empty())
    throw input_error({second.path}, fmt::format("no parameter to compare with {}", first.path),
                      "compare two results of one stage and preload; --preload FIRST SECOND "
                      "names two preloads");
  result.first = first;
  result.second = second;
  add_settings(pairs, result);
  const bool same_preloads = are_same_preloads(pairs);
  const bool same_logs = same_preloads && !first.inputs.empty() && hashes(first) == hashes(second);
  if (same_logs)
    result.warnings.push_back(
        fmt::format("both results are fitted to the same logs ({}): they differ by the method "
                    "only, and the margin alone decides",
                    fmt::join(fitted_in_both(first, second, true), ", ")));
  else if (std::string shared = shared_warning(first, second); same_preloads && !shared.empty())
    result.warnings.push_back(std::move(shared));
  for (const EstimatePair& pair : pairs) {
    result.parameters.push_back(parameter_of(pair, options));
    judge_difference(result.parameters.back(), dof_of(*pair.first), dof_of(*pair.second),
                     pairs.size(), same_logs, options);
  }
  if (!result.not_compared.empty())
    result.warnings.push_back(fmt::format(
        "{} could not be compared",
        result.not_compared.size() == 1
            ? "1 parameter, preload or stage"
            : fmt::format("{} parameters, preloads or stages", result.not_compared.size())));
  result.first.sets.clear();
  result.second.sets.clear();
  return result;
}

}  // namespace cablefit
