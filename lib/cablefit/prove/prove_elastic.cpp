#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/copies/fast_motion.hpp"
#include "cablefit/copies/simulated_copy.hpp"
#include "cablefit/elastic/rows/blocked_rows.hpp"
#include "cablefit/prove/proof_runs.hpp"
#include "cablefit/prove/residual_colour.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

/// Torque of the fit on one joint besides the elastic one.
struct Friction {
  double offset = 0, f_sm = 0;
  double f_vm = 0;  ///< which a fit estimates to keep it out of f_sm, and does not report
};

double value_of(const ElasticFit& fit, const char* name, int joint) {
  const Estimate* e = find_estimate(
      fit.parameters, joint_parameter_name(name, joint + 1, fit.transmission.n_joints));
  return e != nullptr && e->not_identifiable.empty() && std::isfinite(e->value) ? e->value : 0;
}

double offset_of(const ElasticFit& fit, int joint) {
  return fit.transmission.n_joints == 1 ? fit.offset : value_of(fit, "offset", joint);
}

// Of the band of stage 1, for the motion to be followed: the fit's own low-pass, which comes on
// top, must not find it slowed down.
constexpr double kFollowedBand = 4;

/// A channel of all joints without most of what sensors added.
Eigen::ArrayXXd smooth(const CopyStretch& stretch, const LogPlan& plan, Channel channel,
                       double cutoff) {
  Eigen::MatrixXd columns(stretch.measured.rows(), plan.rig.n_joints());
  for (int joint = 0; joint < plan.rig.n_joints(); ++joint)
    columns.col(joint) = stretch.measured.col(plan.find(channel, joint));
  return cablefit::smooth(columns, stretch.period, cutoff).array();
}

// Of the speed below which stage 1 leaves rows out: slower ones rest. What is measured there is
// noisy, and noise can only take from f_sm; a share of 1 costs rows that do move.
constexpr double kRestShare = 0.25;

/// Dry friction: f_sm against the motion; at rest what was measured beside the rest of the model,
/// as far as friction goes. A jump from one side to the other, which no drive makes, would come out
/// of the low-pass as less friction.
void add_friction(const Eigen::ArrayXd& speed, const Eigen::ArrayXd& measured, double f_sm,
                  double rest_speed, Eigen::Ref<Eigen::ArrayXd> tau) {
  for (Eigen::Index i = 0; i < speed.size(); ++i) {
    const double rest = std::clamp(measured(i) - tau(i), -f_sm, f_sm);
    tau(i) += std::abs(speed(i)) > rest_speed ? (speed(i) > 0 ? f_sm : -f_sm) : rest;
  }
}

Eigen::ArrayXXd elastic_torques(const Transmission& transmission, const SimulationResult& motion) {
  Eigen::ArrayXXd tau(motion.q.rows(), motion.q.cols());
  Eigen::VectorXd link, motor;
  for (Eigen::Index i = 0; i < tau.rows(); ++i) {
    transmission.torques(motion.q.row(i).matrix(), motion.theta.row(i).matrix(), link, motor);
    tau.row(i) = motor.transpose().array();
  }
  return tau;
}

/// What the blocked drives do: the logs' motion with the fit's torque. By joint: `frictions` and
/// the `rest_speeds` of stage 1.
std::vector<SimulationResult> follow(const SimulatedCopy& copy, const ElasticFit& fit,
                                     const std::vector<Friction>& frictions, double cutoff,
                                     const std::vector<double>& rest_speeds) {
  std::vector<SimulationResult> motions;
  for (const CopyStretch& stretch : copy.stretches) {
    const LogPlan& plan = copy.plans[stretch.log];
    SimulationResult motion;
    motion.q = smooth(stretch, plan, Channel::q, cutoff);
    motion.theta = smooth(stretch, plan, Channel::theta, cutoff);
    motion.tau = elastic_torques(fit.transmission, motion);
    const Eigen::ArrayXXd measured = smooth(stretch, plan, Channel::tau, cutoff);
    const Eigen::Index n = motion.q.rows();
    motion.qd = motion.thetad = Eigen::ArrayXXd::Zero(n, motion.q.cols());
    for (Eigen::Index i = 1; i + 1 < n; ++i)
      motion.thetad.row(i) =
          (motion.theta.row(i + 1) - motion.theta.row(i - 1)) / (2 * stretch.period);
    for (std::size_t k = 0; k < frictions.size(); ++k) {
      const auto joint = static_cast<Eigen::Index>(k);
      motion.tau.col(joint) += frictions[k].offset + frictions[k].f_vm * motion.thetad.col(joint);
      add_friction(motion.thetad.col(joint), measured.col(joint), frictions[k].f_sm,
                   kRestShare * rest_speeds[k], motion.tau.col(joint));
    }
    motions.push_back(std::move(motion));
  }
  return motions;
}

/// `colours`: by joint.
void disturb(const SimulatedCopy& copy, const std::vector<ArModel>& colours, Random& random,
             std::vector<SimulationResult>& motions) {
  for (std::size_t k = 0; k < motions.size(); ++k)
    for (std::size_t joint = 0; joint < colours.size(); ++joint)
      if (colours[joint].sd > 0)
        motions[k].tau.col(static_cast<Eigen::Index>(joint)) +=
            draw(colours[joint], motions[k].tau.rows(), copy.stretches[k].period, random);
}

