#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cablefit/model/pair_maps/kinds.hpp"
#include "cablefit/model/routing/spline.hpp"

namespace cablefit::pair_maps {
namespace {

std::vector<double> read_angle(const JsonNode& node) {
  std::vector<double> angle = node.numbers();
  if (angle.size() < 2)
    throw node.error("a grid needs at least two angles each way", "give a list");
  const auto step_back =
      std::adjacent_find(angle.begin(), angle.end(), [](double a, double b) { return !(a < b); });
  if (step_back == angle.end()) return angle;
  const auto at = static_cast<std::size_t>(step_back - angle.begin()) + 1;
  throw node.items[at].error("angle must ascend", "sort the points by angle");
}

/// Second derivatives by angle 1, column by column.
Eigen::MatrixXd curvature_down(const std::vector<double>& angle, const Eigen::MatrixXd& values) {
  Eigen::MatrixXd curvature(values.rows(), values.cols());
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    const std::vector<double> column(values.col(j).begin(), values.col(j).end());
    const std::vector<double> bent = maps::spline_curvature(angle, column);
    curvature.col(j) = Eigen::Map<const Eigen::VectorXd>(bent.data(), values.rows());
  }
  return curvature;
}

Eigen::MatrixXd curvature_across(const std::vector<double>& angle, const Eigen::MatrixXd& values) {
  return curvature_down(angle, values.transpose()).transpose();
}

void add_spline(PairParameters& p) {
  p.curvature[0] = curvature_down(p.angle[0], p.values);
  p.curvature[1] = curvature_across(p.angle[1], p.values);
  p.curvature[2] = curvature_across(p.angle[1], p.curvature[0]);
}

PairParameters read(const JsonNode& node, MapSide /*side*/) {
  node.allow_only({"type", "joints", "angle_1", "angle_2", "displacement"});
  PairParameters p;
  p.angle = {read_angle(node.at("angle_1")), read_angle(node.at("angle_2"))};
  const JsonNode& points = node.at("displacement");
  p.values = read_matrix(points);
  if (p.values.rows() != static_cast<Eigen::Index>(p.angle[0].size()) ||
      p.values.cols() != static_cast<Eigen::Index>(p.angle[1].size()))
    throw points.error(
        fmt::format("{} lists of {} displacements, expected {} of {}", p.values.rows(),
                    p.values.cols(), p.angle[0].size(), p.angle[1].size()),
        "one list per angle_1, with one displacement per angle_2");
  if ((p.values.array() == p.values(0, 0)).all())
    throw points.error("all displacements are the same", "leave the map out");
  add_spline(p);
  if (!p.curvature[0].allFinite() || !p.curvature[1].allFinite() || !p.curvature[2].allFinite())
    throw node.at("angle_1").error("angles are too close together",
                                   "no finite surface goes through these points");
  return p;
}

std::vector<PairEntry> entries(const PairParameters& p) {
  return {{"angle_1", p.angle[0]}, {"angle_2", p.angle[1]}, {"displacement", lists_of(p.values)}};
}

/// Weights of the values and curvatures at the two points about `x`, in the spline (column 0) and
/// in its first two derivatives: rows value, next value, curvature, next curvature.
struct Weights {
  Eigen::Index first;
  Eigen::Matrix<double, 4, 3> of;
};

Weights weights_at(const std::vector<double>& angle, double x) {
  const double inside = std::clamp(x, angle.front(), angle.back());
  const auto above = std::upper_bound(angle.begin() + 1, angle.end() - 1, inside);
  const auto i = static_cast<std::size_t>(above - angle.begin()) - 1;
  const double h = angle[i + 1] - angle[i];
  const double a = angle[i + 1] - inside, b = inside - angle[i];
  Weights w{static_cast<Eigen::Index>(i), {}};
  w.of.col(0) << a / h, b / h, -a * b * (h + a) / (6 * h), -a * b * (h + b) / (6 * h);
  w.of.col(1) << -1 / h, 1 / h, (h * h - 3 * a * a) / (6 * h), (3 * b * b - h * h) / (6 * h);
  w.of.col(2) << 0, 0, a / h, b / h;
  if (x != inside) {  // straight on
    w.of.col(0) += (x - inside) * w.of.col(1);
    w.of.col(2).setZero();
  }
  return w;
}

PairValue at(const PairParameters& p, double x1, double x2) {
  const Weights down = weights_at(p.angle[0], x1), across = weights_at(p.angle[1], x2);
  const auto corner = [&](const Eigen::MatrixXd& of) {
    return of.block<2, 2>(down.first, across.first);
  };
  Eigen::Matrix4d points;
  points << corner(p.values), corner(p.curvature[1]), corner(p.curvature[0]),
      corner(p.curvature[2]);
  const Eigen::Matrix3d all = down.of.transpose() * points * across.of;
  PairValue value;
  value.displacement = all(0, 0);
  value.radius << all(1, 0), all(0, 1);
  value.slope << all(2, 0), all(1, 1), all(1, 1), all(0, 2);
  return value;
}

}  // namespace

PairMapKind grid() {
  return {.name = "grid",
          .equation = "bicubic spline through (angle_1, angle_2, displacement), straight outside",
          .source = "de Boor 1978, ch. XVII: tensor products; not-a-knot ends",
          .rotary_only = false,
          .read = read,
          .entries = entries,
          .at = at};
}

}  // namespace cablefit::pair_maps
