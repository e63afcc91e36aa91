#include "cablefit/dynamic/loops/instrumented_rows.hpp"

#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

/// The signals of the first joints only, as if there were no simulated ones.
Signals measured(const Signals& signals, int n_joints) {
  return {signals.first,    signals.begin,
          signals.end,      signals.t0,
          signals.period,   {signals.joints.begin(), signals.joints.begin() + n_joints},
          signals.log_began};
}

const Eigen::ArrayXd& speed_of(Side side, const JointSignals& joint) {
  return side == Side::link ? joint.qd : joint.thetad;
}

}  // namespace

Equation with_instruments(const EquationRows& e, int n_joints, LoopKind loop) {
  Equation more = e.equation;
  const Eigen::Index own = e.columns.count, extra = e.columns.n_effects;
  more.columns.resize(static_cast<std::size_t>(own + extra));
  more.averaged.resize(more.columns.size(), true);
  const auto copy =
      static_cast<std::size_t>(n_joints) + static_cast<std::size_t>(e.columns.place.joint);
  more.fill = [fill = e.equation.fill, columns = e.columns, own, extra, n_joints, copy](
                  const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
    fill(measured(signals, n_joints), out.leftCols(own));
    effect_columns(columns, signals, copy, out.rightCols(extra));
  };
  const Side side = e.columns.side;
  const bool by_either = side == Side::motor || !keeps_disturbances_out(loop);
  more.speed = [side, by_either, copy, n_joints](const Signals& signals) -> Eigen::ArrayXd {
    const JointSignals& simulated = signals.joints[copy];
    const JointSignals& seen = signals.joints[copy - static_cast<std::size_t>(n_joints)];
    const auto& speed = speed_of(side, simulated);
    if (!by_either) return speed;
    return speed.abs().min(speed_of(side, seen).abs());
  };
  return more;
}

std::vector<InstrumentedRows> collect_instrumented(const DynamicJob& job,
                                                   std::span<const LogSurvey> simulated,
                                                   const std::vector<EquationRows>& equations,
                                                   LoopKind loop) {
  const Eigen::Index expected = expected_rows(simulated, job.wanted, job.settings.rows);
  std::vector<Equation> with;
  std::vector<InstrumentedRows> all;
  for (const EquationRows& e : equations) {
    with.push_back(with_instruments(e, job.n_joints(), loop));
    all.push_back(
        {RowStatistics(e.columns.count + e.columns.n_effects, expected, job.options.robust_sd),
         {}});
  }
  const std::vector<InstrumentedRows> blank = all;
  stream_rows(
      simulated, job.wanted, job.settings.rows, with, job.options.samples.threads,
      [&](const RowBatch& batch) {
        std::vector<InstrumentedRows> shares;
        for (std::size_t k = 0; k < with.size(); ++k) {
          const EquationBatch& own = batch.equations[k];
          shares.push_back({blank[k].rows.empty_copy(), own.counts});
          shares.back().rows.add(own.rows, own.numbers);
        }
        return shares;
      },
      [&](std::vector<InstrumentedRows>&& shares) {
        for (std::size_t k = 0; k < with.size(); ++k) {
          all[k].rows.add(std::move(shares[k].rows));
          all[k].counts += shares[k].counts;
        }
      });
  return all;
}

LinearProblem instrumented_problem(const DynamicJob& job, const EquationRows& e,
                                   std::size_t which) {
  LinearProblem problem = problem_of(e.columns, job.elastic, which);
  problem.response.conservativeResizeLike(
      Eigen::VectorXd::Zero(e.columns.count + e.columns.n_effects));
  for (Eigen::Index k = 0; k < e.columns.n_effects; ++k)
    problem.instruments.push_back(e.columns.count + k);
  return problem;
}

}  // namespace cablefit
