#include "cablefit/dynamic/checks/systematic.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/dynamic/loops/method_floor.hpp"
#include "cablefit/estimate/fit/parameter_estimate.hpp"

namespace cablefit {
namespace {

constexpr double kNoted = 0.1;  // of a variance: less changes no digit of an sd

double value_of(const std::map<std::string, double>& sd, const std::string& name) {
  const auto found = sd.find(name);
  return found == sd.end() ? 0 : found->second;
}

std::string in_words(const std::string& noted) {
  return noted.empty() ? "small compared with every sd" : noted;
}

void widen_joint(const std::string& name, double factor, Estimation& estimation) {
  if (!estimation.joint) return;
  const Eigen::Index k = estimation.joint->find(name);
  if (k < 0) return;
  estimation.joint->covariance.row(k) *= factor;
  estimation.joint->covariance.col(k) *= factor;
}

}  // namespace

std::map<std::string, double> measured_floor(const EstimationTask& task,
                                             const Estimation& estimation, std::string* note) {
  std::vector<bool> with_instruments;
  for (const LinearSolution& solution : estimation.solutions)
    with_instruments.push_back(!solution.instruments.empty());
  const MethodFloor floor =
      method_floor(task.job, task.equations, estimation.solutions, with_instruments, task.model);
  if (note != nullptr) *note = floor.note;
  std::map<std::string, double> sd;
  for (std::size_t k = 0; k < floor.variance.size(); ++k)
    for (Eigen::Index i = 0; i < task.equations[k].columns.n_effects; ++i)
      sd[task.equations[k].columns.parameters[static_cast<std::size_t>(i)].name] =
          std::sqrt(floor.variance[k](i));
  return sd;
}

void add_systematic(const EstimationTask& task, bool by_filtered_rows, Estimation& estimation) {
  DynamicFit& fit = estimation.fit;
  if (!task.job.options.robust_sd) return;
  std::string note = estimation.floor_note;
  if (task.job.options.method_floor)
    fit.method_floor = *task.job.options.method_floor;
  else if (by_filtered_rows)
    fit.method_floor = measured_floor(task, estimation, &note);
  std::string noted, carried;
  for (Estimate& e : fit.parameters) {
    if (!e.not_identifiable.empty() || !(e.sd > 0)) continue;
    const double floor = value_of(fit.method_floor, e.name);
    const double misfit = value_of(fit.stage1_misfit, e.name);
    const double more =
        floor * floor + std::pow(value_of(fit.estimator_difference, e.name), 2) + misfit * misfit;
    const double factor = std::sqrt(1 + more / (e.sd * e.sd));
    if (floor * floor > kNoted * e.sd * e.sd)
      noted += fmt::format("{}{} {:.2g} sd", noted.empty() ? "" : ", ", e.name, floor / e.sd);
    if (misfit * misfit > kNoted * e.sd * e.sd)
      carried += fmt::format("{}{} {:.2g} sd", carried.empty() ? "" : ", ", e.name, misfit / e.sd);
    widen_interval(e, factor);
    widen_joint(e.name, factor, estimation);
  }
  const bool measured = !fit.method_floor.empty();
  if (!note.empty())
    estimation.decisions.push_back(
        {"method's floor", measured ? in_words(noted) : "not in the sd", note});
  if (!fit.stage1_misfit.empty())
    estimation.decisions.push_back(
        {"stage 1's misfit", in_words(carried), "its residual curve is included in every sd"});
}

}  // namespace cablefit
