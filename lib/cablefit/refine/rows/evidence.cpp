#include "cablefit/refine/rows/evidence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

/// Blocks of one stretch's rows of one kind: [from, to) and which block.
template <typename Use>
void for_each_block(const KindRows& rows, double period, double block_seconds, Use use) {
  const auto block_of = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<double>(rows.at[i]) * period / block_seconds);
  };
  for (std::size_t from = 0; from < rows.at.size();) {
    std::size_t to = from;
    while (to < rows.at.size() && block_of(to) == block_of(from)) ++to;
    use(block_of(from), static_cast<Eigen::Index>(from), static_cast<Eigen::Index>(to - from));
    from = to;
  }
}

/// Number of a stretch's first block among all.
std::vector<std::size_t> first_blocks(const std::vector<Stretch>& stretches, double block_seconds,
                                      std::size_t& n_blocks) {
  std::vector<std::size_t> first;
  n_blocks = 0;
  for (const Stretch& stretch : stretches) {
    first.push_back(n_blocks);
    const double seconds =
        static_cast<double>(stretch.recording.theta.size()) * stretch.recording.period;
    n_blocks += static_cast<std::size_t>(seconds / block_seconds) + 1;
  }
  return first;
}

Eigen::MatrixXd weighted(const BlockGrams::Block& block, const KindLevels& levels, Eigen::Index n) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t k = 0; k < kRowKinds; ++k)
    if (block.n_rows[k] > 0) sum += block.gram[k] / (levels[k] * levels[k]);
  return sum;
}

bool has_rows(const BlockGrams::Block& block) {
  return std::any_of(block.n_rows.begin(), block.n_rows.end(),
                     [](Eigen::Index n) { return n > 0; });
}

/// x of the normal equations of a Gram matrix, columns scaled; empty: singular.
struct Normal {
  Eigen::VectorXd x;
  Eigen::MatrixXd inverse;
};
std::optional<Normal> solve_normal(const Eigen::MatrixXd& gram, bool with_inverse,
                                   const OwnPart& own) {
  constexpr double kIndependent = 1e-12;
  const Eigen::Index p = gram.rows() - 1;
  const Eigen::VectorXd diagonal = gram.diagonal().tail(p);
  if (p > 0 && !(diagonal.minCoeff() > 0)) return {};
  const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd a = scale.asDiagonal() * gram.bottomRightCorner(p, p) * scale.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> llt(a);
  if (llt.info() != Eigen::Success) return {};
  // A squared pivot is what the columns before leave of a column.
  const Eigen::VectorXd left = Eigen::MatrixXd(llt.matrixL()).diagonal().cwiseAbs2();
  if (p > 0 && left.minCoeff() < kIndependent) return {};
  if (own.n_last > 0 && left.tail(own.n_last).minCoeff() < own.least) return {};
  Normal out;
  out.x = scale.cwiseProduct(llt.solve(scale.cwiseProduct(gram.col(0).tail(p))));
  if (with_inverse)
    out.inverse =
        scale.asDiagonal() * llt.solve(Eigen::MatrixXd::Identity(p, p)) * scale.asDiagonal();
  return out;
}

double squared_error(const Eigen::MatrixXd& gram, const Eigen::VectorXd& x) {
  Eigen::VectorXd c(x.size() + 1);
  c << 1.0, -x;
  return std::max(0.0, c.dot(gram * c));
}

/// The Gram matrix of rows [from, from + n) of a kind with `other` columns in place of some.
Eigen::MatrixXd gram_with(const ReplacedColumns& other, const Eigen::MatrixXd& gram,
                          const KindRows& kind, Eigen::Index from, Eigen::Index n) {
  const Eigen::Index left = other.first, m = other.columns.cols();
  const Eigen::Index right = gram.rows() - left - other.n, all = left + m + right;
  const auto c = other.columns.middleRows(from, n);
  Eigen::MatrixXd out(all, all);
  out.topLeftCorner(left, left) = gram.topLeftCorner(left, left);
  out.topRightCorner(left, right) = gram.topRightCorner(left, right);
  out.bottomLeftCorner(right, left) = gram.bottomLeftCorner(right, left);
  out.bottomRightCorner(right, right) = gram.bottomRightCorner(right, right);
  auto across = out.middleCols(left, m);
  if (left > 0) {
    across.topRows(1) = kind.response.segment(from, n).transpose() * c;
    across.middleRows(1, left - 1) =
        kind.base.middleRows(from, n).leftCols(left - 1).transpose() * c;
  }
  across.middleRows(left, m) = c.transpose() * c;
  across.bottomRows(right) = kind.base.middleRows(from, n).rightCols(right).transpose() * c;
  out.block(left, 0, m, left) = across.topRows(left).transpose();
  out.block(left, left + m, m, right) = across.bottomRows(right).transpose();
  return out;
}

void add_kind_sums(const BlockGrams& grams, BlockFit& fit) {
  for (const BlockGrams::Block& block : grams.blocks)
    for (std::size_t k = 0; k < kRowKinds; ++k) {
      if (block.n_rows[k] == 0) continue;
      fit.squares[k] += squared_error(block.gram[k], fit.x);
      fit.n_rows[k] += static_cast<double>(block.n_rows[k]);
    }
}

}  // namespace

