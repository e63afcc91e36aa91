#include "cablefit/elastic/figures/elastic_figures.hpp"

#include <fmt/format.h>

#include <array>

#include "cablefit/elastic/figures/mode_figure.hpp"
#include "cablefit/estimate/tests/residual_scan.hpp"
#include "cablefit/samples/rows/observed.hpp"
#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kCurveBins = 200;
constexpr std::size_t kFineX = 200, kFineY = 120;  // of the cloud that is a curve

/// Quantities seen of every row; those of the models follow.
enum Seen : Eigen::Index { kTau, kDeflection, kDirection, kSpeed, kPosition, kOfModels };
constexpr Eigen::Index kPerModel = 2;  // residual, elastic torque with offset
Eigen::Index residual_of(std::size_t model) {
  return kOfModels + kPerModel * static_cast<Eigen::Index>(model);
}
Eigen::Index curve_of(std::size_t model) { return residual_of(model) + 1; }

/// The model's torque without the motor's friction, as a combination of columns.
Eigen::VectorXd curve_combination(const BlockedColumns& own, const ElasticCandidate& candidate,
                                  const LinearSolution& solution, Eigen::Index n_columns) {
  Eigen::VectorXd curve = Eigen::VectorXd::Zero(n_columns);
  for (std::size_t k = 0; k < candidate.regressors.size(); ++k) {
    const Eigen::Index column = candidate.regressors[k];
    if (column == own.direction || column == own.speed) continue;
    curve(column) = solution.x(static_cast<Eigen::Index>(k));
  }
  return curve;
}

Eigen::MatrixXd seen_combinations(const BlockedColumns& own,
                                  const std::vector<ElasticCandidate>& candidates,
                                  const std::vector<LinearSolution>& solutions) {
  const Eigen::Index n_columns = own.count + 1;  // and the position
  const auto n_models = static_cast<Eigen::Index>(candidates.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n_columns, kOfModels + kPerModel * n_models);
  all(own.tau, kTau) = 1;
  all(own.deflection, kDeflection) = 1;
  all(own.direction, kDirection) = 1;
  all(own.speed, kSpeed) = 1;
  all(own.count, kPosition) = 1;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    all.col(residual_of(k)).head(own.count) = solutions[k].residual_combination;
    all.col(curve_of(k)) = curve_combination(own, candidates[k], solutions[k], n_columns);
  }
  return all;
}

/// Figs. 6a/7a and 6b/7b.
class CurveScan {
 public:
  CurveScan(const ElasticPreload& preload, double theta_0)
      : preload_(preload),
        theta_0_(theta_0),
        branches_(2, PointCloud(kFineX, kFineY)),
        errors_(preload.fits.size(), PointCloud(kFineX, kFineY)),
        curves_(preload.fits.size(), BinnedMean(kCurveBins)),
        explained_(preload.fits.size()) {}

  void add(const SeenRows& rows) {
    for (Eigen::Index i = 0; i < rows.values.rows(); ++i) {
      const double deflection = rows.values(i, kDeflection);
      const double theta = rows.values(i, kPosition);
      positions_.add(theta - theta_0_ - deflection, theta);
      branches_[rows.values(i, kDirection) > 0 ? 1 : 0].add(deflection, rows.values(i, kTau));
      for (std::size_t k = 0; k < curves_.size(); ++k) {
        errors_[k].add(deflection, rows.values(i, residual_of(k)));
        curves_[k].add(deflection, rows.values(i, curve_of(k)));
        explained_[k].add(rows.values(i, kTau), rows.values(i, residual_of(k)));
      }
    }
  }

  Figure torque(Figure figure) const {
    figure.title = "Torque against deflection";
    figure.wide = true;
    figure.caption =
        "The torques for rising and falling theta differ by twice the static friction "
        "of the motor. The curves are the models without friction, with the offset. "
        "Explained: share of the squared torque, friction included.";
    const std::array<const char*, 2> names = {"measured, theta falling", "measured, theta rising"};
    for (std::size_t k = 0; k < branches_.size(); ++k) {
      Trace trace{names[k], TraceStyle::points, kMeasured, {}, {}, {}, {}, {}};
      branches_[k].draw(trace);
      if (!trace.x.empty()) figure.traces.push_back(std::move(trace));
    }
    for (std::size_t k = 0; k < curves_.size(); ++k) {
      Trace trace = model_trace(k, TraceStyle::line);
      trace.name += fmt::format(", {} explained", explained_[k].of_squares());
      curves_[k].draw(trace, 1, false);
      figure.traces.push_back(std::move(trace));
    }
    return figure;
  }

