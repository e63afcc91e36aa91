#include "cablefit/samples/survey/gapless_rows.hpp"

#include <utility>
#include <vector>

#include "cablefit/samples/survey/windows.hpp"

namespace cablefit {
namespace {

/// All rows of the pieces, which are given up one by one.
Eigen::MatrixXd joined(std::vector<Eigen::MatrixXd>& pieces) {
  Eigen::Index n = 0;
  for (const Eigen::MatrixXd& piece : pieces) n += piece.rows();
  Eigen::MatrixXd rows(n, pieces.front().cols());
  Eigen::Index at = 0;
  for (Eigen::MatrixXd& piece : pieces) {
    rows.middleRows(at, piece.rows()) = piece;
    at += piece.rows();
    piece.resize(0, 0);
  }
  pieces.clear();
  return rows;
}

}  // namespace

Eigen::ArrayXd GaplessRows::column(const LogPlan& plan, Channel channel, int joint) const {
  const int slot = plan.find(channel, joint);
  if (slot < 0) return {};
  return data.col(slot).array();
}

void for_each_run(const LogSurvey& log, const std::function<bool(const PartSurvey&)>& wanted,
                  Eigen::Index least_rows, double bridge,
                  const std::function<void(GaplessRows&&)>& sink) {
  GaplessRows run;
  std::vector<Eigen::MatrixXd> pieces;
  const auto finish = [&] {
    if (pieces.empty()) return;
    run.data = joined(pieces);
    sink(std::move(run));
  };
  for_each_window(log, wanted, 0, least_rows, bridge, [&](Window&& window) {
    if (window.begin == 0) {
      finish();
      run = {window.part, window.t0, window.period, {}};
    }
    pieces.push_back(std::move(window.data));
    return true;
  });
  finish();
}

}  // namespace cablefit