BlockGrams block_grams(const std::vector<StretchRows>& rows, const std::vector<Stretch>& stretches,
                       double block_seconds) {
  BlockGrams grams;
  std::size_t n_blocks = 0;
  const auto first = first_blocks(stretches, block_seconds, n_blocks);
  grams.blocks.resize(n_blocks);
  for (std::size_t s = 0; s < rows.size(); ++s)
    for (const KindRows& kind : rows[s].kinds) {
      grams.n_columns = kind.base.cols();
      Eigen::MatrixXd all(kind.base.rows(), kind.base.cols() + 1);
      all << kind.response, kind.base;
      for_each_block(kind, stretches[s].recording.period, block_seconds,
                     [&](std::size_t b, Eigen::Index from, Eigen::Index n) {
                       BlockGrams::Block& block = grams.blocks[first[s] + b];
                       const auto k = static_cast<std::size_t>(kind.kind);
                       block.gram[k] =
                           all.middleRows(from, n).transpose() * all.middleRows(from, n);
                       block.n_rows[k] = n;
                     });
    }
  return grams;
}

BlockGrams block_grams(const Design& design, double block_seconds) {
  return block_grams(design.rows, design.stretches, block_seconds);
}

BlockGrams extended(const BlockGrams& base, const std::vector<StretchRows>& rows,
                    const std::vector<Stretch>& stretches, const VariantColumns& columns,
                    double block_seconds) {
  BlockGrams grams = base;
  std::size_t n_blocks = 0;
  const auto first = first_blocks(stretches, block_seconds, n_blocks);
  const Eigen::Index before = 1 + base.n_columns;
  for (std::size_t s = 0; s < rows.size(); ++s)
    for (std::size_t i = 0; i < rows[s].kinds.size(); ++i) {
      const KindRows& kind = rows[s].kinds[i];
      const Eigen::MatrixXd& more = columns[s][i];
      grams.n_columns = base.n_columns + more.cols();
      for_each_block(
          kind, stretches[s].recording.period, block_seconds,
          [&](std::size_t b, Eigen::Index from, Eigen::Index n) {
            Eigen::MatrixXd& g =
                grams.blocks[first[s] + b].gram[static_cast<std::size_t>(kind.kind)];
            const auto c = more.middleRows(from, n);
            g.conservativeResize(1 + grams.n_columns, 1 + grams.n_columns);
            g.block(0, before, 1, c.cols()) = kind.response.segment(from, n).transpose() * c;
            g.block(1, before, base.n_columns, c.cols()) =
                kind.base.middleRows(from, n).transpose() * c;
            g.bottomRightCorner(c.cols(), c.cols()) = c.transpose() * c;
            g.bottomLeftCorner(c.cols(), before) = g.topRightCorner(before, c.cols()).transpose();
          });
    }
  return grams;
}

BlockGrams replaced(const BlockGrams& base, const std::vector<StretchRows>& rows,
                    const std::vector<Stretch>& stretches,
                    const std::vector<std::vector<ReplacedColumns>>& columns,
                    double block_seconds) {
  BlockGrams grams = base;
  std::size_t n_blocks = 0;
  const auto first = first_blocks(stretches, block_seconds, n_blocks);
  for (std::size_t s = 0; s < rows.size(); ++s)
    for (std::size_t i = 0; i < rows[s].kinds.size(); ++i) {
      const KindRows& kind = rows[s].kinds[i];
      const ReplacedColumns& other = columns[s][i];
      grams.n_columns = base.n_columns - other.n + other.columns.cols();
      for_each_block(kind, stretches[s].recording.period, block_seconds,
                     [&](std::size_t b, Eigen::Index from, Eigen::Index n) {
                       Eigen::MatrixXd& gram =
                           grams.blocks[first[s] + b].gram[static_cast<std::size_t>(kind.kind)];
                       gram = gram_with(other, gram, kind, from, n);
                     });
    }
  return grams;
}

BlockGrams with_columns(const BlockGrams& grams, const std::vector<Eigen::Index>& which) {
  std::vector<Eigen::Index> at = {0};  // the response
  for (const Eigen::Index column : which) at.push_back(1 + column);
  BlockGrams some = grams;
  some.n_columns = static_cast<Eigen::Index>(which.size());
  for (BlockGrams::Block& block : some.blocks)
    for (Eigen::MatrixXd& gram : block.gram)
      if (gram.size() > 0) gram = Eigen::MatrixXd(gram(at, at));
  return some;
}

std::vector<Eigen::Index> determined_columns(const BlockGrams& grams, const KindLevels& levels,
                                             Eigen::Index n, double least) {
  const Eigen::MatrixXd total = weighted_sum(grams, levels);
  std::vector<Eigen::Index> determined, at = {0};
  for (Eigen::Index column = 0; column < grams.n_columns; ++column) {
    at.push_back(1 + column);
    if (column >= n && !solve_normal(total(at, at), false, {least, 1}))
      at.pop_back();
    else
      determined.push_back(column);
  }
  return determined;
}

