#include "cablefit/samples/decimation.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

/// Column by column the weighted mean about each centre.
template <class Columns>
void weigh(const Columns& columns, const Eigen::VectorXd& taps, Eigen::Index centre,
           Eigen::Index first, Eigen::Index last, Eigen::Ref<Eigen::RowVectorXd> out) {
  const Eigen::Index half = taps.size() / 2;
  const Eigen::Index from = std::max(first, centre - half);
  const Eigen::Index to = std::min(last, centre + half + 1);
  const auto inside = taps.segment(from - (centre - half), to - from);
  out.noalias() = inside.transpose() * columns.middleRows(from, to - from);
  if (to - from != taps.size()) out /= inside.sum();
}

}  // namespace

Decimation::Decimation(int factor) : factor_(factor) {
  constexpr double pi = 3.14159265358979323846;
  const Eigen::Index half = half_width();
  taps_.resize(2 * half + 1);
  for (Eigen::Index k = -half; k <= half; ++k) {
    const double x = static_cast<double>(k) / factor_;
    const double sinc = k == 0 ? 1 : std::sin(pi * x) / (pi * x);
    const double window =
        half == 0 ? 1
                  : 0.54 + 0.46 * std::cos(pi * static_cast<double>(k) / static_cast<double>(half));
    taps_(half + k) = sinc * window;
  }
  taps_ /= taps_.sum();
  const Eigen::Index n = taps_.size();
  averaging_taps_ = Eigen::VectorXd::Zero(n + 2);
  averaging_taps_.head(n) += taps_ / 12;
  averaging_taps_.segment(1, n) += taps_ * (10.0 / 12);
  averaging_taps_.tail(n) += taps_ / 12;
}

Eigen::MatrixXd Decimation::apply(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                                  std::span<const Eigen::Index> centres, Eigen::Index first,
                                  Eigen::Index last, const std::vector<bool>& averaged) const {
  const auto n = static_cast<Eigen::Index>(centres.size());
  const bool any = std::find(averaged.begin(), averaged.end(), true) != averaged.end();
  // Row-major while it is filled row by row.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> out(n, columns.cols());
  Eigen::RowVectorXd row(columns.cols());
  for (Eigen::Index i = 0; i < n; ++i) {
    weigh(columns, any ? averaging_taps_ : taps_, centres[static_cast<std::size_t>(i)], first, last,
          row);
    out.row(i) = row;
  }
  for (std::size_t k = 0; any && k < averaged.size(); ++k) {
    if (averaged[k]) continue;
    const auto column = static_cast<Eigen::Index>(k);
    for (Eigen::Index i = 0; i < n; ++i)
      weigh(columns.col(column), taps_, centres[static_cast<std::size_t>(i)], first, last,
            out.block(i, column, 1, 1));
  }
  return out;
}

}  // namespace cablefit
