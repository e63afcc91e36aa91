#include "cablefit/predict/equation_residuals.hpp"

#include <fmt/format.h>

#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/dynamic/rows/requirements.hpp"
#include "cablefit/elastic/curve_of_model.hpp"
#include "cablefit/model/effects/effects_per_joint.hpp"
#include "cablefit/model/model_parameters.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

/// What the column of a parameter counts for: nonlinear ones count from where they are.
double value_of(const Model& model, const DynamicParameter& parameter) {
  if (parameter.given) return *parameter.given;
  if (parameter.is_nonlinear) return 0;
  for (const ModelParameter& p : model_parameters(model))
    if (p.name == parameter.name) return parameter_value(model, p);
  throw input_error({model.rig.path}, fmt::format("the model has no {}", parameter.name),
                    "give a model of both sides, as `cablefit dynamic` writes it");
}

/// What the columns times this are: measured torque minus the model's.
Eigen::VectorXd combination_of(const Model& model, const EquationRows& e,
                               const std::vector<const ElasticFit*>& curves) {
  Eigen::VectorXd combination = dynamic_response(e.columns, curves, 0);
  for (std::size_t k = 0; k < e.columns.parameters.size(); ++k)
    combination(static_cast<Eigen::Index>(k)) -= value_of(model, e.columns.parameters[k]);
  return combination;
}

void require_equations(const Model& model) {
  require_fittable(added_effects(model), model.rigid, model.transmission.cables);
}

DynamicOptions options_of(const Model& model, const ElasticResult& curve,
                          const SampleOptions& samples) {
  DynamicOptions options;
  options.samples = samples;
  options.models = {model.rigid ? "rigid" : curve.preloads.front().fits.front().model};
  options.effects = added_effects(model);
  return options;
}

}  // namespace

struct EquationResiduals::Parts {
  Parts(const Model& model, std::span<const LogSurvey> logs, const PartFilter& wanted,
        const SampleOptions& samples)
      : curve(curve_of(model)),
        arm(model.rig.arm),
        options(options_of(model, curve, samples)),
        job{logs, options, model.preload, wanted,         {}, options.models, model.rigid,
            {},   {},      false,         options.effects} {
    if (!model.rigid) job.elastic = {&curve.preloads.front().fits.front()};
    if (arm.is_coupled()) job.other_arm = &arm;
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  ElasticResult curve;
  Arm arm;  ///< the model's: a rig file beside a log may have other masses
  DynamicOptions options;
  DynamicJob job;
  std::vector<ResidualEquation> equations;
  std::vector<Equation> columns;
  std::vector<Eigen::VectorXd> combinations;
  std::vector<Eigen::Index> torque;  ///< column of the measured torque
};

EquationResiduals::EquationResiduals(const Model& model, std::span<const LogSurvey> logs,
                                     const PartFilter& wanted, const SampleOptions& samples) {
  require_equations(model);
  parts_ = std::make_unique<Parts>(model, logs, wanted, samples);
  DynamicJob& job = parts_->job;
  for (const LogSurvey& log : logs) require_channels(log.plan, model.rigid);
  DynamicPreload chosen;  // of which only the settings are wanted
  choose_settings(job, chosen, parts_->curve);
  for (const EquationRows& e : make_equations(job)) {
    parts_->equations.push_back({e.columns.side, e.columns.place.joint});
    parts_->columns.push_back(e.equation);
    parts_->combinations.push_back(combination_of(model, e, job.elastic));
    parts_->torque.push_back(e.columns.torque);
  }
}

EquationResiduals::~EquationResiduals() = default;
EquationResiduals::EquationResiduals(EquationResiduals&&) noexcept = default;
EquationResiduals& EquationResiduals::operator=(EquationResiduals&&) noexcept = default;

const std::vector<ResidualEquation>& EquationResiduals::equations() const {
  return parts_->equations;
}

double EquationResiduals::row_seconds() const {
  const DynamicJob& job = parts_->job;
  return job.settings.rows.decimate / sample_rates(job.logs, job.wanted).lowest;
}

const std::vector<Decision>& EquationResiduals::decisions() const {
  return parts_->job.settings.decisions;
}

void EquationResiduals::stream(const std::function<void(const ResidualRows&)>& sink) const {
  const DynamicJob& job = parts_->job;
  struct Residuals {
    RowBatch batch;
    std::vector<Eigen::VectorXd> torque, residual;
  };
  stream_rows(
      job.logs, job.wanted, job.settings.rows, parts_->columns, job.options.samples.threads,
      [this](RowBatch batch) {
        Residuals out{std::move(batch), {}, {}};
        for (std::size_t k = 0; k < out.batch.equations.size(); ++k) {
          const Eigen::MatrixXd& rows = out.batch.equations[k].rows;
          out.torque.emplace_back(rows.col(parts_->torque[k]));
          out.residual.emplace_back(rows * parts_->combinations[k]);
        }
        return out;
      },
      [&](const Residuals& done) {
        for (std::size_t k = 0; k < done.batch.equations.size(); ++k)
          sink({done.batch.log, done.batch.part, k, done.batch.equations[k].t, done.torque[k],
                done.residual[k], done.batch.equations[k].counts.rows_at_rest});
      });
}

}  // namespace cablefit