Eigen::MatrixXd weighted_sum(const BlockGrams& grams, const KindLevels& levels) {
  const Eigen::Index n = 1 + grams.n_columns;
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(n, n);
  for (const BlockGrams::Block& block : grams.blocks) total += weighted(block, levels, n);
  return total;
}

KindLevels BlockFit::rms() const {
  KindLevels out{};
  for (std::size_t k = 0; k < kRowKinds; ++k)
    out[k] = n_rows[k] > 0 ? std::sqrt(squares[k] / n_rows[k]) : 0;
  return out;
}

Eigen::Index count_blocks(const BlockGrams& grams) {
  return std::count_if(grams.blocks.begin(), grams.blocks.end(), has_rows);
}

double BlockFit::held_out_error(const BlockFit& base) const {
  if ((alone && !base.alone).any()) return kUnbounded;
  return base.alone.select(0, held_out).sum();
}

std::optional<BlockFit> fit_blocks(const BlockGrams& grams, const KindLevels& levels,
                                   bool with_held_out, const OwnPart& own) {
  const Eigen::Index n = 1 + grams.n_columns;
  std::vector<Eigen::MatrixXd> each;
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(n, n);
  for (const BlockGrams::Block& block : grams.blocks) {
    each.push_back(weighted(block, levels, n));
    total += each.back();
  }
  const auto all = solve_normal(total, true, own);
  if (!all) return {};
  BlockFit fit;
  fit.x = all->x;
  const auto n_blocks = static_cast<Eigen::Index>(each.size());
  fit.in_sample = fit.held_out = Eigen::ArrayXd::Zero(n_blocks);
  fit.alone.setConstant(n_blocks, false);
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(n - 1, n - 1);
  Eigen::VectorXd c(n);
  c << 1.0, -fit.x;
  for (Eigen::Index b = 0; b < n_blocks; ++b) {
    const Eigen::MatrixXd& g = each[static_cast<std::size_t>(b)];
    const Eigen::VectorXd gc = g * c;
    const Eigen::VectorXd score = gc.tail(n - 1);
    meat += score * score.transpose();
    fit.in_sample(b) = std::max(0.0, c.dot(gc));
    if (!with_held_out || !(g(0, 0) > 0)) continue;
    const auto others = solve_normal(total - g, false, {});
    fit.alone(b) = !others;
    if (!others) continue;
    fit.held_out(b) = squared_error(g, others->x);
    for (std::size_t k = 0; k < kRowKinds; ++k)
      fit.held_out_rows[k] +=
          static_cast<double>(grams.blocks[static_cast<std::size_t>(b)].n_rows[k]);
  }
  fit.covariance = all->inverse * meat * all->inverse;
  add_kind_sums(grams, fit);
  return fit;
}

std::vector<std::optional<Eigen::VectorXd>> values_without_each(const BlockGrams& grams,
                                                                const KindLevels& levels) {
  const Eigen::MatrixXd total = weighted_sum(grams, levels);
  std::vector<std::optional<Eigen::VectorXd>> without;
  for (const BlockGrams::Block& block : grams.blocks) {
    auto& x = without.emplace_back();
    if (!has_rows(block)) continue;
    if (auto others = solve_normal(total - weighted(block, levels, total.rows()), false, {}))
      x = std::move(others->x);
  }
  return without;
}

std::optional<Eigen::MatrixXd> jackknife_covariance(const BlockGrams& grams,
                                                    const KindLevels& levels) {
  const Eigen::Index n = 1 + grams.n_columns;
  const auto all = values_without_each(grams, levels);
  std::vector<Eigen::VectorXd> without;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(n - 1);
  for (std::size_t b = 0; b < all.size(); ++b) {
    if (!has_rows(grams.blocks[b])) continue;
    if (!all[b]) return {};
    without.push_back(*all[b]);
    mean += *all[b];
  }
  const auto blocks = static_cast<double>(without.size());
  if (blocks < 2) return {};
  mean /= blocks;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n - 1, n - 1);
  for (const Eigen::VectorXd& x : without) covariance += (x - mean) * (x - mean).transpose();
  return (blocks - 1) / blocks * covariance;
}

double error_of(const BlockGrams::Block& block, const KindLevels& levels,
                const Eigen::VectorXd& x) {
  return squared_error(weighted(block, levels, 1 + x.size()), x);
}

Eigen::ArrayXd errors_of(const BlockGrams& grams, const KindLevels& levels,
                         const Eigen::VectorXd& x) {
  Eigen::ArrayXd errors(static_cast<Eigen::Index>(grams.blocks.size()));
  for (std::size_t b = 0; b < grams.blocks.size(); ++b)
    errors(static_cast<Eigen::Index>(b)) = error_of(grams.blocks[b], levels, x);
  return errors;
}

KindLevels rms_of(const BlockGrams& grams, const Eigen::VectorXd& x) {
  BlockFit fit;
  fit.x = x;
  add_kind_sums(grams, fit);
  return fit.rms();
}

}  // namespace cablefit
