#include "cablefit/identify/equations/joint_equations.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

Eigen::Index n_coefficients(const Transmission& transmission) {
  Eigen::Index n = 0;
  for (const Cable& cable : transmission.cables) n += cable.n_coefficients();
  return n;
}

/// d l / d ln r_m of a round pulley on the motor of a joint: the way that it winds up from the
/// reference pose.
Eigen::ArrayXd wound_up(const Transmission& transmission, const Cable& cable, std::size_t joint,
                        std::span<const JointSignals> joints) {
  const auto k = static_cast<Eigen::Index>(joint);
  const Eigen::ArrayXd turned = joints[joint].theta - transmission.encoder_zero()(k);
  return cable.motor_map[joint].radius(0) * (turned - transmission.reference_theta()(k));
}

/// Whose radii an equation has columns for.
struct Turning {
  SearchedRadii searched;
  std::optional<std::size_t> motor;  ///< whose torques balance; none: a link's
};
Turning turning_of(const JointEquation& equation) {
  Turning turning{equation.searched_radius, {}};
  if (equation.motor_side) turning.motor = static_cast<std::size_t>(equation.joint);
  return turning;
}

/// Derivatives of `basis` with respect to ln r_m of the cables whose r_m is searched.
void fill_turn(const Transmission& transmission, std::span<const JointSignals> joints,
               const Turning& turning, const Eigen::Ref<const Eigen::MatrixXd>& basis,
               const Eigen::Ref<const Eigen::MatrixXd>& slope, Eigen::Ref<Eigen::MatrixXd> turn) {
  turn.setZero();
  Eigen::Index first = 0;
  for (std::size_t c = 0; c < transmission.cables.size(); ++c) {
    const Cable& cable = transmission.cables[c];
    const Eigen::Index n = cable.n_coefficients();
    if (const auto joint = turning.searched[c]) {
      const Eigen::ArrayXd wound = wound_up(transmission, cable, *joint, joints);
      // r_m is the lever of the force on its motor as well.
      const bool is_lever = turning.motor == joint;
      for (Eigen::Index k = first; k < first + n; ++k) {
        turn.col(k) = slope.col(k).array() * wound;
        if (is_lever) turn.col(k) += basis.col(k);
      }
    }
    first += n;
  }
}

/// Torque of a joint (from 0) per unit coefficient, and its derivative with respect to l; rows x
/// coefficients each. Cables that do not act on the joint leave zeros.
void fill_elastic(const Transmission& transmission, std::span<const JointSignals> joints, int joint,
                  bool motor_side, Eigen::Ref<Eigen::MatrixXd> basis,
                  Eigen::Ref<Eigen::MatrixXd> slope) {
  const auto own = static_cast<std::size_t>(joint);
  const MapSide side = motor_side ? MapSide::motor : MapSide::link;
  std::array<double, kMaxCableOrder> value{}, rise{};
  Eigen::Index first = 0;
  for (const Cable& cable : transmission.cables) {
    const int n = cable.n_coefficients();
    const SideMaps maps = motor_side ? cable.motor_side() : cable.link_side();
    basis.middleCols(first, n).setZero();
    slope.middleCols(first, n).setZero();
    first += n;
    if (!maps.passes(own)) continue;
    const Eigen::ArrayXd l = elongation(transmission, cable, joints);
    const Eigen::ArrayXd gain = levers(transmission, cable, joints, side, own);
    const LawShape shape = cable.shape();
    for (Eigen::Index i = 0; i < l.size(); ++i) {
      if (!(l(i) > 0)) continue;
      cable.law->basis(shape, l(i), value.data());
      cable.law->slope(shape, l(i), rise.data());
      for (int k = 0; k < n; ++k) {
        basis(i, first - n + k) = gain(i) * value[static_cast<std::size_t>(k)];
        slope(i, first - n + k) = gain(i) * rise[static_cast<std::size_t>(k)];
      }
    }
  }
}

