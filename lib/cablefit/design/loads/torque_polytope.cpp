#include "cablefit/design/loads/torque_polytope.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/base/root.hpp"
#include "cablefit/design/loads/held_load.hpp"

namespace cablefit {
namespace {

constexpr double kParallel = 1e-10;  // of the largest column: none, or no part of a normal
constexpr double kSamePoint = 1e-9;  // of the size of the polytope
// Of the largest load of a search for a slack cable; doubled, it comes to exactly that load.
constexpr double kFirstShare = 1.0 / 8192;
using Points = std::vector<Eigen::VectorXd>;

double size_of(const Eigen::MatrixXd& columns) {
  return columns.size() > 0 ? columns.colwise().norm().maxCoeff() : 0;
}

void add_point(const Eigen::VectorXd& point, double hair, Points& all) {
  for (const Eigen::VectorXd& other : all)
    if ((point - other).norm() <= hair) return;
  all.push_back(point);
}

/// Unit vector that all of these columns are orthogonal to; nothing when it is
/// not unique.
std::optional<Eigen::VectorXd> normal_of(const Eigen::MatrixXd& columns, double size) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns, Eigen::ComputeFullU);
  if (columns.cols() > 0 && svd.singularValues().minCoeff() <= kParallel * size)
    return std::nullopt;
  return svd.matrixU().rightCols(1).col(0);
}

/// Calls `visit` with every choice of `n` of the numbers below `of`.
template <typename Visit>
void for_each_choice(Eigen::Index n, Eigen::Index of, Visit visit) {
  std::vector<Eigen::Index> chosen;
  const auto go = [&](const auto& self, Eigen::Index from) -> void {
    if (static_cast<Eigen::Index>(chosen.size()) == n) {
      visit(chosen);
      return;
    }
    for (Eigen::Index i = from; i < of; ++i) {
      chosen.push_back(i);
      self(self, i + 1);
      chosen.pop_back();
    }
  };
  go(go, 0);
}

/// Normals of the facets: each is orthogonal to n - 1 independent columns.
Points facet_normals(const Eigen::MatrixXd& columns) {
  const Eigen::Index n = columns.rows();
  const double size = size_of(columns);
  if (n == 1) return {Eigen::VectorXd::Ones(1), -Eigen::VectorXd::Ones(1)};
  Points normals;
  for_each_choice(n - 1, columns.cols(), [&](const std::vector<Eigen::Index>& chosen) {
    const auto normal = normal_of(columns(Eigen::all, chosen), size);
    if (!normal) return;
    add_point(*normal, kSamePoint, normals);
    add_point(-*normal, kSamePoint, normals);
  });
  return normals;
}

Points zonotope_vertices(const Eigen::MatrixXd& columns);

/// Those of one facet: what points outward is at its most, what lies in it is a
/// smaller zonotope.
void add_facet(const Eigen::MatrixXd& columns, const Eigen::VectorXd& normal, double size,
               Points& all) {
  Eigen::VectorXd corner = Eigen::VectorXd::Zero(columns.rows());
  std::vector<Eigen::Index> within;
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const double out = normal.dot(columns.col(i));
    if (out > kParallel * size) corner += columns.col(i);
    if (std::abs(out) <= kParallel * size) within.push_back(i);
  }
  for (const Eigen::VectorXd& more : zonotope_vertices(columns(Eigen::all, within)))
    add_point(corner + more, kSamePoint * size, all);
}

/// Of sums of shares, 0..1, of the columns.
Points zonotope_vertices(const Eigen::MatrixXd& columns) {
  const double size = size_of(columns);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(columns.rows());
  if (size == 0) return {zero};
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns, Eigen::ComputeThinU);
  svd.setThreshold(kParallel);
  const Eigen::Index rank = svd.rank();
  const Eigen::MatrixXd basis = svd.matrixU().leftCols(rank);
  const Eigen::MatrixXd flat = basis.transpose() * columns;
  Points low;
  if (rank == 1) {
    low = {flat.cwiseMin(0).rowwise().sum(), flat.cwiseMax(0).rowwise().sum()};
  } else {
    for (const Eigen::VectorXd& normal : facet_normals(flat)) add_facet(flat, normal, size, low);
  }
  Points all;
  for (const Eigen::VectorXd& point : low) all.push_back(basis * point);
  return all;
}