/// rows * this = residual of the fit. `rows`: of this joint.
Eigen::VectorXd residual_combination(const BlockedRows& rows, const ElasticFit& fit, int joint) {
  const BlockedColumns c = rows.columns.of_joint(joint);
  Eigen::VectorXd combination = Eigen::VectorXd::Unit(c.count, c.tau);
  combination(c.offset) -= offset_of(fit, joint);
  combination(c.direction) -= value_of(fit, "f_sm", joint);
  if (fit.transmission.cables.empty())
    combination(c.deflection) -= fit.transmission.linear_stiffness(joint);
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

Colour colour_of_joint(const BlockedRows& rows, const ElasticFit& fit, int joint, double period) {
  Eigen::VectorXd combination = residual_combination(rows, fit, joint);
  Colour colour;
  if (has_both_branches(rows, joint) && speed_tells_more(rows, joint)) {
    // What a fit leaves has no part along any of its columns: only f_vm's, left out, is there.
    const Eigen::Index at = rows.columns.of_joint(joint).speed;
    const auto& r = rows.rows->r();
    const Eigen::VectorXd speed = r.col(at);
    colour.f_vm = speed.dot(r * combination) / speed.squaredNorm();
    combination(at) -= colour.f_vm;
  }
  Autocovariance sums(kLags);
  rows.archive->for_each([&](const Eigen::MatrixXd& some, std::span<const Eigen::Index> numbers) {
    sums.add(numbers, some * combination);
  });
  colour.autocovariance = sums.values();
  colour.period = period;
  colour.n_values = sums.n_values();
  return colour;
}

/// Of what the fit leaves of these logs, by joint.
std::vector<Colour> colours_of(std::span<const LogSurvey> logs, const ElasticOptions& options,
                               const std::string& preload, const ElasticFit& fit) {
  const ElasticJob job = make_job(logs, options, preload);
  const double period = job.settings.rows.decimate / sample_rates(logs, job.wanted).highest;
  const std::vector<BlockedRows> rows =
      collect_joints(job, fit.transmission.encoder_zero(), nullptr);
  std::vector<Colour> colours;
  for (std::size_t k = 0; k < rows.size(); ++k)
    colours.push_back(colour_of_joint(rows[k], fit, static_cast<int>(k), period));
  return colours;
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
  const std::string zero = joint_parameter_name("theta_0", 1, fit.transmission.n_joints);
  same.zero = find_estimate(fit.parameters, zero) != nullptr ? ZeroMode::theta_0 : ZeroMode::offset;
  return same;
}

struct ElasticPlan {
  SimulatedCopy copy;
  std::vector<SimulationResult> motions;  ///< without a disturbance
  std::vector<ArModel> disturbances;      ///< by joint
  ElasticOptions options;
};

/// What sensors alone do not leave.
ArModel disturbance_of(const Colour& measured, const Colour& by_noise) {
  Eigen::VectorXd left = measured.autocovariance;
  if (is_same_grid(by_noise.period, measured.period)) left -= by_noise.autocovariance;
  return fit_ar(left, measured.period, measured.n_values);
}

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
  const int n_joints = fit.transmission.n_joints;
  const std::vector<Colour> measured = colours_of(logs, plan.options, preload.name, fit);
  std::vector<Friction> frictions;
  for (int joint = 0; joint < n_joints; ++joint)
    frictions.push_back({offset_of(fit, joint), value_of(fit, "f_sm", joint),
                         measured[static_cast<std::size_t>(joint)].f_vm});
  plan.motions = follow(plan.copy, fit, frictions, kFollowedBand * job.settings.rows.signal.cutoff,
                        job.rest_speeds);
  choose_sensors(plan.copy, plan.motions);
  Random calibration(prove.seed, kCalibration);
  const std::vector<LogSurvey> quiet = record_copy(plan.copy, plan.motions, calibration);
  const std::vector<Colour> by_noise = colours_of(quiet, plan.options, preload.name, fit);
  for (std::size_t k = 0; k < measured.size(); ++k) {
    plan.disturbances.push_back(disturbance_of(measured[k], by_noise[k]));
    const auto joint = static_cast<int>(k);
    plan.copy.notes.push_back(
        disturbance_note(n_joints > 1 ? fmt::format("joint {}", joint + 1) : "",
                         std::sqrt(measured[k].autocovariance(0)), plan.disturbances.back(),
                         torque_unit(logs.front().plan.rig.axes.of(joint))));
  }
  return plan;
}

ProofRun run_once(const ElasticPlan& plan, const std::string& model, std::uint64_t seed) {
  ProofRun run;
  try {
    Random disturbances(seed, kDisturbances), sensors(seed, kSensors);
    std::vector<SimulationResult> motions = plan.motions;
    disturb(plan.copy, plan.disturbances, disturbances, motions);
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
  std::erase_if(parameters, [](const Estimate& e) { return e.name.starts_with("f_sm"); });
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
