#include "cablefit/dynamic/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/estimates/estimates.hpp"
#include "cablefit/dynamic/predicted_parameters.hpp"
#include "cablefit/dynamic/rows/requirements.hpp"
#include "cablefit/dynamic/rows/rough_stage1.hpp"
#include "cablefit/dynamic/rows/sensor_noise.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

/// Moving parts that one fit would take together.
struct Group {
  Prediction about;
  std::vector<LogSurvey> logs;
  std::vector<std::vector<bool>> parts;  ///< per log, of its parts
};

bool good_for(const CheckedPart& part, const char* model) {
  return std::find(part.identifies.begin(), part.identifies.end(), model) != part.identifies.end();
}

Group& group_of(std::vector<Group>& groups, const LogSurvey& log, const CheckedPart& part) {
  const bool rigid = !good_for(part, "dynamic");
  const LogPart own{&log.plan, part.survey.phase};
  for (Group& group : groups)
    if (group.about.preload == part.survey.preload && group.about.rigid == rigid &&
        is_same_bench({&group.logs.front().plan, Phase::moving}, own))
      return group;
  Group group;
  group.about.preload = part.survey.preload;
  group.about.rigid = rigid;
  group.about.axes = log.plan.rig.axes.all();
  return groups.emplace_back(std::move(group));
}

std::vector<Group> grouped(std::span<const LogSurvey> logs, const CheckResult& checked) {
  std::vector<Group> groups;
  for (std::size_t k = 0; k < logs.size(); ++k)
    for (std::size_t p = 0; p < logs[k].parts.size(); ++p) {
      const CheckedPart& part = checked.logs[k].parts[p];
      if (!good_for(part, "dynamic") && !good_for(part, "rigid")) continue;
      Group& group = group_of(groups, logs[k], part);
      if (group.about.logs.empty() || group.about.logs.back() != logs[k].plan.path) {
        group.about.logs.push_back(logs[k].plan.path);
        group.logs.push_back(logs[k]);
        group.parts.emplace_back(logs[k].parts.size(), false);
      }
      group.parts.back()[p] = true;
    }
  return groups;
}

/// By address: `group` must stay where it is.
PartFilter parts_of(const Group& group) {
  return [&group](const PartSurvey& part) {
    for (std::size_t k = 0; k < group.logs.size(); ++k)
      for (std::size_t p = 0; p < group.parts[k].size(); ++p)
        if (&group.logs[k].parts[p] == &part) return static_cast<bool>(group.parts[k][p]);
    return false;
  };
}

std::string name_of(const std::vector<EquationRows>& equations,
                    const std::vector<std::size_t>& system) {
  std::string name;
  for (const std::size_t k : system)
    name += (name.empty() ? "" : ", ") + equations[k].equation.name;
  return name;
}

/// Noise of every equation under the rough model; every equation solved for itself.
std::vector<double> noise_of(const DynamicJob& job, const std::vector<EquationRows>& equations) {
  std::vector<Eigen::VectorXd> combinations;
  for (const EquationRows& e : equations)
    combinations.push_back(solve_equation(e, job.elastic, 0).residual_combination);
  return sensor_noise(job, equations, combinations);
}

void require_rows(const DynamicJob& job, const std::vector<EquationRows>& equations) {
  for (const EquationRows& e : equations)
    if (e.rows->n_rows() < kRowsPerParameter * e.columns.n_effects)
      throw Error(ErrorKind::not_identifiable,
                  too_few_rows(job, e, static_cast<std::size_t>(e.rows->n_rows())));
}

PredictedEquation predict_system(const DynamicJob& job, const std::vector<EquationRows>& equations,
                                 const std::vector<std::size_t>& which,
                                 const std::vector<double>& noise) {
  const EquationRows& first = equations[which.front()];
  const SystemRows system_rows(equations, which, job.elastic, 0, Weighting::by_residual);
  const RowStatistics& rows = system_rows.get();
  PredictedSystem system{first.columns, rows, solve_rows(rows, first.columns, job.elastic, 0), {}};
  add_estimates(rows, first.columns, system.solution, job.rigid ? nullptr : job.elastic.front(), 0,
                true, system.fit);
  PredictedEquation out;
  out.name = name_of(equations, which);
  // Torque that jumps at every reversal looks noisy; what a model leaves bounds the noise.
  double weighted = 0, plain = 0, left = 0, n = 0;
  for (const std::size_t k : which) {
    const EquationRows& e = equations[k];
    const auto n_rows = static_cast<double>(e.rows->n_rows());
    const LinearSolution own = solve_equation(e, job.elastic, 0);
    const double weight = which.size() > 1 && own.rss > 0 ? n_rows / own.rss : 1;
    weighted += n_rows * weight * noise[k] * noise[k];
    plain += n_rows * noise[k] * noise[k];
    left += own.rss;
    n += n_rows;
    out.rows += e.counts.rows_used;
  }
  out.left = std::sqrt(left / n);
  out.noise = std::min(std::sqrt(plain / n), out.left);
  system.noise = std::min(std::sqrt(weighted / n), system.solution.rms());
  add_parameters(system, out);
  return out;
}

void predict(const Group& group, const SampleOptions& samples, Prediction& out) {
  DynamicOptions options;
  options.samples = samples;
  options.models = {out.rigid ? "rigid" : "poly"};
  DynamicJob job{group.logs, options, out.preload, parts_of(group), {}, options.models,
                 out.rigid,  {},      {}};
  require_agreement(job.logs, job.wanted, job.preload);
  ElasticResult rough;
  if (!job.rigid) {
    rough = rough_stage1(job);
    job.elastic = {&rough.preloads.front().fits.front()};
  }
  DynamicPreload unused;
  choose_settings(job, unused, rough);
  out.cutoff = job.settings.rows.signal.cutoff;
  std::vector<EquationRows> equations = make_equations(job);
  collect_rows(job, equations);
  require_rows(job, equations);
  const std::vector<double> noise = noise_of(job, equations);
  for (const std::vector<std::size_t>& system : systems_of(equations))
    out.equations.push_back(predict_system(job, equations, system, noise));
  // Advice on the motion is worth nothing where the units are wrong.
  if (has_trusted_finding(job.logs, job.wanted))
    for (PredictedEquation& e : out.equations) e.sentences.clear();
}

}  // namespace

std::vector<Prediction> predict_estimates(std::span<const LogSurvey> logs,
                                          const CheckResult& checked,
                                          const SampleOptions& options) {
  std::vector<Prediction> predictions;
  for (const Group& group : grouped(logs, checked)) {
    Prediction out = group.about;
    try {
      predict(group, options, out);
    } catch (const Error& error) {  // a log that no fit would take is still worth checking
      if (error.kind() == ErrorKind::usage) throw;
      out.none = error.what();
      out.equations.clear();
    }
    predictions.push_back(std::move(out));
  }
  return predictions;
}

}  // namespace cablefit
