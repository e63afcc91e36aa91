#include "cablefit/model/elongation_covariance.hpp"

#include <utility>

namespace cablefit {

void add_independent(const ElongationCovariance& more, ElongationCovariance& all) {
  const auto n = static_cast<Eigen::Index>(all.of.size());
  const auto n_more = static_cast<Eigen::Index>(more.of.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + n_more, n + n_more);
  matrix.topLeftCorner(n, n) = all.matrix;
  matrix.bottomRightCorner(n_more, n_more) = more.matrix;
  all.matrix = std::move(matrix);
  all.of.insert(all.of.end(), more.of.begin(), more.of.end());
}

ElongationCovariance elongation_covariance(std::span<const Model> models) {
  ElongationCovariance all;
  for (const Model& model : models) {
    ElongationCovariance own;
    std::vector<std::string> names;
    std::vector<double> sd;
    for (const Cable& cable : model.transmission.cables) {
      const std::string name = elongation_name(cable);
      const Estimate* e = find_estimate(model.elastic, name);
      if (e == nullptr || !(e->sd > 0) || !model.covariance.of({name})) continue;
      sd.push_back(e->sd);
      own.of.push_back({model.preload, name});
      names.push_back(name);
    }
    if (names.empty()) continue;
    own.matrix = *model.covariance.of(names);
    const Eigen::VectorXd scale =
        Eigen::Map<const Eigen::VectorXd>(sd.data(), own.matrix.rows()).array() /
        own.matrix.diagonal().array().sqrt();
    own.matrix = scale.asDiagonal() * own.matrix * scale.asDiagonal();
    add_independent(own, all);
  }
  return all;
}

}  // namespace cablefit
