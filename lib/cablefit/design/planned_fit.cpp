#include "cablefit/design/planned_fit.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/base/parallel.hpp"
#include "cablefit/base/random.hpp"
#include "cablefit/dynamic/dynamic_job.hpp"
#include "cablefit/model/model_parameters.hpp"
#include "cablefit/samples/noise.hpp"
#include "cablefit/samples/recorded.hpp"

namespace cablefit {
namespace {

constexpr double kCounts = 0.01;          // of the torque: a friction of less is as good as none
constexpr double kRankTolerance = 1e-10;  // of columns of unit norm, exact but for rounding
// As estimates.cpp refuses inertias (0.98 and 2/3), with some room.
constexpr double kPositionAlias = 0.95;
constexpr double kShiftRefused = 0.4;
constexpr double kShiftSd = 3;  // of that shift, so that no noise makes it as large
constexpr std::uint64_t kSeed = 20261;
constexpr Eigen::Index kLeastRows = 4;  // per parameter

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

/// Least squares on columns of unit norm by QR.
class Solver {
 public:
  explicit Solver(Eigen::MatrixXd columns) : scale_(columns.colwise().norm()) {
    determined_ = columns.rows() > kLeastRows * columns.cols() && scale_.minCoeff() > 0;
    if (!determined_) return;
    columns *= scale_.cwiseInverse().asDiagonal();
    qr_.compute(columns);
    const Eigen::VectorXd diagonal = qr_.matrixQR().diagonal().cwiseAbs();
    determined_ = diagonal.minCoeff() > kRankTolerance;
  }
  bool determined() const { return determined_; }
  const Eigen::VectorXd& norms() const { return scale_; }
  /// Columns x right-hand sides.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const {
    return scale_.cwiseInverse().asDiagonal() * Eigen::MatrixXd(qr_.solve(right));
  }
  /// Root of diag (W'W)^-1.
  Eigen::VectorXd unit_sd() const {
    const Eigen::Index n = scale_.size();
    const Eigen::MatrixXd r = qr_.matrixQR().topRows(n).triangularView<Eigen::Upper>();
    const Eigen::MatrixXd inverse =
        r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(n, n));
    return inverse.rowwise().norm().cwiseQuotient(scale_);
  }

 private:
  Eigen::VectorXd scale_;
  Eigen::HouseholderQR<Eigen::MatrixXd> qr_;
  bool determined_ = false;
};

/// The same without the torques of a direction: what sgn does with noise at a reversal is not told.
Eigen::VectorXd smooth_part(Eigen::VectorXd combination, const DynamicColumns& c) {
  for (std::size_t k = 0; k < c.parameters.size(); ++k)
    if (c.parameters[k].follows == MotionPart::direction)
      combination(static_cast<Eigen::Index>(k)) = 0;
  return combination;
}

/// The motion as one window of its log.
Window window_of(const ExcitedMotion& motion, const LogSurvey& log) {
  Window window;
  window.data = slots_of(motion, log.plan.slots);
  window.approach = Eigen::MatrixXd::Zero(window.data.rows(), log.plan.rig.n_joints());
  window.end = window.data.rows();
  window.starts_segment = window.ends_segment = true;
  window.period = motion.period;
  return window;
}

Window with_noise(Window window, const LogSurvey& log, std::uint64_t draw) {
  Random random(kSeed, draw);
  for (std::size_t k = 0; k < log.plan.slots.size(); ++k) {
    const Slot& slot = log.plan.slots[k];
    if (slot.channel == Channel::tau_load) continue;  // known
    const double sd = position_noise(log, log.parts.front(), slot.channel, slot.joint);
    for (double& value : window.data.col(static_cast<Eigen::Index>(k)))
      value += sd * random.normal();
  }
  return window;
}

LogSurvey survey_of(const LogPlan& plan, const Eigen::MatrixXd& data, double period) {
  RecordedPart part{"default", "", Phase::moving, true, {}};
  part.rows.resize(data.rows(), data.cols() + 1);
  part.rows.rightCols(data.cols()) = data;
  for (Eigen::Index i = 0; i < data.rows(); ++i) part.rows(i, 0) = static_cast<double>(i) * period;
  return survey_recorded(plan, {part});
}

/// As it will be recorded: settings are chosen by what the noise looks like.
LogSurvey noisy_log(const Model& model, const ExcitedMotion& motion) {
  const LogSurvey clean = planned_log(model, motion);
  return survey_of(clean.plan, with_noise(window_of(motion, clean), clean, 0).data, motion.period);
}

}  // namespace

LogSurvey planned_log(const Model& model, const ExcitedMotion& motion) {
  const LogPlan plan = plan_of(model);
  return survey_of(plan, slots_of(motion, plan.slots), motion.period);
}

struct FitPlanner::Settings {
  Settings(const Model& m, const ExcitedMotion& first, int n_draws, int threads)
      : model(m),
        logs{noisy_log(m, first)},
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
                              smooth_part(residual[k], equations[k].columns));
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

