#include "cablefit/design/excitation/planned_fit.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/base/parallel.hpp"
#include "cablefit/design/excitation/planned_log.hpp"
#include "cablefit/design/excitation/planned_refusal.hpp"
#include "cablefit/design/excitation/scaled_solver.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/dynamic/rows/sensor_noise.hpp"
#include "cablefit/model/model_parameters.hpp"

namespace cablefit {
namespace {

constexpr double kCounts = 0.01;  // of the torque: a friction of less is as good as none

/// The model's cables as stage 1 would hand them over, exactly known.
ElasticResult stage1_of(const Model& model, const ExcitedMotion& motion) {
  ElasticFit fit;
  fit.model = "poly";
  fit.transmission = model.transmission;
  if (fit.transmission.theta_0.size() == 0)
    fit.transmission.theta_0 = Eigen::VectorXd::Zero(model.transmission.n_joints);
  for (const Cable& cable : fit.transmission.cables) fit.order = std::max(fit.order, cable.order);
  const Eigen::ArrayXXd deflection = motion.result.theta - motion.result.q;
  ElasticPreload preload;
  preload.name = "default";
  preload.deflection_low = deflection.minCoeff();
  preload.deflection_high = deflection.maxCoeff();
  for (Eigen::Index k = 0; deflection.cols() > 1 && k < deflection.cols(); ++k) {
    ElasticJoint joint;
    joint.deflection_low = deflection.col(k).minCoeff();
    joint.deflection_high = deflection.col(k).maxCoeff();
    preload.joints.push_back(joint);
  }
  preload.fits = {std::move(fit)};
  ElasticResult result;
  result.preloads = {std::move(preload)};
  return result;
}

double value_of(const Model& model, const std::string& name) {
  for (const ModelParameter& p : model_parameters(model))
    if (p.name == name) return parameter_value(model, p);
  return 0;
}

}  // namespace

struct FitPlanner::Settings {
  Settings(const Model& m, const ExcitedMotion& first, int n_draws, int threads)
      : model(m),
        logs{noisy_log(m, first)},
        elastic(stage1_of(m, first)),
        job{logs,      options,
            "default", [](const PartSurvey&) { return true; },
            {},        {m.rigid ? "rigid" : "poly"},
            m.rigid,   {},
            {}} {
    if (!m.rigid) job.elastic = {&elastic.preloads.front().fits.front()};
    DynamicPreload unused;
    unused.name = "default";
    choose_settings(job, unused, elastic);
    equations = make_equations(job);
    for (const EquationRows& e : equations) {
      plain.push_back(e.equation);
      Eigen::VectorXd combination = response_of(e);
      for (Eigen::Index k = 0; k < e.columns.n_effects; ++k)
        combination(k) -= value_of(model, e.columns.parameters[static_cast<std::size_t>(k)].name);
      residual.push_back(std::move(combination));
    }
    draw_noise(window_of(first, logs.front()), n_draws, threads);
  }

  Eigen::VectorXd response_of(const EquationRows& e) const {
    return dynamic_response(e.columns, job.elastic, 0);
  }

  /// Rows of all the time grid, at rest or not.
  RowBatch all_rows(const Window& window) const {
    std::vector<Equation> unchosen = plain;
    for (Equation& e : unchosen) e.rest_speed = 0;
    return make_rows(window, logs.front(), 0, job.settings.rows, unchosen);
  }

  void draw_noise(const Window& clean, int n_draws, int threads) {
    const RowBatch without = all_rows(clean);
    for (std::size_t k = 0; k < plain.size(); ++k) {
      first_number.push_back(
          without.equations[k].numbers.empty() ? 0 : without.equations[k].numbers.front());
      noise.emplace_back(without.equations[k].rows.rows(), n_draws);
    }
    Eigen::Index draw = 0;
    ordered_pipeline<int>(
        threads,
        [&](auto emit) {
          for (int i = 0; i < n_draws; ++i) emit(int{i});
        },
        [&](int i) {
          const RowBatch with =
              all_rows(with_noise(clean, logs.front(), static_cast<std::uint64_t>(i)));
          std::vector<Eigen::VectorXd> made;
          for (std::size_t k = 0; k < plain.size(); ++k)
            made.emplace_back((with.equations[k].rows - without.equations[k].rows) *
                              without_directions(residual[k], equations[k].columns));
          return made;
        },
        [&](const std::vector<Eigen::VectorXd>& made) {
          for (std::size_t k = 0; k < made.size(); ++k) noise[k].col(draw) = made[k];
          ++draw;
        });
  }

  /// The noise in the rows of these numbers, rows x draws.
  Eigen::MatrixXd noise_in(std::size_t k, const std::vector<Eigen::Index>& numbers) const {
    Eigen::MatrixXd out(static_cast<Eigen::Index>(numbers.size()), noise[k].cols());
    for (std::size_t i = 0; i < numbers.size(); ++i)
      out.row(static_cast<Eigen::Index>(i)) = noise[k].row(numbers[i] - first_number[k]);
    return out;
  }

