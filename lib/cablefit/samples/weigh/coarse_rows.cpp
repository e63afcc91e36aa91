#include "cablefit/samples/weigh/coarse_rows.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr double kCoarseRate = 50;          // Hz, of the block means
constexpr std::size_t kMostBlocks = 20000;  // of a log; bounds time and memory
constexpr std::size_t kFewestBlocks = 200;  // of a short part, as far as it has rows
constexpr double kBlockGap = 1.5;           // times its usual length: a block spans a gap

std::size_t block_rows(const PartSurvey& part) {
  const double by_rate = std::min(1 / part.period / kCoarseRate, 1e6);
  const std::size_t by_length = part.n_rows / kFewestBlocks;
  return std::max<std::size_t>(1, std::min(static_cast<std::size_t>(by_rate), by_length));
}

/// Means of [t, slots] over blocks, in the order of the rows.
class BlockMeans {
 public:
  BlockMeans(const PartSurvey& part, std::size_t n_columns, std::size_t n_parts)
      : most_(std::max(kFewestBlocks, kMostBlocks / n_parts)),
        n_rows_(static_cast<Eigen::Index>(block_rows(part))),
        longest_(kBlockGap * part.period * static_cast<double>(n_rows_)),
        sum_(Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(n_columns))) {}

  bool full() const { return means_.size() >= most_; }
  void begin_stretch() {
    n_ = 0;
    sum_.setZero();
  }
  void add(const Eigen::Ref<const Eigen::RowVectorXd>& row) {
    if (n_ == 0) first_t_ = row(0);
    sum_ += row;
    if (++n_ < n_rows_) return;
    if (row(0) - first_t_ <= longest_) means_.push_back(sum_ / static_cast<double>(n_));
    begin_stretch();
  }
  /// Blocks that lie one block length from both neighbours.
  std::vector<Eigen::Index> inner() const {
    std::vector<Eigen::Index> found;
    const auto step = [&](std::size_t k) { return means_[k](0) - means_[k - 1](0); };
    for (std::size_t k = 1; k + 1 < means_.size(); ++k)
      if (step(k) > 0 && step(k) <= longest_ && step(k + 1) > 0 && step(k + 1) <= longest_)
        found.push_back(static_cast<Eigen::Index>(k));
    return found;
  }
  Eigen::ArrayXd column(Eigen::Index k) const {
    Eigen::ArrayXd values(static_cast<Eigen::Index>(means_.size()));
    for (Eigen::Index i = 0; i < values.size(); ++i)
      values(i) = means_[static_cast<std::size_t>(i)](k);
    return values;
  }

 private:
  std::size_t most_;
  Eigen::Index n_rows_, n_ = 0;
  double longest_, first_t_ = 0;
  Eigen::RowVectorXd sum_;
  std::vector<Eigen::RowVectorXd> means_;
};

BlockMeans block_means(const LogSurvey& log, std::size_t part) {
  BlockMeans means(log.parts[part], 1 + log.plan.slots.size(), log.parts.size());
  Eigen::MatrixXd rows;
  for (const SamplePiece& piece : log.samples->pieces()) {
    if (piece.part != part || means.full()) continue;
    log.samples->read(piece, rows);
    if (!piece.follows) means.begin_stretch();
    for (Eigen::Index i = 0; i < rows.rows() && !means.full(); ++i) means.add(rows.row(i));
  }
  return means;
}

Eigen::ArrayXd load_of(const LogPlan& plan, const CoarsePart::Joint& joint,
                       const Eigen::ArrayXd& column) {
  const Load& load = plan.rig.load;
  if (load.law == nullptr || load.law->from_column) return column;
  const Eigen::ArrayXd& position = joint.q.size() > 0 ? joint.q : joint.theta;
  return position.unaryExpr([&](double q) { return load.law->torque(load.parameters, q); });
}

CoarsePart coarse_part(const LogSurvey& log, std::size_t log_index, std::size_t part_index) {
  const BlockMeans means = block_means(log, part_index);
  CoarsePart part{log_index, part_index, means.column(0), {}, means.inner()};
  for (int k = 0; k < log.plan.rig.n_joints(); ++k) {
    const auto column = [&](Channel channel) {
      const int slot = log.plan.find(channel, k);
      return slot < 0 ? Eigen::ArrayXd() : means.column(slot + 1);
    };
    CoarsePart::Joint joint{column(Channel::q),   column(Channel::theta),     column(Channel::w),
                            column(Channel::tau), column(Channel::theta_ref), {}};
    joint.load = load_of(log.plan, joint, column(Channel::tau_load));
    part.joints.push_back(std::move(joint));
  }
  return part;
}

}  // namespace

std::vector<CoarsePart> coarse_parts(std::span<const LogSurvey> logs) {
  std::vector<CoarsePart> parts;
  for (std::size_t l = 0; l < logs.size(); ++l)
    for (std::size_t p = 0; p < logs[l].parts.size(); ++p)
      parts.push_back(coarse_part(logs[l], l, p));
  return parts;
}

CoarseRates coarse_rates(const CoarsePart& part, const Eigen::ArrayXd& x) {
  const auto n = static_cast<Eigen::Index>(part.inner.size());
  CoarseRates rates{Eigen::ArrayXd(n), Eigen::ArrayXd(n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index i = part.inner[static_cast<std::size_t>(k)];
    const double h = (part.t(i + 1) - part.t(i - 1)) / 2;
    rates.first(k) = (x(i + 1) - x(i - 1)) / (2 * h);
    rates.second(k) = (x(i + 1) - 2 * x(i) + x(i - 1)) / (h * h);
  }
  return rates;
}

Eigen::ArrayXd at_inner(const CoarsePart& part, const Eigen::ArrayXd& x) {
  Eigen::ArrayXd values(static_cast<Eigen::Index>(part.inner.size()));
  for (Eigen::Index k = 0; k < values.size(); ++k)
    values(k) = x(part.inner[static_cast<std::size_t>(k)]);
  return values;
}

CoarseLine coarse_line(const Eigen::ArrayXd& x, const Eigen::ArrayXd& y) {
  if (x.size() < 3) return {};
  const Eigen::ArrayXd dx = x - x.mean(), dy = y - y.mean();
  const double xx = dx.square().sum(), yy = dy.square().sum(), xy = (dx * dy).sum();
  if (!(xx > 0) || !(yy > 0)) return {};
  return {xy / xx, xy / std::sqrt(xx * yy)};
}

double usual_slope_error(double correlation) {
  return std::max(0.0, 1 / (correlation * correlation) - 1);
}

double largest_slope_error(double correlation) { return std::sqrt(usual_slope_error(correlation)); }

double coarse_range(const Eigen::ArrayXd& x) {
  return x.size() == 0 ? 0 : x.maxCoeff() - x.minCoeff();
}

}  // namespace cablefit
