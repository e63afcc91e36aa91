#include "cablefit/refine/search/quick_look.hpp"

#include <Eigen/Cholesky>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

/// Rows [from, from + n) outside of which all columns are zero.
struct Extent {
  Eigen::Index from = 0, n = 0;
};
Extent extent_of(const Eigen::MatrixXd& columns) {
  Eigen::Index from = columns.rows(), to = 0;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    const auto column = columns.col(c);
    Eigen::Index first = 0, last = columns.rows();
    while (first < from && column(first) == 0) ++first;
    while (last > to && column(last - 1) == 0) --last;
    from = std::min(from, first);
    to = std::max(to, last);
  }
  return {from, std::max<Eigen::Index>(0, to - from)};
}

void add_products(const KindRows& rows, const ActiveColumns& active, double weight,
                  QuickLook::Products& sum) {
  const Extent extent = extent_of(active.columns);
  if (extent.n == 0) return;
  const Eigen::Index first = active.from + extent.from;
  const Eigen::MatrixXd c = weight * active.columns.middleRows(extent.from, extent.n);
  sum.cross.row(0) += rows.response.segment(first, extent.n).transpose() * c;
  sum.cross.bottomRows(rows.base.cols()) += rows.base.middleRows(first, extent.n).transpose() * c;
  sum.own += active.columns.middleRows(extent.from, extent.n).transpose() * c;
}

double weight_of(const KindLevels& levels, RowKind kind) {
  const double level = levels[static_cast<std::size_t>(kind)];
  return 1 / (level * level);
}

}  // namespace

QuickLook::QuickLook(const Design& design, const BlockGrams& grams, const KindLevels& levels)
    : rows_(design.rows), levels_(levels) {
  const Eigen::MatrixXd total = weighted_sum(grams, levels);
  const Eigen::Index p = total.rows() - 1;
  const Eigen::VectorXd diagonal = total.diagonal().tail(p);
  bool regular = p > 0 && diagonal.minCoeff() > 0;
  if (regular) {
    scale_ = diagonal.cwiseSqrt().cwiseInverse();
    const Eigen::LLT<Eigen::MatrixXd> llt(scale_.asDiagonal() * total.bottomRightCorner(p, p) *
                                          scale_.asDiagonal());
    regular = llt.info() == Eigen::Success;
    lower_ = llt.matrixL();
  }
  if (!regular)
    throw Error(ErrorKind::not_identifiable, "the logs do not determine the model's parameters");
  response_ =
      lower_.triangularView<Eigen::Lower>().solve(scale_.cwiseProduct(total.col(0).tail(p)));
  error_ = total(0, 0) - response_.squaredNorm();
}

QuickLook::Products QuickLook::products(
    const std::vector<std::vector<ActiveColumns>>& columns) const {
  const Eigen::Index n = columns.front().front().columns.cols();
  Products sum{Eigen::MatrixXd::Zero(1 + scale_.size(), n), Eigen::MatrixXd::Zero(n, n)};
  for (std::size_t s = 0; s < columns.size(); ++s)
    for (std::size_t k = 0; k < columns[s].size(); ++k) {
      const KindRows& kind = rows_[s].kinds[k];
      add_products(kind, columns[s][k], weight_of(levels_, kind.kind), sum);
    }
  return sum;
}

std::optional<QuickLook::Glance> QuickLook::with(const Products& products, Eigen::Index n,
                                                 double least) const {
  const Eigen::MatrixXd cross = products.cross.leftCols(n);
  const Eigen::MatrixXd own = products.own.topLeftCorner(n, n);
  const Eigen::VectorXd norms = own.diagonal();
  if (!(norms.minCoeff() > 0)) return {};
  const Eigen::VectorXd scale = norms.cwiseSqrt().cwiseInverse();
  // What the base explains of the columns goes out of them (Frisch & Waugh 1933).
  const Eigen::MatrixXd in_base = lower_.triangularView<Eigen::Lower>().solve(
      scale_.asDiagonal() * cross.bottomRows(scale_.size()));
  const Eigen::LLT<Eigen::MatrixXd> llt(scale.asDiagonal() * (own - in_base.transpose() * in_base) *
                                        scale.asDiagonal());
  if (llt.info() != Eigen::Success) return {};
  const Eigen::VectorXd left = Eigen::MatrixXd(llt.matrixL()).diagonal().cwiseAbs2();
  if (!(left.minCoeff() >= least)) return {};
  const Eigen::VectorXd along = cross.row(0).transpose() - in_base.transpose() * response_;
  Glance glance;
  glance.x = scale.cwiseProduct(llt.solve(scale.cwiseProduct(along)));
  glance.error = error_ - along.dot(glance.x);
  return glance;
}

}  // namespace cablefit
