#include <fmt/core.h>

#include "cablefit/model/json_reading.hpp"
#include "cablefit/model/pair_maps/kinds.hpp"

namespace cablefit::pair_maps {

Eigen::MatrixXd read_matrix(const JsonNode& node) {
  const std::vector<JsonNode>& rows = some_items(node);
  Eigen::MatrixXd matrix;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<double> row = rows[i].numbers();
    const auto n = static_cast<Eigen::Index>(row.size());
    if (i == 0) matrix.resize(static_cast<Eigen::Index>(rows.size()), n);
    if (n != matrix.cols())
      throw rows[i].error(fmt::format("{} number(s), the first list has {}", n, matrix.cols()),
                          "give lists of one length");
    matrix.row(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), n);
  }
  return matrix;
}

std::vector<std::vector<double>> lists_of(const Eigen::MatrixXd& matrix) {
  std::vector<std::vector<double>> lists;
  for (const auto& row : matrix.rowwise()) lists.emplace_back(row.begin(), row.end());
  return lists;
}

}  // namespace cablefit::pair_maps
