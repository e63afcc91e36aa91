#include "cablefit/predict/elastic_prediction.hpp"

#include <fmt/format.h>

#include "cablefit/model/model_parameters.hpp"
#include "cablefit/simulate/simulate_result.hpp"

namespace cablefit {
namespace {

/// The model with the covariance of its elastic parameters alone: nothing else moves what is
/// predicted here.
Model elastic_only(Model model) {
  std::vector<std::string> names;
  for (const ModelParameter& p : model_parameters(model)) {
    const bool is_elastic = p.kind != ParameterKind::arm && p.kind != ParameterKind::effect &&
                            p.kind != ParameterKind::added;
    if (is_elastic && model.covariance.of({p.name})) names.push_back(p.name);
  }
  if (names.empty()) {
    model.covariance = {};
    return model;
  }
  model.covariance = {names, *model.covariance.of(names)};
  return model;
}

std::vector<ElasticSignal> signals_of(const Model& model) {
  std::vector<ElasticSignal> all;
  const int n = model.rig.n_joints();
  const JointAxes& axes = model.rig.axes;
  for (const char* name : {"tau_elas_l", "tau_elas_m"})
    for (int joint = 1; joint <= n; ++joint)
      all.push_back({joint_parameter_name(name, joint, n), torque_unit(axes.of(joint - 1))});
  const bool in_metres = model.rig.cables_given;
  for (const Cable& cable : model.transmission.cables)
    all.push_back({fmt::format("elongation[{}]", cable.name),
                   in_metres ? "m" : unit_for(axes_of(axes, cable), "rad")});
  for (const Cable& cable : model.transmission.cables)
    all.push_back({fmt::format("tension[{}]", cable.name),
                   in_metres ? "N" : torque_unit(axes_of(axes, cable))});
  all.push_back({"energy", "J"});
  return all;
}

void fill_row(const Transmission& transmission, const Eigen::VectorXd& q,
              const Eigen::VectorXd& theta, Eigen::Ref<Eigen::RowVectorXd> row) {
  Eigen::VectorXd link, motor;
  transmission.torques(q, theta, link, motor);
  const auto n_cables = static_cast<Eigen::Index>(transmission.cables.size());
  const Eigen::Index n = link.size();
  row.head(n) = link;
  row.segment(n, n) = motor;
  if (n_cables > 0) {
    row.segment(2 * n, n_cables) = transmission.elongations(q, theta);
    row.segment(2 * n + n_cables, n_cables) = transmission.tensions(q, theta);
  }
  row(row.size() - 1) = transmission.energy(q, theta);
}

Eigen::MatrixXd values_of(const Transmission& transmission, const Eigen::ArrayXXd& q,
                          const Eigen::ArrayXXd& theta, std::size_t n_signals) {
  Eigen::MatrixXd values(theta.rows(), static_cast<Eigen::Index>(n_signals));
  Eigen::RowVectorXd row(values.cols());
  for (Eigen::Index i = 0; i < theta.rows(); ++i) {
    fill_row(transmission, q.row(i).transpose(), theta.row(i).transpose(), row);
    values.row(i) = row;
  }
  return values;
}

}  // namespace

ElasticPrediction::ElasticPrediction(const Model& model, bool band)
    : transmission_(model.transmission), signals_(signals_of(model)) {
  if (band) copies_ = principal_copies(elastic_only(model));
}

ElasticPrediction::Rows ElasticPrediction::rows(const Eigen::ArrayXXd& q,
                                                const Eigen::ArrayXXd& theta) const {
  Rows out;
  out.values = values_of(transmission_, q, theta, signals_.size());
  if (copies_.empty()) return out;
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(out.values.rows(), out.values.cols());
  for (const MovedModel& copy : copies_)
    squares +=
        ((values_of(copy.model.transmission, q, theta, signals_.size()) - out.values) / copy.by)
            .cwiseAbs2();
  out.half_widths = kNormal975 * squares.cwiseSqrt();
  return out;
}

}  // namespace cablefit
