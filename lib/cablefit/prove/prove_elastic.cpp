#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/copies/simulated_copy.hpp"
#include "cablefit/elastic/rows/blocked_rows.hpp"
#include "cablefit/prove/proof_runs.hpp"
#include "cablefit/prove/residual_colour.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/butterworth.hpp"

namespace cablefit {
namespace {

constexpr int kFilterOrder = 4;
constexpr double kWidestBand = 0.4;  // of the rate, for the low-pass

/// Torque of the fit besides the elastic one.
struct Friction {
  double offset = 0, f_sm = 0;
  double f_vm = 0;  ///< which a fit estimates to keep it out of f_sm, and does not report
};

double value_of(const ElasticFit& fit, const char* name) {
  const Estimate* e = find_estimate(fit.parameters, name);
  return e != nullptr && e->not_identifiable.empty() && std::isfinite(e->value) ? e->value : 0;
}

// Of the band of stage 1, for the motion to be followed: the fit's own low-pass, which comes on
// top, must not find it slowed down.
constexpr double kFollowedBand = 4;

/// Positions without most of what sensors added.
Eigen::ArrayXXd smooth(const Eigen::VectorXd& measured, double period, double cutoff) {
  Eigen::MatrixXd column = measured;
  if (cutoff > 0 && cutoff < kWidestBand / period)
    Butterworth(kFilterOrder, cutoff, 1 / period).apply(column, true, true);
  return column.array();
}

// Of the speed below which stage 1 leaves rows out: slower ones rest. What is measured there is
// noisy, and noise can only take from f_sm; a share of 1 costs rows that do move.
constexpr double kRestShare = 0.25;

/// Dry friction: f_sm against the motion; at rest what was measured beside the rest of the model,
/// as far as friction goes. A jump from one side to the other, which no drive makes, would come out
/// of the low-pass as less friction.
void add_friction(const Eigen::ArrayXd& speed, const Eigen::ArrayXd& measured, double f_sm,
                  double rest_speed, Eigen::ArrayXXd& tau) {
  for (Eigen::Index i = 0; i < speed.size(); ++i) {
    const double rest = std::clamp(measured(i) - tau(i, 0), -f_sm, f_sm);
    tau(i, 0) += std::abs(speed(i)) > rest_speed ? (speed(i) > 0 ? f_sm : -f_sm) : rest;
  }
}

/// What the blocked drive does: the logs' motion with the fit's torque. `rest_speed`: of stage 1.
std::vector<SimulationResult> follow(const SimulatedCopy& copy, const ElasticFit& fit,
                                     const Friction& friction, double cutoff, double rest_speed) {
  std::vector<SimulationResult> motions;
  for (const CopyStretch& stretch : copy.stretches) {
    const LogPlan& plan = copy.plans[stretch.log];
    const double period = stretch.period;
    const auto column = [&](Channel channel) {
      return smooth(stretch.measured.col(plan.find(channel, 0)), period, cutoff);
    };
    SimulationResult motion;
    motion.q = column(Channel::q);
    motion.theta = column(Channel::theta);
    motion.tau = Eigen::ArrayXXd::Constant(motion.q.rows(), 1, friction.offset);
    motion.qd = motion.thetad = Eigen::ArrayXXd::Zero(motion.q.rows(), 1);
    Eigen::VectorXd link, motor;
    for (Eigen::Index i = 0; i < motion.q.rows(); ++i) {
      fit.transmission.torques(motion.q.row(i).matrix(), motion.theta.row(i).matrix(), link, motor);
      motion.tau(i, 0) += motor(0);
    }
    const Eigen::Index n = motion.q.rows();
    for (Eigen::Index k = 1; k + 1 < n; ++k)
      motion.thetad(k, 0) = (motion.theta(k + 1, 0) - motion.theta(k - 1, 0)) / (2 * period);
    motion.tau += friction.f_vm * motion.thetad;
    add_friction(motion.thetad.col(0), column(Channel::tau).col(0), friction.f_sm, rest_speed,
                 motion.tau);
    motions.push_back(std::move(motion));
  }
  return motions;
}

void disturb(const SimulatedCopy& copy, const ArModel& colour, Random& random,
             std::vector<SimulationResult>& motions) {
  if (!(colour.sd > 0)) return;
  for (std::size_t k = 0; k < motions.size(); ++k)
    motions[k].tau.col(0) += draw(colour, motions[k].tau.rows(), copy.stretches[k].period, random);
}

/// rows * this = residual of the fit.
Eigen::VectorXd residual_combination(const BlockedRows& rows, const ElasticFit& fit) {
  const BlockedColumns& c = rows.columns;
  Eigen::VectorXd combination = Eigen::VectorXd::Unit(c.count, c.tau);
  combination(c.offset) -= fit.offset;
  combination(c.direction) -= value_of(fit, "f_sm");
  if (fit.transmission.cables.empty())
    combination(c.deflection) -= fit.transmission.linear_stiffness(0);
  Eigen::Index first = c.basis;
  for (std::size_t i = 0; i < fit.transmission.cables.size(); ++i) {
    const std::vector<double>& own = fit.transmission.cables[i].coefficients;
    for (std::size_t j = 0; j < own.size(); ++j)
      combination(first + static_cast<Eigen::Index>(j)) -= own[j];
    first += rows.transmission.cables[i].n_coefficients();
  }
  return combination;
}

struct Colour {
  Eigen::VectorXd autocovariance;
  double period = 0;
  std::size_t n_values = 0;
  double f_vm = 0;  ///< see Friction
};

/// Of what the fit leaves of these logs.
Colour colour_of(std::span<const LogSurvey> logs, const ElasticOptions& options,
                 const std::string& preload, const ElasticFit& fit) {
  const ElasticJob job = make_job(logs, options, preload);
  const BlockedRows rows = collect_blocked(job, fit.transmission.encoder_zero()(0), nullptr);
  Eigen::VectorXd combination = residual_combination(rows, fit);
  Colour colour;
  if (has_both_branches(rows) && speed_tells_more(rows)) {
    // What a fit leaves has no part along any of its columns: only f_vm's, left out, is there.
    const auto& r = rows.rows->r();
    const Eigen::VectorXd speed = r.col(rows.columns.speed);
    colour.f_vm = speed.dot(r * combination) / speed.squaredNorm();
    combination(rows.columns.speed) -= colour.f_vm;
  }
  Autocovariance sums(kLags);
  rows.archive->for_each([&](const Eigen::MatrixXd& some, std::span<const Eigen::Index> numbers) {
    sums.add(numbers, some * combination);
  });
  colour.autocovariance = sums.values();
  colour.period = job.settings.rows.decimate / sample_rates(logs, job.wanted).highest;
  colour.n_values = sums.n_values();
  return colour;
}

/// As in the fit: its order, and what its zero is.
ElasticOptions options_of_runs(const ElasticOptions& options, const ElasticPreload& preload,
                               const ElasticFit& fit) {
  ElasticOptions same = options;
  same.preload = preload.name;
  same.figures = false;
  same.samples.threads = 1;
  same.order = 0;
  same.orders = orders_of(preload.fits.back().transmission);
  same.zero =
      find_estimate(fit.parameters, "theta_0") != nullptr ? ZeroMode::theta_0 : ZeroMode::offset;
  return same;
}

struct ElasticPlan {
  SimulatedCopy copy;
  std::vector<SimulationResult> motions;  ///< without a disturbance
  ArModel disturbance;
  ElasticOptions options;
};

ElasticPlan make_plan(std::span<const LogSurvey> logs, const ElasticOptions& options,
                      const ProveOptions& prove, const ElasticPreload& preload,
                      const ElasticFit& fit) {
  ElasticPlan plan;
  plan.options = options_of_runs(options, preload, fit);
  const ElasticJob job = make_job(logs, plan.options, preload.name);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    plan.copy.plans.push_back(logs[k].plan);
    plan.copy.parts.push_back(logs[k].parts);
    for (CopyStretch& stretch : read_stretches(logs[k], k, job.wanted)) {
      stretch.link_blocked = true;
      plan.copy.stretches.push_back(std::move(stretch));
    }
  }
  plan.copy.notes.emplace_back(
      "the motion of the logs, the torque of the fit; f_sm is not tested: the "
      "simulated logs have no stiction");
  const Colour measured = colour_of(logs, plan.options, preload.name, fit);
  const Friction friction{fit.offset, value_of(fit, "f_sm"), measured.f_vm};
  plan.motions = follow(plan.copy, fit, friction, kFollowedBand * job.settings.rows.signal.cutoff,
                        kRestShare * job.rest_speeds.front());
  choose_sensors(plan.copy, plan.motions);
  Random calibration(prove.seed, kCalibration);
  const std::vector<LogSurvey> quiet = record_copy(plan.copy, plan.motions, calibration);
  const Colour by_noise = colour_of(quiet, plan.options, preload.name, fit);
  Eigen::VectorXd left = measured.autocovariance;
  if (is_same_grid(by_noise.period, measured.period)) left -= by_noise.autocovariance;
  plan.disturbance = fit_ar(left, measured.period, measured.n_values);
  plan.copy.notes.push_back(fmt::format(
      "residual {:.3g} rms, of which {:.3g} are simulated as a disturbance, autoregressive of "
      "order {}",
      std::sqrt(measured.autocovariance(0)), plan.disturbance.sd,
      plan.disturbance.coefficients.size()));
  return plan;
}

ProofRun run_once(const ElasticPlan& plan, const std::string& model, std::uint64_t seed) {
  ProofRun run;
  try {
    Random disturbances(seed, kDisturbances), sensors(seed, kSensors);
    std::vector<SimulationResult> motions = plan.motions;
    disturb(plan.copy, plan.disturbance, disturbances, motions);
    const ElasticResult found = fit_elastic(record_copy(plan.copy, motions, sensors), plan.options);
    run.parameters = found.preloads.at(0).find(model)->parameters;
  } catch (const Error& error) {
    run.failure = error.what();
  }
  return run;
}

/// All but f_sm, which comes out 1.1 % lower from a copy than from a simulated log with the same
/// value: the copy may have less of it near reversals, where the log's noise hides how friction
/// passes from one side to the other, or the fit may have a bias. Told as the fit's bias it would
/// claim what is not known.
std::vector<Estimate> proved(const ElasticFit& fit) {
  std::vector<Estimate> parameters = fit.parameters;
  std::erase_if(parameters, [](const Estimate& e) { return e.name == "f_sm"; });
  return parameters;
}

bool has_searched_elongation(const ElasticFit& fit) {
  return std::any_of(fit.parameters.begin(), fit.parameters.end(),
                     [](const Estimate& e) { return e.name.starts_with("l_o"); });
}

}  // namespace

void prove_elastic(std::span<const LogSurvey> logs, const ElasticOptions& options,
                   const ProveOptions& prove, ElasticResult& result) {
  for (ElasticPreload& preload : result.preloads)
    for (ElasticFit& fit : preload.fits) {
      if (fit.transmission.n_joints > 1) {
        fit.warnings.emplace_back("not proved: --prove of stage 1 supports one joint");
        continue;
      }
      if (has_searched_elongation(fit)) {
        fit.warnings.emplace_back(
            "not proved: l_o was searched, and its intervals are profile likelihoods; give l_o in "
            "the rig file to prove the fit");
        continue;
      }
      const ElasticPlan plan = make_plan(logs, options, prove, preload, fit);
      fit.proof = prove_by_runs(proved(fit), prove, plan.copy.notes, [&](std::uint64_t seed) {
        return run_once(plan, fit.model, seed);
      });
      widen(fit.parameters, *fit.proof);
    }
}

}  // namespace cablefit