Eigen::MatrixXd matrix_of(const Points& points, Eigen::Index n) {
  Eigen::MatrixXd matrix(n, static_cast<Eigen::Index>(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k)
    matrix.col(static_cast<Eigen::Index>(k)) = points[k];
  return matrix;
}

/// Vertices in the plane, in order around their middle.
void sort_around(Points& points) {
  Eigen::VectorXd middle = Eigen::VectorXd::Zero(2);
  for (const Eigen::VectorXd& p : points) middle += p / static_cast<double>(points.size());
  const auto angle = [&](const Eigen::VectorXd& p) {
    return std::atan2(p(1) - middle(1), p(0) - middle(0));
  };
  std::sort(points.begin(), points.end(),
            [&](const auto& a, const auto& b) { return angle(a) < angle(b); });
}

double least_elongation_of(const Transmission& t, Eigen::Index cable,
                           const Eigen::VectorXd& load) try {
  return hold_load(t, load).elongation(cable);
} catch (const Error&) {
  return std::numeric_limits<double>::infinity();  // beyond what the cables
                                                   // hold: no answer
}

}  // namespace

double TorquePolytope::support(const Eigen::VectorXd& d) const {
  return (d.transpose() * columns).cwiseMax(0).sum();
}

double TorquePolytope::largest(int joint, int direction) const {
  return support(direction * Eigen::VectorXd::Unit(q.size(), joint));
}

double TorquePolytope::largest_alone(int joint, int direction) const {
  double most = std::numeric_limits<double>::infinity();
  const double hair = kParallel * size_of(columns);
  for (const auto& normal : normals.colwise()) {
    const double along = direction * normal(joint), reach = support(normal);
    if (along > kParallel) most = std::min(most, reach / along);
    if (along <= kParallel && reach < -hair) return std::numeric_limits<double>::quiet_NaN();
  }
  return std::isfinite(most) ? most : std::numeric_limits<double>::quiet_NaN();
}

TorquePolytope torque_polytope(const Transmission& transmission, std::string where,
                               const Eigen::VectorXd& q, double largest_tension) {
  TorquePolytope polytope;
  polytope.where = std::move(where);
  polytope.q = q;
  polytope.columns = largest_tension * transmission.link_coupling(q);
  const Eigen::Index n = q.size();
  Points vertices = zonotope_vertices(polytope.columns);
  if (n == 2) sort_around(vertices);
  polytope.vertices = matrix_of(vertices, n);
  Points facets, cone;
  const double hair = kParallel * size_of(polytope.columns);
  for (const Eigen::VectorXd& normal : facet_normals(polytope.columns)) {
    facets.push_back(normal);
    if (polytope.support(normal) <= hair) cone.push_back(normal);
  }
  polytope.normals = matrix_of(facets, n);
  polytope.cone = matrix_of(cone, n);
  polytope.closure = !facets.empty() && cone.empty();
  return polytope;
}

std::vector<SlackLoad> slack_order(const Transmission& transmission,
                                   const Eigen::VectorXd& direction, double most) {
  std::vector<SlackLoad> order;
  const HeldLoad rest = hold_load(transmission, 0 * direction);
  for (Eigen::Index i = 0; i < rest.elongation.size(); ++i) {
    if (!(rest.elongation(i) > 0)) continue;
    const auto load =
        root_outward([&](double s) { return -least_elongation_of(transmission, i, s * direction); },
                     kFirstShare * most, most);
    if (load) order.push_back({transmission.cables[static_cast<std::size_t>(i)].name, *load});
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const SlackLoad& a, const SlackLoad& b) { return a.load < b.load; });
  return order;
}

std::vector<SlackOrder> slack_orders(const Transmission& transmission,
                                     const TorquePolytope& polytope) {
  std::vector<SlackOrder> orders;
  for (int joint = 0; joint < transmission.n_joints; ++joint)
    for (const int sign : {1, -1}) {
      // A load is held by the opposite torque of the cables.
      const double most = polytope.largest(joint, -sign);
      const Eigen::VectorXd direction = sign * Eigen::VectorXd::Unit(transmission.n_joints, joint);
      if (most > 0) orders.push_back({direction, slack_order(transmission, direction, most)});
    }
  return orders;
}

}  // namespace cablefit
