#include "cablefit/dynamic/dynamic_figures.hpp"

#include <fmt/format.h>

#include <array>

#include "cablefit/estimate/tests/residual_scan.hpp"
#include "cablefit/samples/rows/observed.hpp"
#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

/// What residuals are plotted against on one side; without a load when no log has one.
std::vector<Observed> variables_of(Side side, std::size_t joint, bool has_deflection, bool has_load,
                                   Axes axes) {
  const std::string length = unit_for(axes, "rad");
  const std::string torque = torque_unit(axes);
  std::vector<Observed> all;
  if (side == Side::link) {
    all.push_back(
        {"velocity of q", length + "/s", [joint](const auto& s) { return s.joints[joint].qd; }});
    all.push_back({"position q", length, [joint](const auto& s) { return s.joints[joint].q; }});
  } else {
    all.push_back({"velocity of theta", length + "/s",
                   [joint](const auto& s) { return s.joints[joint].thetad; }});
    all.push_back(
        {"position theta", length, [joint](const auto& s) { return s.joints[joint].theta; }});
  }
  if (has_deflection)
    all.push_back({"deflection theta - q", length, [joint](const Signals& s) -> Eigen::ArrayXd {
                     return s.joints[joint].theta - s.joints[joint].q;
                   }});
  if (has_load)
    all.push_back(
        {"load tau_load", torque, [joint](const auto& s) { return s.joints[joint].tau_load; }});
  return all;
}

bool has_load(std::span<const LogSurvey> logs, const PartFilter& wanted) {
  const LogPlan& plan = first_log_with(logs, wanted).plan;
  return plan.rig.load.law != nullptr || plan.has(Channel::tau_load);
}

/// A model keeps its colour whichever models are fitted beside it.
int series_of(const std::string& model) {
  const auto models = dynamic_models();
  for (std::size_t k = 0; k < models.size(); ++k)
    if (models[k].name == model) return static_cast<int>(k) + 1;
  return static_cast<int>(models.size()) + 1;
}

/// One equation on its way to figures: its columns and the observed ones, and what is seen of them.
struct SeenEquation {
  Equation equation;
  Eigen::MatrixXd combinations;  ///< columns x quantities
  ScanPlan plan;
};

/// Adds a quantity that is a combination of the equation's own columns.
Eigen::Index see(SeenEquation& seen, const Eigen::VectorXd& own) {
  const auto n_columns = static_cast<Eigen::Index>(seen.equation.columns.size());
  const Eigen::Index next = seen.combinations.cols();
  seen.combinations.conservativeResize(n_columns, next + 1);
  seen.combinations.col(next).setZero();
  seen.combinations.col(next).head(own.size()) = own;
  return next;
}

void see_variables(SeenEquation& seen, const std::vector<Observed>& observed) {
  const auto n_columns = static_cast<Eigen::Index>(seen.equation.columns.size());
  auto column = n_columns - static_cast<Eigen::Index>(observed.size());
  for (const Observed& one : observed)
    seen.plan.variables.push_back(
        {one.name, one.unit, see(seen, Eigen::VectorXd::Unit(n_columns, column++))});
}

const char* measured_text(Side side) {
  return side == Side::link    ? "tau_elas + tau_load"
         : side == Side::motor ? "motor torque tau"
                               : "torque tau";
}

