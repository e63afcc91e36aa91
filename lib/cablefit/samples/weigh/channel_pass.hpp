// One pass over the samples of a log for something that every channel of every part keeps.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// For each slot that is `wanted`: calls states[part][slot].begin() where a part does not go on
/// from the row before, and .add(t, values, row) for the samples that follow each other; `row` is
/// the first one's in the log as it is read.
template <class State>
void over_channels(const LogSurvey& log, bool (*wanted)(const Slot&),
                   std::vector<std::vector<State>>& states) {
  using Values = Eigen::Map<const Eigen::ArrayXd>;
  std::vector<bool> columns{true};  // the first is the time
  for (const Slot& slot : log.plan.slots) columns.push_back(wanted(slot));
  Eigen::MatrixXd rows;
  std::size_t row = 0;
  for (const SamplePiece& piece : log.samples->pieces()) {
    std::vector<State>& part = states[piece.part];
    log.samples->read(piece, rows, columns);
    for (std::size_t k = 0; k < part.size(); ++k) {
      if (!columns[k + 1]) continue;
      if (!piece.follows) part[k].begin();
      const auto column = static_cast<Eigen::Index>(k) + 1;
      part[k].add(Values(rows.data(), rows.rows()), Values(rows.col(column).data(), rows.rows()),
                  row);
    }
    row += static_cast<std::size_t>(piece.n_rows);
  }
}

}  // namespace cablefit
