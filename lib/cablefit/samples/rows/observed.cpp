#include "cablefit/samples/rows/observed.hpp"

#include <limits>

namespace cablefit {

Equation with_observed(const Equation& equation, const std::vector<Observed>& observed) {
  Equation more = equation;
  const auto n_own = static_cast<Eigen::Index>(equation.columns.size());
  more.shares_columns = false;
  more.columns.resize(equation.columns.size() + observed.size());
  more.averaged.resize(more.columns.size(), false);
  more.fill = [fill = equation.fill, observed, n_own](const Signals& signals,
                                                      Eigen::Ref<Eigen::MatrixXd> out) {
    fill(signals, out.leftCols(n_own));
    Eigen::Index next = n_own;
    for (const Observed& one : observed) {
      const Eigen::ArrayXd values = one.value(signals);
      if (values.size() == out.rows()) {
        out.col(next) = values;
      } else {
        out.col(next).setConstant(std::numeric_limits<double>::quiet_NaN());
      }
      ++next;
    }
  };
  return more;
}

}  // namespace cablefit
