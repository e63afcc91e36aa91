#include "cablefit/dynamic/rows/dynamic_job.hpp"

#include <algorithm>
#include <utility>

#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/preliminary.hpp"
#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

constexpr int kGuessWindows = 3;  // a bad guess costs a second pass, a long one costs always

}  // namespace

const LogSurvey& DynamicJob::first_log() const { return first_log_with(logs, wanted); }

const PartSurvey& DynamicJob::first_part() const {
  const LogSurvey& log = first_log();
  for (const PartSurvey& part : log.parts)
    if (wanted(part)) return part;
  return log.parts.front();
}

const ChosenSettings& DynamicJob::settings_of(int joint) const {
  return joint_settings.empty() ? settings : joint_settings[static_cast<std::size_t>(joint)];
}

const Arm* DynamicJob::arm() const {
  const Arm& own = other_arm != nullptr ? *other_arm : rig().arm;
  return links_alone || own.kind == nullptr ? nullptr : &own;
}

namespace {

void widen(const Eigen::MatrixXd& rows, EquationRows& e) {
  if (rows.rows() == 0 || e.columns.deflection < 0) return;
  e.deflection_low = std::min(e.deflection_low, rows.col(e.columns.deflection).minCoeff());
  e.deflection_high = std::max(e.deflection_high, rows.col(e.columns.deflection).maxCoeff());
}

EquationRows make_equation(const DynamicJob& job, ElasticDetail detail, Side side, int joint) {
  const ChosenSettings& settings = job.settings_of(joint);
  EquationRows e;
  e.columns = dynamic_columns(side, job.elastic, detail,
                              {joint, job.n_joints(), job.arm(), job.rig().axes}, {&job.added, {}});
  const double rest = side == Side::link ? settings.rest_speed_q : settings.rest_speed_theta;
  e.equation = dynamic_equation(e.columns, job.elastic, job.settings.rows.signal.torque_held, rest);
  if (side == Side::link) {
    e.equation.cutoff = settings.cutoff_q;
  } else if (job.n_joints() > 1) {
    e.equation.cutoff = settings.rows.signal.cutoff;
  }
  return e;
}

}  // namespace

std::vector<EquationRows> make_equations(const DynamicJob& job) {
  return make_equations(
      job, job.options.robust_sd ? ElasticDetail::coefficients : ElasticDetail::torque);
}

std::vector<EquationRows> make_equations(const DynamicJob& job, ElasticDetail detail) {
  std::vector<EquationRows> equations;
  const std::vector<Side> sides =
      job.rigid ? std::vector<Side>{Side::rigid} : std::vector<Side>{Side::link, Side::motor};
  for (int joint = 0; joint < job.n_joints(); ++joint)
    for (const Side side : sides) equations.push_back(make_equation(job, detail, side, joint));
  return equations;
}

std::vector<std::vector<std::size_t>> systems_of(const std::vector<EquationRows>& equations) {
  std::vector<std::vector<std::size_t>> systems;
  std::optional<std::size_t> arm;
  for (std::size_t k = 0; k < equations.size(); ++k) {
    const bool shared = equations[k].columns.n_arm > 0;
    if (shared && arm) {
      systems[*arm].push_back(k);
      continue;
    }
    if (shared) arm = systems.size();
    systems.push_back({k});
  }
  return systems;
}

std::vector<EquationRows> preliminary_equations(const DynamicJob& job, int n_windows) {
  std::vector<EquationRows> preliminary = make_equations(job);
  const RowSettings& settings = job.settings.rows;
  const Eigen::Index expected = expected_rows(job.logs, job.wanted, settings);
  for (EquationRows& e : preliminary) e.rows.emplace(e.columns.count, expected);
  const double rate = sample_rates(job.logs, job.wanted).highest;
  std::vector<Equation> plain;
  for (const EquationRows& e : preliminary) plain.push_back(e.equation);
  for (const PreliminaryWindow& p : preliminary_windows(job.logs, job.wanted, settings.signal,
                                                        row_halo(settings, rate), n_windows)) {
    const RowBatch batch = make_rows(p.window, job.logs[p.log], 0, settings, plain);
    for (std::size_t k = 0; k < preliminary.size(); ++k) {
      preliminary[k].rows->add(batch.equations[k].rows, batch.equations[k].numbers);
      widen(batch.equations[k].rows, preliminary[k]);
    }
  }
  return preliminary;
}