  Model model;
  DynamicOptions options;
  std::vector<LogSurvey> logs;
  ElasticResult elastic;
  DynamicJob job;
  std::vector<EquationRows> equations;
  std::vector<Equation> plain;
  std::vector<Eigen::VectorXd> residual;  ///< of the model's own values, per equation
  std::vector<Eigen::MatrixXd> noise;     ///< rows x draws of it, per equation
  std::vector<Eigen::Index> first_number;
};

namespace {

struct Expected {
  Eigen::VectorXd sd, floor, white;  ///< per parameter
  double noise = 0;                  ///< rms in the rows
};

double rms_of(const Eigen::MatrixXd& noise) {
  return std::sqrt(noise.squaredNorm() /
                   static_cast<double>(std::max<Eigen::Index>(1, noise.size())));
}

/// `noise`: rows x draws; `left`: what the true parameters leave of the rows without noise.
Expected expected_errors(const ScaledSolver& solver, const Eigen::MatrixXd& noise,
                         const Eigen::VectorXd& left) {
  Expected out;
  out.noise = rms_of(noise);
  out.sd = solver.solve(noise).rowwise().norm() / std::sqrt(static_cast<double>(noise.cols()));
  out.floor = solver.solve(left);
  out.white = out.noise * solver.unit_sd();
  return out;
}

/// What an error of the parameter is held against; `full`: what makes all of the torque.
double size_of(const DynamicParameter& p, double value, double full) {
  if (p.is_inertia) return value;
  return p.info.lower == 0 ? std::max(std::abs(value), kCounts * full) : full;
}

}  // namespace

FitPlanner::FitPlanner(const Model& model, const ExcitedMotion& first, int n_draws, int threads)
    : settings_(std::make_unique<Settings>(model, first, n_draws, threads)) {}
FitPlanner::~FitPlanner() = default;

double FitPlanner::cutoff() const { return settings_->job.settings.rows.signal.cutoff; }

/// The rows of a system, those of several equations one below the other, each divided by its
/// residual over that of the first, as stage 2 weights them.
FitPlanner::PlannedRows FitPlanner::planned_rows(const std::vector<std::size_t>& system,
                                                 const RowBatch& batch,
                                                 const ExcitedMotion& motion) const {
  const Settings& s = *settings_;
  Eigen::Index n = 0;
  for (const std::size_t k : system) n += batch.equations[k].rows.rows();
  const EquationRows& first = s.equations[system.front()];
  PlannedRows all{Eigen::MatrixXd(n, first.columns.count),
                  Eigen::MatrixXd(n, s.noise[system.front()].cols()), Eigen::VectorXd(n)};
  double squares = 0, first_rms = 0;
  Eigen::Index at = 0;
  for (const std::size_t k : system) {
    const EquationBatch& own = batch.equations[k];
    const Eigen::Index rows = own.rows.rows();
    const Eigen::MatrixXd noise = s.noise_in(k, own.numbers);
    const Eigen::VectorXd residual = own.rows * s.residual[k];
    const double rms = std::hypot(rms_of(noise), rms_of(residual));
    if (k == system.front()) first_rms = rms;
    const double weight = rms > 0 && first_rms > 0 ? first_rms / rms : 1;
    all.rows.middleRows(at, rows) = weight * own.rows;
    all.noise.middleRows(at, rows) = weight * noise;
    all.residual.segment(at, rows) = weight * residual;
    squares += weight * weight * static_cast<double>(rows) *
               motion.result.tau.col(s.equations[k].columns.place.joint).square().mean();
    all.name = system.size() > 1 ? "links" : s.plain[k].name;
    at += rows;
  }
  all.torque = std::sqrt(squares);
  return all;
}

/// What a motion says of one system.
void FitPlanner::add_system(const std::vector<std::size_t>& system, const RowBatch& batch,
                            const ExcitedMotion& motion, PlannedFit& planned) const {
  const Settings& s = *settings_;
  const DynamicColumns& columns = s.equations[system.front()].columns;
  std::vector<Eigen::Index> wanted;
  for (Eigen::Index j = 0; j < columns.n_effects; ++j)
    if (!columns.parameters[static_cast<std::size_t>(j)].given) wanted.push_back(j);
  const PlannedRows all = planned_rows(system, batch, motion);
  const ScaledSolver solver(all.rows(Eigen::all, wanted), kLeastRowsPlanned);
  Expected expected;
  if (solver.determined()) expected = expected_errors(solver, all.noise, all.residual);
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    const DynamicParameter& p = columns.parameters[static_cast<std::size_t>(wanted[j])];
    const auto at = static_cast<Eigen::Index>(j);
    PlannedParameter out;
    out.equation = all.name;
    out.name = p.name;
    out.unit = p.unit();
    out.value = value_of(s.model, p.name);
    out.sd = out.sd_white = out.relative = kUnbounded;
    if (solver.determined()) {
      out.sd = expected.sd(at);
      out.sd_white = expected.white(at);
      out.floor = expected.floor(at);
      out.relative = out.error() / size_of(p, out.value, all.torque / solver.norms()(at));
      if (p.is_inertia && planned.refused.empty())
        planned.refused =
            refusal_of(all.rows, columns, wanted[j], s.response_of(s.equations[system.front()]),
                       out.value, expected.noise);
    }
    planned.parameters.push_back(std::move(out));
  }
}

PlannedFit FitPlanner::fit(const ExcitedMotion& motion) const {
  const Settings& s = *settings_;
  const RowBatch batch =
      make_rows(window_of(motion, s.logs.front()), s.logs.front(), 0, s.job.settings.rows, s.plain);
  PlannedFit planned;
  for (const std::vector<std::size_t>& system : systems_of(s.equations))
    add_system(system, batch, motion, planned);
  return planned;
}

double PlannedParameter::error() const { return std::hypot(sd, floor); }

double PlannedFit::worst() const {
  double worst = 0;
  for (const PlannedParameter& p : parameters) worst = std::max(worst, p.relative);
  return worst;
}

}  // namespace cablefit
