#include "cablefit/model/arm/base_parameters.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "cablefit/base/error.hpp"
#include "cablefit/base/random.hpp"

namespace cablefit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::uint64_t kSeed = 1991;
// Rms of a column that is rounding of 0: motions are of order 1 to 10, so rounding leaves 1e-15,
// while a mass at 10 um still gives 1e-10.
constexpr double kNothing = 1e-12;
// Below this share of the first, a diagonal of R is rounding (1e-14), or so little that no log
// shows it; axes a thousandth of a radian from parallel give 1e-6.
constexpr double kSmall = 1e-8;
constexpr double kRounding = 1e-13;
constexpr double kNoFactor = 1e-9;
constexpr std::size_t kLongName = 60;

LinkParameter kind_of(Index parameter) {
  return static_cast<LinkParameter>(parameter % kLinkParameters);
}

/// Torques of all joints, one below the other, at random motions; a column per parameter.
MatrixXd sampled_columns(const SerialChain& chain) {
  const Index n = chain.n_joints();
  const Index n_samples = kLinkParameters + 20;
  Random random(kSeed);
  const auto draw = [&](double size) {
    return Eigen::ArrayXXd::NullaryExpr(n_samples, n,
                                        [&] { return size * (2 * random.uniform() - 1); })
        .eval();
  };
  const Eigen::ArrayXXd q = draw(M_PI), qd = draw(2), qdd = draw(4);
  const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(n_samples);
  std::vector<Motion> links;
  for (Index j = 0; j < n; ++j) links.push_back({q.col(j), qd.col(j), qdd.col(j), none});
  std::vector<Index> all(static_cast<std::size_t>(chain.n_parameters()));
  std::iota(all.begin(), all.end(), Index{0});
  MatrixXd columns(n * n_samples, chain.n_parameters());
  for (Index j = 0; j < n; ++j)
    serial_regressor(chain, links, static_cast<int>(j), all,
                     columns.middleRows(j * n_samples, n_samples));
  return columns;
}

/// Norms of the columns, 0 for those that are rounding.
VectorXd sizes_of(const MatrixXd& columns) {
  const double nothing = kNothing * std::sqrt(static_cast<double>(columns.rows()));
  return columns.colwise().norm().unaryExpr(
      [nothing](double size) { return size <= nothing ? 0 : size; });
}

struct Rank {
  Index rank;
  double threshold;  ///< between what counts and what is rounding
};

/// `scaled`: columns of length 1.
Rank rank_of(const MatrixXd& scaled) {
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(scaled);
  const VectorXd diagonal = qr.matrixQR().diagonal().cwiseAbs();
  const Index n = diagonal.size();
  Index rank = 0;
  while (rank < n && diagonal(rank) > kSmall * diagonal(0)) ++rank;
  const double next = rank == n ? 0 : diagonal(rank);
  return {rank, std::max(kRounding, std::sqrt(diagonal(rank - 1) * next))};
}

/// The letters of an axis along z, moved on to the axis this one is nearest to.
LinkParameter along(LinkParameter of_z, const Eigen::Vector3d& axis) {
  using enum LinkParameter;
  static constexpr std::array<std::array<LinkParameter, 3>, 10> kTurns{{{M, M, M},
                                                                        {MY, MZ, MX},
                                                                        {MZ, MX, MY},
                                                                        {MX, MY, MZ},
                                                                        {YY, ZZ, XX},
                                                                        {YZ, XZ, XY},
                                                                        {XY, YZ, XZ},
                                                                        {ZZ, XX, YY},
                                                                        {XZ, XY, YZ},
                                                                        {XX, YY, ZZ}}};
  Index nearest = 0;
  axis.cwiseAbs().maxCoeff(&nearest);
  return kTurns[static_cast<std::size_t>(of_z)][static_cast<std::size_t>(nearest)];
}

/// All parameters, those to be kept rather than others first.
std::vector<Index> order_of_keeping(const SerialChain& chain) {
  using enum LinkParameter;
  std::vector<Index> order;
  const auto add = [&](std::initializer_list<LinkParameter> kinds) {
    for (Index i = chain.n_joints(); i-- > 0;)
      for (const LinkParameter kind : kinds)
        order.push_back(
            kLinkParameters * i +
            static_cast<Index>(along(kind, chain.joints[static_cast<std::size_t>(i)].axis)));
  };
  if (chain.only_slides()) {  // no link turns: masses are all there is
    add({M});
    add({ZZ, XX, XY, XZ, YZ, MX, MY, YY, MZ});
  } else {
    add({ZZ, XX, XY, XZ, YZ, MX, MY});
    add({YY, MZ, M});
  }
  return order;
}