  /// The first plot of a report: the torques of two models lie on each other, their errors do not.
  Figure error(Figure figure) const {
    figure.title = "Elastic error against deflection";
    figure.rank = FigureRank::main;
    figure.wide = true;
    figure.caption =
        "Measured torque minus that of the model, the motor's friction included. The "
        "error of a good model is a flat band of noise.";
    figure.y.title = "elastic error";
    for (std::size_t k = 0; k < errors_.size(); ++k) {
      Trace trace = model_trace(k, TraceStyle::points);
      trace.name += fmt::format(", rms {:.3g} {}", preload_.fits[k].rms_error, figure.y.unit);
      errors_[k].draw(trace);
      figure.traces.push_back(std::move(trace));
    }
    return figure;
  }

  Trace positions() const {
    Trace trace{"rows of the logs", TraceStyle::points, kMeasured, {}, {}, {}, {}, {}};
    positions_.draw(trace);
    return trace;
  }

 private:
  Trace model_trace(std::size_t k, TraceStyle style) const {
    return {model_text(preload_.fits[k]), style, static_cast<int>(k) + 1, {}, {}, {}, {}, {}};
  }

  const ElasticPreload& preload_;
  double theta_0_;
  PointCloud positions_;              ///< q, theta
  std::vector<PointCloud> branches_;  ///< falling, rising
  std::vector<PointCloud> errors_;    ///< by fit
  std::vector<BinnedMean> curves_;
  std::vector<Explained> explained_;  ///< of the torque, the motor's friction included
};

ScanPlan scan_plan(const ElasticPreload& preload, const std::string& section,
                   const std::vector<LinearSolution>& solutions) {
  ScanPlan plan;
  plan.section = section;
  plan.group = "Blocked link: residuals";
  plan.measured = "motor torque tau";
  plan.unit = torque_unit(preload.axes);
  for (std::size_t k = 0; k < preload.fits.size(); ++k)
    plan.models.push_back({model_text(preload.fits[k]), static_cast<int>(k) + 1, kTau,
                           residual_of(k), solutions[k].rms()});
  plan.variables = {{"velocity of theta", preload.unit + "/s", kSpeed},
                    {"position theta", preload.unit, kPosition},
                    {"deflection theta - q", preload.unit, kDeflection}};
  return plan;
}

}  // namespace

std::vector<Figure> elastic_figures(const ElasticJob& job, const BlockedRows& rows, int joint,
                                    const std::vector<ElasticCandidate>& candidates,
                                    const std::vector<LinearSolution>& solutions,
                                    const ElasticPreload& preload,
                                    const std::vector<ComparedModel>& compared) {
  const std::string section = rows.columns.n_joints > 1
                                  ? fmt::format("{}, joint {}", preload.name, joint + 1)
                                  : preload.name;
  const Observed theta{"position theta", preload.unit,
                       [k = static_cast<std::size_t>(joint)](const Signals& signals) {
                         return signals.joints[k].theta;
                       }};
  const std::array<Equation, 1> equation = {with_observed(rows.equations.front(), {theta})};
  const Eigen::MatrixXd combinations =
      seen_combinations(rows.columns.of_joint(joint), candidates, solutions);
  const ScanPlan plan = scan_plan(preload, section, solutions);
  const TimeAxis time(job.logs, job.wanted, job.settings.rows.decimate);
  ResidualScan residuals(plan, time);
  CurveScan curves(preload, rows.transmission.encoder_zero()(joint));
  stream_rows(
      job.logs, job.wanted, job.settings.rows, equation, job.options.samples.threads,
      [&](const RowBatch& batch) { return see_rows(batch, 0, combinations); },
      [&](const SeenRows& seen) {
        residuals.add(seen);
        curves.add(seen);
      });
  Figure blank;
  blank.section = section;
  blank.group = "Blocked link: elastic torque";
  blank.x = {"deflection theta - q", preload.unit};
  blank.y = {"motor torque tau", plan.unit};
  std::vector<Figure> figures = {curves.error(blank), curves.torque(blank)};
  const Transmission& cables = preload.fits.back().transmission;
  const auto push_back = [&](Figure figure) {
    figure.section = section;
    figure.group = blank.group;
    figures.push_back(std::move(figure));
  };
  if (cables.n_joints == 1)
    for (const auto draw : {cable_figure, stiffness_figure})
      push_back(
          draw(cables, preload.deflection_low, preload.deflection_high, preload.axes, compared));
  Figure map = mode_figure(cables, joint, seen_range(job.logs, job.wanted, Channel::q, joint),
                           seen_range(job.logs, job.wanted, Channel::theta, joint), preload.axes);
  map.traces.push_back(curves.positions());
  push_back(std::move(map));
  for (Figure& figure : residuals.figures()) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace cablefit
