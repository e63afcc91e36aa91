#include "cablefit/design/planned_fit.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/dynamic_job.hpp"
#include "cablefit/dynamic/sensor_noise.hpp"
#include "cablefit/model/model_parameters.hpp"
#include "cablefit/samples/recorded.hpp"

namespace cablefit {
namespace {

constexpr double kCounts = 0.01;          // of the torque: a friction of less is as good as none
constexpr double kRankTolerance = 1e-10;  // of columns of unit norm, exact but for rounding
constexpr Eigen::Index kLeastRows = 4;    // per parameter

bool load_is_column(const Rig& rig) { return rig.load.law == nullptr || rig.load.law->from_column; }

std::vector<Channel> channels_of(const Model& model) {
  std::vector<Channel> channels;
  if (!model.rigid) channels.push_back(Channel::q);
  channels.push_back(Channel::theta);
  channels.push_back(Channel::tau);
  if (load_is_column(model.rig)) channels.push_back(Channel::tau_load);
  return channels;
}

std::string indexed(Channel channel, int joint, int n_joints) {
  const std::string name(channel_name(channel));
  return n_joints > 1 ? name + std::to_string(joint + 1) : name;
}

/// Every sensor under its own name; throws for one of which nothing is known.
void spell_out_sensors(const std::vector<Channel>& channels, Rig& rig) {
  for (const Channel channel : channels) {
    if (channel == Channel::tau_load) continue;
    for (int joint = 0; joint < rig.n_joints(); ++joint) {
      const std::string name = indexed(channel, joint, rig.n_joints());
      const auto shared = rig.sensors.find(std::string(channel_name(channel)));
      if (rig.sensors.count(name) == 0 && shared != rig.sensors.end())
        rig.sensors[name] = shared->second;
      const auto found = rig.sensors.find(name);
      if (found != rig.sensors.end() && (found->second.noise || found->second.quantum)) continue;
      throw input_error({rig.path}, fmt::format("nothing says how noisy sensor {} is", name),
                        fmt::format("add \"sensors\": {{\"{}\": {{\"{}\": ...}}}} to the rig; an "
                                    "expected sd rests on it",
                                    name, channel == Channel::tau ? "noise" : "quantum"));
    }
  }
}

/// Rows x slots of the plan.
Eigen::MatrixXd slots_of(const ExcitedMotion& motion, const std::vector<Slot>& slots) {
  const SimulationResult& r = motion.result;
  Eigen::MatrixXd data(r.theta.rows(), static_cast<Eigen::Index>(slots.size()));
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const Eigen::ArrayXXd& from = slots[k].channel == Channel::q       ? r.q
                                  : slots[k].channel == Channel::theta ? r.theta
                                  : slots[k].channel == Channel::tau   ? r.tau
                                                                       : motion.input.tau_load;
    data.col(static_cast<Eigen::Index>(k)) = from.col(slots[k].joint);
  }
  return data;
}

LogPlan plan_of(const Model& model) {
  Rig rig = model.rig;
  rig.torque_hold = TorqueHold::zoh;  // as it is simulated; an expected sd is the same without
  rig.path.clear();
  const std::vector<Channel> channels = channels_of(model);
  spell_out_sensors(channels, rig);
  LogPlan plan = recorded_plan("the planned motion", rig, {});
  for (const Channel channel : channels)
    for (int joint = 0; joint < rig.n_joints(); ++joint) {
      plan.slots.push_back({channel, joint, plan.header.columns.size(), 1, 0});
      plan.header.columns.push_back(
          {indexed(channel, joint, rig.n_joints()), "", {plan.path, 1, 0}});
    }
  return plan;
}

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

/// sd per unit of noise of every column: columns scaled, QR, diag (W'W)^-1.
Eigen::VectorXd unit_sd(Eigen::MatrixXd columns) {
  Eigen::VectorXd scale = columns.colwise().norm();
  const Eigen::Index n = columns.cols();
  Eigen::VectorXd sd = Eigen::VectorXd::Constant(n, kUnbounded);
  if (!(scale.minCoeff() > 0)) return sd;
  columns *= scale.cwiseInverse().asDiagonal();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  if (!(r.diagonal().cwiseAbs().minCoeff() > kRankTolerance)) return sd;
  const Eigen::MatrixXd inverse =
      r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(n, n));
  return inverse.rowwise().norm().cwiseQuotient(scale);
}

}  // namespace

LogSurvey planned_log(const Model& model, const ExcitedMotion& motion) {
  const LogPlan plan = plan_of(model);
  RecordedPart part{"default", "", Phase::moving, true, {}};
  const Eigen::MatrixXd data = slots_of(motion, plan.slots);
  part.rows.resize(data.rows(), data.cols() + 1);
  part.rows.rightCols(data.cols()) = data;
  for (Eigen::Index i = 0; i < data.rows(); ++i)
    part.rows(i, 0) = static_cast<double>(i) * motion.period;
  return survey_recorded(plan, {part});
}