/// Columns of one choice of l_o.
Eigen::Index n_of_trial(const JointEquation& equation, Eigen::Index n_coefficients) {
  const JointColumns c = joint_columns(equation, n_coefficients);
  return c.count - c.basis;
}

/// Columns of `base`, the deflection, then those of every trial.
Equation widened(const JointEquation& equation, const std::vector<Transmission>& trials) {
  const Eigen::Index n_base = equation.n_base();
  const Eigen::Index n = n_coefficients(trials.front());
  const Eigen::Index n_own = n_of_trial(equation, n);
  Equation wide = equation.base;
  const auto extra = static_cast<std::size_t>(1 + n_own * static_cast<Eigen::Index>(trials.size()));
  // Averaged like the other columns of the same equation: see Decimation.
  const bool averaged = equation.base.averaged.empty() || equation.base.averaged.front();
  wide.columns.resize(wide.columns.size() + extra);
  wide.averaged.resize(wide.columns.size(), averaged);
  wide.fill = [base = equation.base, n_base, n, n_own, trials, motor_side = equation.motor_side,
               joint = equation.joint, turning = turning_of(equation)](
                  const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
    base.fill(signals, out.leftCols(n_base));
    const JointSignals& s = signals.joints[static_cast<std::size_t>(joint)];
    out.col(n_base) = trials.front().deflections(joint, s.q, s.theta);
    Eigen::Index first = n_base + 1;
    for (const Transmission& trial : trials) {
      fill_elastic(trial, signals.joints, joint, motor_side, out.middleCols(first, n),
                   out.middleCols(first + n, n));
      if (n_own > 2 * n)
        fill_turn(trial, signals.joints, turning, out.middleCols(first, n),
                  out.middleCols(first + n, n), out.middleCols(first + 2 * n, n));
      first += n_own;
    }
  };
  return wide;
}

/// The same with l - l_o of every cable, last.
Equation with_displacements(Equation equation, Transmission cables) {
  const auto n = static_cast<Eigen::Index>(equation.columns.size());
  equation.columns.resize(equation.columns.size() + cables.cables.size());
  equation.averaged.resize(equation.columns.size(), equation.averaged.front());
  for (Cable& cable : cables.cables) cable.initial_elongation = 0;
  equation.fill = [fill = std::move(equation.fill), n, cables = std::move(cables)](
                      const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
    fill(signals, out.leftCols(n));
    Eigen::Index column = n;
    for (const Cable& cable : cables.cables)
      out.col(column++) = elongation(cables, cable, signals.joints);
  };
  return equation;
}

/// One window's share of one equation, per trial.
struct Share {
  std::vector<RowStatistics> rows;
  EquationFacts facts;
};

Share share_of(const EquationBatch& batch, Eigen::Index n_shared, Eigen::Index n_own,
               std::size_t n_trials, const RowStatistics& blank) {
  Share share;
  share.facts.counts = batch.counts;
  const Eigen::Index n_of_trials = n_shared + static_cast<Eigen::Index>(n_trials) * n_own;
  share.facts.displacements.resize(static_cast<std::size_t>(batch.rows.cols() - n_of_trials));
  share.rows.assign(n_trials, blank.empty_copy());
  if (batch.rows.rows() == 0) return share;
  share.facts.deflection_low = batch.rows.col(n_shared - 1).minCoeff();
  share.facts.deflection_high = batch.rows.col(n_shared - 1).maxCoeff();
  for (std::size_t c = 0; c < share.facts.displacements.size(); ++c)
    share.facts.displacements[c].include(
        batch.rows.col(n_of_trials + static_cast<Eigen::Index>(c)));
  Eigen::MatrixXd rows(batch.rows.rows(), n_shared + n_own);
  rows.leftCols(n_shared) = batch.rows.leftCols(n_shared);
  for (std::size_t t = 0; t < n_trials; ++t) {
    const Eigen::Index first = n_shared + static_cast<Eigen::Index>(t) * n_own;
    rows.rightCols(n_own) = batch.rows.middleCols(first, n_own);
    share.rows[t].add(rows, batch.numbers);
  }
  return share;
}

