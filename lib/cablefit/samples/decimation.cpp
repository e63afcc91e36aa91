#include "cablefit/samples/decimation.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {

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
}

void Decimation::apply(const Eigen::Ref<const Eigen::MatrixXd>& columns, Eigen::Index centre,
                       Eigen::Index first, Eigen::Index last,
                       Eigen::Ref<Eigen::RowVectorXd> out) const {
  const Eigen::Index half = half_width();
  const Eigen::Index from = std::max(first, centre - half);
  const Eigen::Index to = std::min(last, centre + half + 1);
  const auto taps = taps_.segment(from - (centre - half), to - from);
  out.noalias() = taps.transpose() * columns.middleRows(from, to - from);
  if (to - from != taps_.size()) out /= taps.sum();
}

}  // namespace cablefit