namespace {

/// Per equation the residual combinations of all models, one per column, as estimated from the
/// first windows.
std::vector<Eigen::MatrixXd> guess(const DynamicJob& job) {
  std::vector<Eigen::MatrixXd> all;
  for (const EquationRows& preliminary : preliminary_equations(job, kGuessWindows)) {
    Eigen::MatrixXd& guesses = all.emplace_back(preliminary.columns.count, job.models.size());
    for (std::size_t m = 0; m < job.models.size(); ++m)
      guesses.col(static_cast<Eigen::Index>(m)) =
          solve_equation(preliminary, job.elastic, m).residual_combination;
  }
  return all;
}

/// What one window adds to one equation.
struct Share {
  RowStatistics rows;
  ResidualPeaks peaks;
  RowCounts counts;
  double low = kUnbounded, high = -kUnbounded, acceleration = 0;
};

Share share_of(const EquationBatch& batch, const EquationRows& e, const RowStatistics& blank) {
  Share share{blank.empty_copy(), e.peaks->empty_copy(), batch.counts};
  if (batch.rows.rows() == 0) return share;
  share.rows.add(batch.rows, batch.numbers);
  share.peaks.add(batch.rows);
  if (e.columns.deflection >= 0) {
    share.low = batch.rows.col(e.columns.deflection).minCoeff();
    share.high = batch.rows.col(e.columns.deflection).maxCoeff();
  }
  // The regressor of an axis' own inertia is its acceleration; effects begin with it.
  if (!e.columns.effects.empty() && e.columns.effects.front()->is_inertia())
    share.acceleration = batch.rows.col(0).cwiseAbs().maxCoeff();
  return share;
}

void take(EquationRows& e, Share&& share) {
  e.rows->add(std::move(share.rows));
  e.peaks->add(std::move(share.peaks));
  e.counts += share.counts;
  e.deflection_low = std::min(e.deflection_low, share.low);
  e.deflection_high = std::max(e.deflection_high, share.high);
  e.acceleration = std::max(e.acceleration, share.acceleration);
}

}  // namespace

WindowCounts collect_rows(const DynamicJob& job, std::vector<EquationRows>& equations,
                          Peaks peaks) {
  std::vector<Eigen::MatrixXd> guesses(equations.size());
  if (peaks == Peaks::kept) guesses = guess(job);
  std::vector<Equation> plain;
  std::vector<RowStatistics> blank;
  const Eigen::Index expected = expected_rows(job.logs, job.wanted, job.settings.rows);
  for (std::size_t k = 0; k < equations.size(); ++k) {
    EquationRows& e = equations[k];
    plain.push_back(e.equation);
    blank.emplace_back(e.columns.count, expected, job.options.robust_sd);
    e.rows = blank.back();
    e.peaks.emplace(std::move(guesses[k]));
  }
  return stream_rows(
      job.logs, job.wanted, job.settings.rows, plain, job.options.samples.threads,
      [&](const RowBatch& batch) {
        std::vector<Share> shares;
        for (std::size_t k = 0; k < plain.size(); ++k)
          shares.push_back(share_of(batch.equations[k], equations[k], blank[k]));
        return shares;
      },
      [&](std::vector<Share> shares) {
        for (std::size_t k = 0; k < plain.size(); ++k) take(equations[k], std::move(shares[k]));
      });
}

LinearProblem problem_of(const DynamicColumns& columns,
                         const std::vector<const ElasticFit*>& elastic, std::size_t which) {
  LinearProblem problem;
  problem.response = dynamic_response(columns, elastic, which);
  for (const DynamicParameter& parameter : columns.parameters) {
    const auto k = static_cast<Eigen::Index>(problem.regressors.size());
    problem.regressors.push_back(k);
    problem.names.push_back(parameter.name);
    problem.motion.push_back(motion_column(columns, static_cast<std::size_t>(k)));
    problem.lower.push_back(parameter.info.lower);
    problem.held.emplace_back(!parameter.given       ? ""
                              : parameter.is_inertia ? "given by the rig file"
                                                     : "held at the value of the model");
    if (parameter.given) problem.response(k) = -*parameter.given;
  }
  return problem;
}

LinearSolution solve_rows(const RowStatistics& rows, const DynamicColumns& columns,
                          const std::vector<const ElasticFit*>& elastic, std::size_t which) {
  return solve(rows, problem_of(columns, elastic, which));
}

LinearSolution solve_equation(const EquationRows& e, const std::vector<const ElasticFit*>& elastic,
                              std::size_t which) {
  return solve_rows(*e.rows, e.columns, elastic, which);
}

double residual_weight(const RowStatistics& rows, const LinearProblem& alone) {
  const double rss = solve(rows, alone).rss;
  return rss > 0 ? static_cast<double>(rows.n_rows()) / rss : 1;
}

SystemRows::SystemRows(const std::vector<EquationRows>& equations,
                       const std::vector<std::size_t>& system,
                       const std::vector<const ElasticFit*>& elastic, std::size_t which,
                       Weighting weighting)
    : only_(&*equations[system.front()].rows) {
  if (system.size() == 1) return;
  std::vector<const RowStatistics*> rows;
  std::vector<double> weights;
  for (const std::size_t k : system) {
    const EquationRows& e = equations[k];
    rows.push_back(&*e.rows);
    weights.push_back(weighting == Weighting::none
                          ? 1
                          : residual_weight(*e.rows, problem_of(e.columns, elastic, which)));
  }
  joined_ = RowStatistics::weighted(rows, weights);
}

std::vector<LinearSolution> solve_equations(const std::vector<EquationRows>& equations,
                                            const std::vector<const ElasticFit*>& elastic,
                                            std::size_t which) {
  std::vector<LinearSolution> solutions(equations.size());
  for (const std::vector<std::size_t>& system : systems_of(equations)) {
    const SystemRows rows(equations, system, elastic, which, Weighting::by_residual);
    const LinearSolution solution =
        solve_rows(rows.get(), equations[system.front()].columns, elastic, which);
    for (const std::size_t k : system) solutions[k] = solution;
  }
  return solutions;
}

}  // namespace cablefit