/// `noise`: rms in the rows. Why the inertia of column `own` would be refused on them: told from a
/// torque of position too badly, or resting on the elastic stage alone.
std::string refusal_of(const Eigen::MatrixXd& rows, const DynamicColumns& c, Eigen::Index own,
                       const Eigen::VectorXd& response, double value, double noise) {
  const std::string& name = c.parameters[static_cast<std::size_t>(own)].name;
  std::vector<Eigen::Index> others, allowed;
  for (Eigen::Index j = 0; j < c.n_effects; ++j) {
    if (j != own) others.push_back(j);
    allowed.push_back(j);
  }
  others.push_back(c.position);
  allowed.push_back(c.position);
  for (std::size_t m = 0; m < c.elastic.size(); ++m)
    for (Eigen::Index j = 0; j < c.n_elastic[m]; ++j) allowed.push_back(c.elastic[m] + j);
  const Eigen::MatrixXd w = rows(Eigen::all, others);
  const Solver solver(w);
  if (!solver.determined()) return name + " is not shown";
  const Eigen::VectorXd column = rows.col(own);
  const double left = (column - w * solver.solve(column)).squaredNorm();
  if (1 - left / column.squaredNorm() > kPositionAlias)
    return name +
           " cannot be told from stiffness: its acceleration follows position, as in one "
           "sine";
  // Cables that are never taut have columns of zeros.
  std::erase_if(allowed, [&](Eigen::Index j) { return rows.col(j).norm() == 0; });
  const Eigen::MatrixXd all = rows(Eigen::all, allowed);
  const Solver free(all);
  const std::string rests = name + " would rest on the elastic stage alone";
  if (!free.determined()) return rests;
  const double alternative = free.solve(rows * response)(own);
  if (kShiftSd * noise * free.unit_sd()(own) > kShiftRefused * value) return rests;
  if (std::abs(alternative - value) > kShiftRefused * value) return rests;
  return "";
}

}  // namespace

FitPlanner::FitPlanner(const Model& model, const ExcitedMotion& first, int n_draws, int threads)
    : settings_(std::make_unique<Settings>(model, first, n_draws, threads)) {}
FitPlanner::~FitPlanner() = default;

double FitPlanner::cutoff() const { return settings_->job.settings.rows.signal.cutoff; }

PlannedFit FitPlanner::fit(const ExcitedMotion& motion) const {
  const Settings& s = *settings_;
  const RowBatch batch =
      make_rows(window_of(motion, s.logs.front()), s.logs.front(), 0, s.job.settings.rows, s.plain);
  PlannedFit planned;
  for (std::size_t k = 0; k < s.equations.size(); ++k) {
    const DynamicColumns& columns = s.equations[k].columns;
    const Eigen::MatrixXd& rows = batch.equations[k].rows;
    std::vector<Eigen::Index> wanted;
    for (Eigen::Index j = 0; j < columns.n_effects; ++j)
      if (!columns.parameters[static_cast<std::size_t>(j)].given) wanted.push_back(j);
    const Solver solver(rows(Eigen::all, wanted));
    const bool shown = solver.determined();
    Eigen::MatrixXd scatter;
    Eigen::VectorXd floor, white;
    double rms = 0;
    if (shown) {
      const Eigen::MatrixXd noise = s.noise_in(k, batch.equations[k].numbers);
      rms = std::sqrt(noise.squaredNorm() / static_cast<double>(noise.size()));
      scatter = solver.solve(noise);
      floor = solver.solve(rows * s.residual[k]);
      white = rms * solver.unit_sd();
    }
    const double torque = std::sqrt(motion.result.tau.col(columns.place.joint).square().mean() *
                                    static_cast<double>(rows.rows()));
    for (std::size_t j = 0; j < wanted.size(); ++j) {
      const DynamicParameter& p = columns.parameters[static_cast<std::size_t>(wanted[j])];
      const auto at = static_cast<Eigen::Index>(j);
      PlannedParameter out;
      out.equation = s.plain[k].name;
      out.name = p.name;
      out.unit = unit_on(s.model.rig, p.info.unit);
      out.value = value_of(s.model, p.name);
      out.sd = out.sd_white = out.relative = kUnbounded;
      if (shown) {
        out.sd = std::sqrt(scatter.row(at).squaredNorm() / static_cast<double>(scatter.cols()));
        out.sd_white = white(at);
        out.floor = floor(at);
        const double full = torque / solver.norms()(at);
        out.relative =
            out.error() / (p.is_inertia        ? out.value
                           : p.info.lower == 0 ? std::max(std::abs(out.value), kCounts * full)
                                               : full);
        if (p.is_inertia && planned.refused.empty())
          planned.refused =
              refusal_of(rows, columns, wanted[j], s.response_of(s.equations[k]), out.value, rms);
      }
      planned.parameters.push_back(std::move(out));
    }
  }
  return planned;
}

double PlannedParameter::error() const { return std::hypot(sd, floor); }

double PlannedFit::worst() const {
  double worst = 0;
  for (const PlannedParameter& p : parameters) worst = std::max(worst, p.relative);
  return worst;
}

}  // namespace cablefit
