#include "cablefit/dynamic/dynamic_job.hpp"

namespace cablefit {

const LogSurvey& DynamicJob::first_log() const { return first_log_with(logs, wanted); }

const PartSurvey& DynamicJob::first_part() const {
  const LogSurvey& log = first_log();
  for (const PartSurvey& part : log.parts)
    if (wanted(part)) return part;
  return log.parts.front();
}

std::vector<EquationRows> make_equations(const DynamicJob& job) {
  std::vector<EquationRows> equations;
  const std::vector<Side> sides =
      job.rigid ? std::vector<Side>{Side::rigid} : std::vector<Side>{Side::link, Side::motor};
  for (const Side side : sides) {
    EquationRows e;
    e.columns = dynamic_columns(side, job.elastic);
    const double rest =
        side == Side::link ? job.settings.rest_speed_q : job.settings.rest_speed_theta;
    e.equation =
        dynamic_equation(e.columns, job.elastic, job.settings.rows.signal.torque_held, rest);
    if (side == Side::link) e.equation.cutoff = job.settings.cutoff_q;
    equations.push_back(std::move(e));
  }
  return equations;
}

WindowCounts collect_rows(const DynamicJob& job, std::vector<EquationRows>& equations) {
  std::vector<Equation> plain;
  std::vector<RowStatistics> blank;
  const Eigen::Index expected = expected_rows(job.logs, job.wanted, job.settings.rows);
  for (EquationRows& e : equations) {
    plain.push_back(e.equation);
    blank.emplace_back(e.columns.count, expected, job.options.honest_sd);
    e.rows = blank.back();
  }
  struct Result {
    std::vector<RowStatistics> rows;
    std::vector<RowCounts> counts;
  };
  return stream_rows(
      job.logs, job.wanted, job.settings.rows, plain, job.options.samples.threads,
      [&](const RowBatch& batch) {
        Result result;
        for (std::size_t k = 0; k < plain.size(); ++k) {
          result.rows.push_back(blank[k].empty_copy());
          result.rows.back().add(batch.equations[k].rows, batch.equations[k].numbers);
          result.counts.push_back(batch.equations[k].counts);
        }
        return result;
      },
      [&](const Result& result) {
        for (std::size_t k = 0; k < plain.size(); ++k) {
          equations[k].rows->add(result.rows[k]);
          equations[k].counts += result.counts[k];
        }
      });
}

LinearSolution solve_equation(const EquationRows& e, const std::vector<const ElasticFit*>& elastic,
                              std::size_t which) {
  LinearProblem problem;
  for (const Effect* effect : e.columns.effects)
    for (const ParameterInfo& info : effect->parameters) {
      problem.regressors.push_back(static_cast<Eigen::Index>(problem.regressors.size()));
      problem.names.emplace_back(info.name);
      problem.lower.push_back(info.lower);
    }
  problem.response = dynamic_response(e.columns, elastic, which);
  return solve(*e.rows, problem);
}

}  // namespace cablefit
