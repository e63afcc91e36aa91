// Rows of a test equation from a log written by hand.
#pragma once

#include "cablefit/samples/rows/row_stream.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/recover.hpp"

namespace cablefit::test {

inline const PartFilter kAllParts = [](const PartSurvey&) { return true; };

/// Columns theta, thetad, thetadd, direction (filtered), tau and approach; the last not averaged.
inline Equation plain_equation() {
  Equation equation;
  equation.name = "test";
  equation.columns.assign(6, "");
  equation.averaged = {true, true, true, true, true, false};
  equation.fill = [](const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
    const JointSignals& s = signals.joints[0];
    out.col(0) = s.theta;
    out.col(1) = s.thetad;
    out.col(2) = s.thetadd;
    out.col(3) = s.theta_direction;
    out.col(4).setZero();
    if (s.tau.size() > 0) out.col(4) = s.tau;
    out.col(5) = s.approach;
  };
  return equation;
}

/// All rows in order, as one batch.
inline EquationBatch all_rows(const LogSurvey& log, const RowSettings& settings,
                              const Equation& equation, int threads = 1,
                              WindowCounts* windows = nullptr) {
  EquationBatch all;
  std::vector<Eigen::MatrixXd> blocks;
  const WindowCounts counts = stream_rows(
      std::span(&log, 1), kAllParts, settings, std::span(&equation, 1), threads,
      [](RowBatch batch) { return std::move(batch.equations.at(0)); },
      [&](const EquationBatch& batch) {
        blocks.push_back(batch.rows);
        all.numbers.insert(all.numbers.end(), batch.numbers.begin(), batch.numbers.end());
        all.t.insert(all.t.end(), batch.t.begin(), batch.t.end());
        all.counts += batch.counts;
      });
  if (windows != nullptr) *windows = counts;
  all.rows.resize(static_cast<Eigen::Index>(all.numbers.size()),
                  static_cast<Eigen::Index>(equation.columns.size()));
  Eigen::Index next = 0;
  for (const Eigen::MatrixXd& block : blocks) {
    all.rows.middleRows(next, block.rows()) = block;
    next += block.rows();
  }
  return all;
}

/// theta and tau of a smooth motion with noise, n rows at 1 kHz.
inline Columns noisy_log(Eigen::Index n, std::uint64_t seed) {
  const MultiSine motion = {{{0.7, 0.5, 0.3}, {3.1, 0.08, 2.2}, {9.0, 0.01, 4.0}}};
  Normal noise(seed);
  Columns log{{{"t", {}}, {"theta", {}}, {"tau", {}}}};
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    log.columns[0].second.push_back(t);
    log.columns[1].second.push_back(motion.at(t) + 1e-5 * noise());
    log.columns[2].second.push_back(motion.at(t, 2) + noise());
  }
  return log;
}

}  // namespace cablefit::test
