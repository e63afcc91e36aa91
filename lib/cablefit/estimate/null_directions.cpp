#include "cablefit/estimate/null_directions.hpp"

#include <fmt/format.h>

#include <cmath>

namespace cablefit {
namespace {

constexpr double kNullComponent = 0.05;  // share in a null direction that counts as taking part

std::string null_text(const Eigen::VectorXd& direction, Eigen::Index self,
                      const std::vector<std::string>& names) {
  std::string others;
  for (Eigen::Index k = 0; k < direction.size(); ++k) {
    if (k == self || std::abs(direction(k)) < kNullComponent) continue;
    others += (others.empty() ? "" : ", ") + names[static_cast<std::size_t>(k)];
  }
  if (others.empty()) return "its column is zero: the log never excites it";
  return fmt::format("cannot be told apart from {} in these logs", others);
}

}  // namespace

std::vector<std::string> name_null_directions(const Eigen::MatrixXd& null_directions,
                                              const std::vector<std::string>& names) {
  std::vector<std::string> texts(names.size());
  for (Eigen::Index d = 0; d < null_directions.cols(); ++d) {
    const Eigen::VectorXd direction = null_directions.col(d);
    for (Eigen::Index k = 0; k < direction.size(); ++k)
      if (std::abs(direction(k)) >= kNullComponent)
        texts[static_cast<std::size_t>(k)] = null_text(direction, k, names);
  }
  return texts;
}

}  // namespace cablefit