struct FitPlanner::Settings {
  Settings(const Model& m, const ExcitedMotion& first)
      : model(m),
        logs{planned_log(m, first)},
        elastic(stage1_of(m, first)),
        job{logs,      options,
            "default", [](const PartSurvey&) { return true; },
            {},        {m.rigid ? "rigid" : "poly"},
            m.rigid,   {},
            {},        nullptr} {
    if (!m.rigid) job.elastic = {&elastic.preloads.front().fits.front()};
    if (job.rig().arm.kind != nullptr) job.arm = &job.rig().arm;
    DynamicPreload unused;
    unused.name = "default";
    choose_settings(job, unused, elastic);
    equations = make_equations(job);
    std::vector<Eigen::VectorXd> combinations;
    for (const EquationRows& e : equations) {
      plain.push_back(e.equation);
      Eigen::VectorXd combination = response_of(e);
      for (Eigen::Index k = 0; k < e.columns.n_effects; ++k)
        combination(k) -= value_of(model, e.columns.parameters[static_cast<std::size_t>(k)].name);
      combinations.push_back(std::move(combination));
    }
    noise = sensor_noise(job, equations, combinations);
  }

  Eigen::VectorXd response_of(const EquationRows& e) const {
    return dynamic_response(e.columns, job.elastic, 0);
  }

  Model model;
  DynamicOptions options;
  std::vector<LogSurvey> logs;
  ElasticResult elastic;
  DynamicJob job;
  std::vector<EquationRows> equations;
  std::vector<Equation> plain;
  std::vector<double> noise;  ///< rms per equation
};

FitPlanner::FitPlanner(const Model& model, const ExcitedMotion& first)
    : settings_(std::make_unique<Settings>(model, first)) {}
FitPlanner::~FitPlanner() = default;

double FitPlanner::cutoff() const { return settings_->job.settings.rows.signal.cutoff; }

std::vector<PlannedParameter> FitPlanner::parameters(const ExcitedMotion& motion) const {
  const Settings& s = *settings_;
  Window window;
  window.data = slots_of(motion, s.logs.front().plan.slots);
  window.approach = Eigen::MatrixXd::Zero(window.data.rows(), s.job.n_joints());
  window.end = window.data.rows();
  window.starts_segment = window.ends_segment = true;
  window.period = motion.period;
  const RowBatch batch = make_rows(window, s.logs.front(), 0, s.job.settings.rows, s.plain);
  std::vector<PlannedParameter> all;
  for (std::size_t k = 0; k < s.equations.size(); ++k) {
    const DynamicColumns& columns = s.equations[k].columns;
    const Eigen::MatrixXd& rows = batch.equations[k].rows;
    const bool enough = rows.rows() > kLeastRows * columns.n_effects;
    std::vector<Eigen::Index> wanted;
    for (Eigen::Index j = 0; j < columns.n_effects; ++j)
      if (!columns.parameters[static_cast<std::size_t>(j)].given) wanted.push_back(j);
    const Eigen::MatrixXd w = rows(Eigen::all, wanted);
    const Eigen::VectorXd sd =
        enough ? Eigen::VectorXd(s.noise[k] * unit_sd(w))
               : Eigen::VectorXd(Eigen::VectorXd::Constant(w.cols(), kUnbounded));
    const double torque = std::sqrt(motion.result.tau.col(columns.place.joint).square().mean());
    const auto n_rows = static_cast<double>(rows.rows());
    for (std::size_t j = 0; j < wanted.size(); ++j) {
      const DynamicParameter& p = columns.parameters[static_cast<std::size_t>(wanted[j])];
      const auto at = static_cast<Eigen::Index>(j);
      PlannedParameter out{s.plain[k].name,           p.name, unit_on(s.model.rig, p.info.unit),
                           value_of(s.model, p.name), sd(at), kUnbounded};
      const double full = enough ? torque * std::sqrt(n_rows) / w.col(at).norm() : 0;
      const double size = p.info.lower == 0 ? std::max(std::abs(out.value), kCounts * full) : full;
      if (std::isfinite(out.sd) && size > 0) out.relative = out.sd / size;
      all.push_back(std::move(out));
    }
  }
  return all;
}

double worst_relative_sd(const std::vector<PlannedParameter>& parameters) {
  double worst = 0;
  for (const PlannedParameter& p : parameters) worst = std::max(worst, p.relative);
  return worst;
}

}  // namespace cablefit