SeenEquation see_equation(const DynamicJob& job, const EquationRows& rows, std::size_t place,
                          const std::vector<std::vector<LinearSolution>>& solutions,
                          const DynamicPreload& preload) {
  const Side side = rows.columns.side;
  const std::vector<Observed> observed =
      variables_of(side, static_cast<std::size_t>(rows.columns.place.joint),
                   rows.columns.deflection >= 0, has_load(job.logs, job.wanted), preload.axes);
  SeenEquation seen{with_observed(rows.equation, observed), {}, {}};
  seen.plan.section = preload.name;
  seen.plan.group = rows.equation.name + " equation";
  seen.plan.measured = measured_text(side);
  if (side == Side::link)
    seen.plan.about =
        "Measured: torque of the cables (this model of stage 1) and of the load on the "
        "link. Predicted: torque of inertia and friction.";
  if (side == Side::motor)
    seen.plan.about =
        "Explained: share of the squared torque of inertia and friction. The torque of the cables "
        "is not counted.";
  seen.plan.unit = torque_unit(preload.axes);
  seen.plan.same_measured = side != Side::link;
  for (std::size_t m = 0; m < solutions.size(); ++m) {
    // The link's torque is that of the cables, which each model sees differently.
    const Eigen::VectorXd measured =
        seen.plan.same_measured ? Eigen::VectorXd::Unit(rows.columns.count, rows.columns.torque)
                                : dynamic_response(rows.columns, job.elastic, m);
    const LinearSolution& solution = solutions[m][place];
    const std::string& model = preload.fits[m].model;
    const Eigen::Index left = see(seen, measured);
    const auto& errors = preload.fits[m].torque_error;
    const auto error = errors.find(rows.equation.name);
    seen.plan.models.push_back({model, series_of(model), left,
                                see(seen, solution.residual_combination), solution.rms(),
                                error == errors.end() ? 0 : error->second.relative});
  }
  see_variables(seen, observed);
  return seen;
}

std::vector<Figure> scan(const std::vector<SeenEquation>& seen, std::span<const LogSurvey> logs,
                         const PartFilter& wanted, const RowSettings& settings, int threads) {
  const TimeAxis time(logs, wanted, settings.decimate);
  std::vector<Equation> equations;
  std::vector<ResidualScan> scans;
  for (const SeenEquation& one : seen) {
    equations.push_back(one.equation);
    scans.emplace_back(one.plan, time);
  }
  stream_rows(
      logs, wanted, settings, equations, threads,
      [&](const RowBatch& batch) {
        std::vector<SeenRows> rows;
        for (std::size_t k = 0; k < seen.size(); ++k)
          rows.push_back(see_rows(batch, k, seen[k].combinations));
        return rows;
      },
      [&](const std::vector<SeenRows>& rows) {
        for (std::size_t k = 0; k < rows.size(); ++k) scans[k].add(rows[k]);
      });
  std::vector<Figure> figures;
  for (const ResidualScan& one : scans)
    for (Figure& figure : one.figures()) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace

std::vector<Figure> dynamic_figures(const DynamicJob& job,
                                    const std::vector<EquationRows>& equations,
                                    const std::vector<std::vector<LinearSolution>>& solutions,
                                    const DynamicPreload& preload) {
  std::vector<SeenEquation> seen;
  for (std::size_t k = 0; k < equations.size(); ++k)
    seen.push_back(see_equation(job, equations[k], k, solutions, preload));
  return scan(seen, job.logs, job.wanted, job.settings.rows, job.options.samples.threads);
}

std::vector<Figure> ratio_figures(const RatioRows& rows, const DynamicPreload& preload) {
  const std::vector<Observed> observed =
      variables_of(Side::link, 0, true, has_load(rows.logs, rows.wanted), preload.axes);
  SeenEquation seen{with_observed(rows.equation, observed), {}, {}};
  seen.plan.section = preload.name;
  seen.plan.group = "link equation, divided by J_link";
  seen.plan.measured = "acceleration of q";
  seen.plan.error = "acceleration error";
  seen.plan.unit = unit_for(preload.axes, "rad/s^2");
  const std::string& model = preload.fits.front().model;
  const Eigen::Index left = see(seen, rows.measured);
  seen.plan.models.push_back({model, series_of(model), left, see(seen, rows.residual), rows.rms});
  see_variables(seen, observed);
  return scan({seen}, rows.logs, rows.wanted, rows.settings, rows.threads);
}

}  // namespace cablefit
