#include "cablefit/predict/part_prediction.hpp"

#include <cmath>

#include "cablefit/model/model.hpp"

namespace cablefit {
namespace {

/// A channel of every joint, rows x joints; no columns where one lacks it.
Eigen::ArrayXXd channel_of(const Window& window, const LogPlan& plan, Channel channel) {
  const int n_joints = plan.rig.n_joints();
  const Eigen::Index n_rows = window.end - window.begin;
  if (!plan.has_for_all(channel)) return Eigen::ArrayXXd(n_rows, 0);
  Eigen::ArrayXXd table(n_rows, n_joints);
  for (int joint = 0; joint < n_joints; ++joint)
    table.col(joint) =
        window.data.col(plan.find(channel, joint)).segment(window.begin - window.first, n_rows);
  return table;
}

}  // namespace

PartPrediction::PartPrediction(const ElasticPrediction& prediction, const LogSurvey& log,
                               const PartSurvey& part, const Eigen::VectorXd& offset)
    : prediction_(prediction),
      log_(log),
      part_(part),
      offset_(offset),
      time_(
          {&log, 1}, [&](const PartSurvey& p) { return &p == &part; }, 1) {
  const auto n = static_cast<Eigen::Index>(prediction.signals().size());
  least_ = Eigen::RowVectorXd::Constant(n, kUnbounded);
  largest_ = -least_;
  squared_widths_ = Eigen::RowVectorXd::Zero(n);
  const auto n_joints = static_cast<std::size_t>(log.plan.rig.n_joints());
  at_rest_.resize(n_joints);
  for (std::size_t k = 0; k < 2 * n_joints; ++k) lines_.push_back(time_.new_line());
}

const ElasticPrediction::Rows& PartPrediction::add(const Window& window) {
  const Eigen::ArrayXXd theta = channel_of(window, log_.plan, Channel::theta);
  Eigen::ArrayXXd q = channel_of(window, log_.plan, Channel::q);
  // A blocked link need not be logged: it stands in the reference pose.
  if (q.cols() == 0) q = Eigen::ArrayXXd::Zero(theta.rows(), theta.cols());
  rows_ = prediction_.rows(q, theta);
  scan(window);
  if (part_.phase == Phase::blocked) sense(window, channel_of(window, log_.plan, Channel::tau));
  return rows_;
}

void PartPrediction::scan(const Window& window) {
  n_rows_ += static_cast<std::size_t>(rows_.values.rows());
  if (rows_.values.rows() == 0) return;
  least_ = least_.cwiseMin(rows_.values.colwise().minCoeff());
  largest_ = largest_.cwiseMax(rows_.values.colwise().maxCoeff());
  if (rows_.half_widths.size() > 0)
    squared_widths_ += rows_.half_widths.cwiseAbs2().colwise().sum();
  for (Eigen::Index i = 0; i < rows_.values.rows(); ++i) {
    const double t = window.t0 + static_cast<double>(window.begin + i) * window.period;
    for (std::size_t k = 0; k < lines_.size(); ++k)
      lines_[k].add(t, rows_.values(i, static_cast<Eigen::Index>(k)));
  }
}

void PartPrediction::sense(const Window& window, const Eigen::ArrayXXd& tau) {
  const auto n_joints = static_cast<Eigen::Index>(at_rest_.size());
  for (Eigen::Index joint = 0; joint < tau.cols(); ++joint)
    for (Eigen::Index i = 0; i < tau.rows(); ++i) {
      const double t = window.t0 + static_cast<double>(window.begin + i) * window.period;
      const double model = rows_.values(i, n_joints + joint) + offset_(joint);
      at_rest_[static_cast<std::size_t>(joint)].add(t, model - tau(i, joint), tau(i, joint));
    }
}

PredictedPart PartPrediction::result(bool figures) const {
  PredictedPart part;
  part.log = log_.plan.path;
  part.preload = part_.preload;
  part.phase = to_string(part_.phase);
  part.run = part_.run;
  part.n_rows = n_rows_;
  for (std::size_t k = 0; k < prediction_.signals().size(); ++k) {
    const ElasticSignal& signal = prediction_.signals()[k];
    const auto at = static_cast<Eigen::Index>(k);
    part.signals.push_back({signal.name, signal.unit, least_(at), largest_(at), {}});
    if (prediction_.has_band())
      part.signals.back().half_width =
          std::sqrt(squared_widths_(at) / static_cast<double>(n_rows_));
  }
  const int n_joints = log_.plan.rig.n_joints();
  for (int joint = 0; joint < n_joints; ++joint) {
    const TorqueScan& scan = at_rest_[static_cast<std::size_t>(joint)];
    if (scan.n_rows() == 0) continue;
    SensedTorque& torque = part.torques.emplace_back();
    torque.signal = "tau" + (n_joints > 1 ? std::to_string(joint + 1) : std::string());
    torque.unit = torque_unit(log_.plan.rig.axes.of(joint));
    torque.method = "tau_elas_m + offset, link at rest";
    scan.fill(torque);
  }
  if (figures) part.figures = this->figures();
  return part;
}

std::vector<Figure> PartPrediction::figures() const {
  Figure figure;
  figure.section = log_.plan.path;
  figure.group = part_.preload + ", " + std::string(to_string(part_.phase));
  figure.title = "Elastic torques by the model";
  figure.x = time_.axis();
  figure.y = {"elastic torque", torque_unit(log_.plan.rig.axes.all())};
  figure.wide = true;
  figure.rank = FigureRank::main;
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    figure.traces.push_back({prediction_.signals()[k].name,
                             k < lines_.size() / 2 ? TraceStyle::broad : TraceStyle::line,
                             static_cast<int>(k) + 1,
                             {},
                             {},
                             {},
                             {},
                             {}});
    lines_[k].draw(figure.traces.back());
  }
  return {std::move(figure)};
}

}  // namespace cablefit