void collect_record(std::span<const LogSurvey> logs, const JointRecord& record,
                    const std::vector<Transmission>& trials, bool with_cells, int threads,
                    JointRows& out) {
  // The equations of a record are of one rig, so that they all have the columns of r_m or none.
  const Eigen::Index n_own = n_of_trial(record.equations.front(), n_coefficients(trials.front()));
  const Eigen::Index expected = expected_rows(logs, record.wanted, record.settings);
  std::vector<Equation> wide;
  std::vector<RowStatistics> blank;
  const std::size_t first = out.facts.size();
  for (const JointEquation& equation : record.equations) {
    wide.push_back(with_displacements(widened(equation, trials), trials.front()));
    blank.emplace_back(equation.n_base() + 1 + n_own, expected, with_cells);
    for (auto& trial : out.rows) trial.push_back(blank.back());
    out.facts.emplace_back().displacements.resize(trials.front().cables.size());
  }
  stream_rows(
      logs, record.wanted, record.settings, wide, threads,
      [&](const RowBatch& batch) {
        std::vector<Share> shares;
        for (std::size_t e = 0; e < wide.size(); ++e)
          shares.push_back(share_of(batch.equations[e], record.equations[e].n_base() + 1, n_own,
                                    trials.size(), blank[e]));
        return shares;
      },
      [&](std::vector<Share>&& shares) {
        for (std::size_t e = 0; e < wide.size(); ++e) {
          for (std::size_t t = 0; t < trials.size(); ++t)
            out.rows[t][first + e].add(std::move(shares[e].rows[t]));
          out.facts[first + e] += shares[e].facts;
        }
      });
}

}  // namespace

EquationFacts& EquationFacts::operator+=(const EquationFacts& other) {
  counts += other.counts;
  deflection_low = std::min(deflection_low, other.deflection_low);
  deflection_high = std::max(deflection_high, other.deflection_high);
  for (std::size_t c = 0; c < displacements.size(); ++c)
    displacements[c].include(other.displacements[c]);
  return *this;
}

JointColumns joint_columns(const JointEquation& equation, Eigen::Index n) {
  const Eigen::Index basis = equation.n_base() + 1;
  const Eigen::Index turn = basis + 2 * n;
  const bool turns = searches_radius(equation.searched_radius);
  return {equation.n_base(), basis, basis + n, turn, turn + (turns ? n : 0)};
}

Equation equation_at(const JointEquation& equation, const Transmission& cables) {
  return widened(equation, {cables});
}

bool searches_radius(const SearchedRadii& searched) {
  return std::any_of(searched.begin(), searched.end(),
                     [](const auto& joint) { return joint.has_value(); });
}

bool searches_radius(const PreloadJob& job) { return searches_radius(job.searched_radius); }

Transmission with_elongations(Transmission transmission, const Eigen::VectorXd& l_o) {
  for (std::size_t c = 0; c < transmission.cables.size(); ++c)
    transmission.cables[c].initial_elongation = l_o(static_cast<Eigen::Index>(c));
  return transmission;
}

Eigen::VectorXd elongations_of(const Transmission& transmission) {
  Eigen::VectorXd l_o(static_cast<Eigen::Index>(transmission.cables.size()));
  for (std::size_t c = 0; c < transmission.cables.size(); ++c)
    l_o(static_cast<Eigen::Index>(c)) = transmission.cables[c].initial_elongation;
  return l_o;
}

JointRows collect(std::span<const LogSurvey> logs, const PreloadJob& job,
                  const std::vector<Eigen::VectorXd>& elongations, bool with_cells, int threads) {
  std::vector<Transmission> trials;
  for (const Eigen::VectorXd& l_o : elongations)
    trials.push_back(with_elongations(job.transmission, l_o));
  JointRows out;
  out.rows.resize(trials.size());
  for (const JointRecord& record : job.records)
    collect_record(logs, record, trials, with_cells, threads, out);
  return out;
}

}  // namespace cablefit