/// The columns, in that order, that are no combination of kept ones before.
std::vector<Index> kept_columns(const MatrixXd& scaled, const std::vector<Index>& order,
                                const Rank& rank) {
  MatrixXd basis(scaled.rows(), rank.rank);
  std::vector<Index> kept;
  for (const Index k : order) {
    const auto n = static_cast<Index>(kept.size());
    if (n == rank.rank) break;
    VectorXd rest = scaled.col(k);
    for (int pass = 0; pass < 2; ++pass)  // twice is enough (Giraud et al. 2005)
      rest -= basis.leftCols(n) * (basis.leftCols(n).transpose() * rest).eval();
    if (!(rest.norm() > rank.threshold)) continue;
    basis.col(n) = rest.normalized();
    kept.push_back(k);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

bool is_same(double a, double b) { return std::abs(a - b) < kNoFactor; }

std::string parameter_name(const SerialChain& chain, Index parameter) {
  const auto link = static_cast<std::size_t>(parameter / kLinkParameters);
  return fmt::format("{}{}", name_of(kind_of(parameter)), chain.rig_joint[link] + 1);
}

/// "+0.09*M2", "-YY3", "+0.06*(M4+M5)": terms of one factor, from `first` on.
std::string group_text(const SerialChain& chain, std::span<const BaseParameter::Term> terms,
                       std::size_t first, int digits) {
  const double factor = terms[first].factor;
  const std::string size = fmt::format("{:.{}g}", std::abs(factor), digits);
  std::vector<std::string> names;
  for (const BaseParameter::Term& term : terms.subspan(first))
    if (is_same(term.factor, factor)) names.push_back(parameter_name(chain, term.parameter));
  const char* sign = factor < 0 ? "-" : "+";
  if (size == "1") return fmt::format("{}{}", sign, fmt::join(names, sign));
  if (names.size() == 1) return fmt::format("{}{}*{}", sign, size, names[0]);
  return fmt::format("{}{}*({})", sign, size, fmt::join(names, "+"));
}

void put_names(const SerialChain& chain, BaseParameter& p) {
  p.name = p.combination = parameter_name(chain, p.kept());
  const auto others = std::span<const BaseParameter::Term>(p.terms).subspan(1);
  bool cut = false;
  for (std::size_t k = 0; k < others.size(); ++k) {
    const auto same = [&](const BaseParameter::Term& t) {
      return is_same(t.factor, others[k].factor);
    };
    const auto before = others.first(k);
    if (std::any_of(before.begin(), before.end(), same)) continue;
    const std::string text = group_text(chain, others, k, 3);
    p.combination += group_text(chain, others, k, 6);
    cut = cut || p.name.size() + text.size() > kLongName;
    if (!cut) p.name += text;
  }
  if (cut) p.name += "+...";
}

bool is_never_negative(const BaseParameter::Term& term) {
  using enum LinkParameter;
  const LinkParameter kind = kind_of(term.parameter);
  return term.factor > 0 && (kind == M || kind == XX || kind == YY || kind == ZZ);
}

/// Columns of `kept` combined into the others: kept x all, rows in units of each column.
MatrixXd factors_of(const MatrixXd& scaled, const VectorXd& sizes, const std::vector<Index>& kept) {
  MatrixXd chosen(scaled.rows(), static_cast<Index>(kept.size()));
  for (std::size_t k = 0; k < kept.size(); ++k)
    chosen.col(static_cast<Index>(k)) = scaled.col(kept[k]);
  MatrixXd factors = chosen.householderQr().solve(scaled);
  for (std::size_t k = 0; k < kept.size(); ++k)
    factors.row(static_cast<Index>(k)) *= 1 / sizes(kept[k]);
  return factors * sizes.asDiagonal();
}

}  // namespace

double BaseParameter::value(const SerialChain& chain) const {
  double sum = 0;
  for (const Term& term : terms)
    sum += term.factor *
           chain.joints[static_cast<std::size_t>(term.parameter / kLinkParameters)].inertia(
               term.parameter % kLinkParameters);
  return sum;
}

std::vector<BaseParameter> base_parameters_of(const SerialChain& chain) {
  MatrixXd scaled = sampled_columns(chain);
  const VectorXd sizes = sizes_of(scaled);
  if (!sizes.allFinite())
    throw Error(ErrorKind::input,
                "the arm's lengths or its gravity are too large to compute with; give m and "
                "m/s^2");
  for (Index k = 0; k < sizes.size(); ++k) scaled.col(k) *= sizes(k) > 0 ? 1 / sizes(k) : 0;
  const std::vector<Index> kept = kept_columns(scaled, order_of_keeping(chain), rank_of(scaled));
  const MatrixXd factors = factors_of(scaled, sizes, kept);
  std::vector<BaseParameter> all;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    BaseParameter& p = all.emplace_back();
    p.terms = {{kept[k], 1}};
    for (Index other = 0; other < sizes.size(); ++other) {
      const double factor = factors(static_cast<Index>(k), other);
      const bool is_kept = std::binary_search(kept.begin(), kept.end(), other);
      if (!is_kept && std::abs(factor) > kNoFactor) p.terms.push_back({other, factor});
    }
    put_names(chain, p);
    p.unit = unit_of(kind_of(kept[k]));
    p.lower = std::all_of(p.terms.begin(), p.terms.end(), is_never_negative) ? 0 : -kUnbounded;
  }
  return all;
}

}  // namespace cablefit
