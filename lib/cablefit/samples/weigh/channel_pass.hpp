// One pass over the samples of a log for something that every channel of every part keeps.
#pragma once

#include <utility>
#include <vector>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// For each slot that is `wanted`: calls states[part][slot].begin() where a part does not go on
/// from the row before, and .add(t, value, row) for each sample; `row` counts the rows of the log
/// as it is read.
template <class State>
void over_channels(const LogSurvey& log, bool (*wanted)(const Slot&),
                   std::vector<std::vector<State>>& states) {
  Eigen::MatrixXd rows;
  std::size_t row = 0;
  for (const SamplePiece& piece : log.samples->pieces()) {
    std::vector<State>& part = states[piece.part];
    log.samples->read(piece, rows);
    for (std::size_t k = 0; k < part.size(); ++k) {
      if (!wanted(log.plan.slots[k])) continue;
      State state = std::move(part[k]);  // a local one stays in registers
      if (!piece.follows) state.begin();
      const auto column = static_cast<Eigen::Index>(k) + 1;
      for (Eigen::Index i = 0; i < rows.rows(); ++i)
        state.add(rows(i, 0), rows(i, column), row + static_cast<std::size_t>(i));
      part[k] = std::move(state);
    }
    row += static_cast<std::size_t>(piece.n_rows);
  }
}

}  // namespace cablefit
