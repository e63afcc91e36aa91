#include "cablefit/dynamic/loops/method_floor.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/dynamic/loops/log_copy.hpp"
#include "cablefit/dynamic/loops/model_of_solutions.hpp"

namespace cablefit {
namespace {

// s; second order in the step: 1e-4 of the resonance's period costs nothing beside a filter.
constexpr double kStep = 100e-6;
constexpr double kAside = 16;  // encoder steps that a draw's motion is moved by, at most
// Of a joint's motion, rms: a copy further from it shows the errors of another experiment.
constexpr double kOffTrack = 0.3;
// Of the largest motion of a joint in the same unit: a joint that moves less is taken to move so
// much.
constexpr double kHardlyMoves = 0.1;

/// The logs of the job, or stretches of them where they are long.
struct CopiedLogs {
  std::vector<LogSurvey> stretches;
  std::span<const LogSurvey> logs;
  double share = 1;  ///< of the rows
};

CopiedLogs logs_to_copy(const DynamicJob& job) {
  double all = 0;
  for (const LogSurvey& log : job.logs)
    for (const PartSurvey& part : log.parts)
      if (job.wanted(part)) all += static_cast<double>(part.n_rows);
  CopiedLogs out;
  out.share = std::min(1.0, kFloorRows / all);
  if (out.share < 1)
    out.stretches =
        stretches_of(job.logs, job.wanted, out.share, bridge_seconds(job.settings.rows.signal));
  out.logs = out.stretches.empty() ? job.logs : std::span<const LogSurvey>(out.stretches);
  return out;
}

/// Of all stretches of a copy: how far a motor moved, and how far the simulated one is from it;
/// squared and summed over the rows.
struct Track {
  double way = 0, off = 0;
};

std::vector<Track> tracks_of(const SimulatedCopy& copy,
                             const std::vector<SimulationResult>& motions) {
  std::vector<Track> tracks(static_cast<std::size_t>(copy.model.rig.n_joints()));
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const CopyStretch& stretch = copy.stretches[k];
    if (!stretch.rig.controller) continue;  // a command is replayed, and drifts
    for (std::size_t joint = 0; joint < tracks.size(); ++joint) {
      const auto at = static_cast<int>(joint);
      const Eigen::ArrayXd theta =
          stretch.measured.col(copy.plans[stretch.log].find(Channel::theta, at)).array();
      tracks[joint].way += (theta - theta.mean()).square().sum();
      tracks[joint].off += (motions[k].theta.col(at) - theta).square().sum();
    }
  }
  return tracks;
}

/// Throws Error(not_identifiable) for a copy whose motors do not follow the measured motion.
void require_that_it_follows(const SimulatedCopy& copy,
                             const std::vector<SimulationResult>& motions) {
  const std::vector<Track> tracks = tracks_of(copy, motions);
  const JointAxes& axes = copy.model.rig.axes;
  for (std::size_t joint = 0; joint < tracks.size(); ++joint) {
    const auto at = static_cast<int>(joint);
    double way = tracks[joint].way;
    for (std::size_t k = 0; k < tracks.size(); ++k)
      if (axes.of(static_cast<int>(k)) == axes.of(at))
        way = std::max(way, kHardlyMoves * kHardlyMoves * tracks[k].way);
    if (way > 0 && tracks[joint].off > kOffTrack * kOffTrack * way)
      throw Error(ErrorKind::not_identifiable,
                  fmt::format("the simulated copy leaves the measured motion of joint {} by {:.2g} "
                              "of its size",
                              joint + 1, std::sqrt(tracks[joint].off / way)));
  }
}

/// Positions as the encoders show them, torques as they are, but for this noise.
void choose_encoders(SimulatedCopy& copy, const std::vector<SimulationResult>& motions,
                     const std::vector<double>& torque_noise) {
  choose_sensors(copy, motions);
  for (std::size_t log = 0; log < copy.plans.size(); ++log)
    for (std::size_t k = 0; k < copy.plans[log].slots.size(); ++k) {
      const Slot& slot = copy.plans[log].slots[k];
      if (slot.channel == Channel::q || slot.channel == Channel::theta) continue;
      copy.sensors[log][k] = {};
      if (slot.channel == Channel::tau && !torque_noise.empty())
        copy.sensors[log][k].noise = torque_noise[static_cast<std::size_t>(slot.joint)];
    }
}

/// A turn of all joints that stretches no cable, as far as there is one: of links and motors.
struct Turn {
  Eigen::VectorXd links, motors;
};

Turn free_turn(const Model& model) {
  const int n = model.rig.n_joints();
  const Eigen::VectorXd all = Eigen::VectorXd::Ones(n);
  if (model.rigid || model.transmission.cables.empty()) return {all, all};
  const Transmission& cables = model.transmission;
  const Eigen::MatrixXd link = cables.link_coupling(cables.reference_q()).transpose();
  const Eigen::MatrixXd motor = cables.motor_coupling(cables.reference_theta()).transpose();
  const Eigen::MatrixXd following = motor.colPivHouseholderQr().solve(link);
  // Links that cables of different ratios hold against each other cannot turn so.
  constexpr double kExact = 1e-9;
  const Eigen::JacobiSVD<Eigen::MatrixXd> stretch(motor * following - link, Eigen::ComputeFullV);
  Turn turn{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const bool stretches =
        k < stretch.singularValues().size() && stretch.singularValues()(k) > kExact * link.norm();
    if (!stretches) turn.links += stretch.matrixV().col(k) * stretch.matrixV().col(k).dot(all);
  }
  turn.motors = following * turn.links;
  return turn;
}

/// All joints turned, so that the encoders round otherwise and the cables do not notice.
std::vector<SimulationResult> moved_aside(const SimulatedCopy& copy,
                                          std::vector<SimulationResult> motions, Random& random) {
  const Turn turn = free_turn(copy.model);
  for (std::size_t k = 0; k < motions.size(); ++k) {
    double quantum = 0;
    for (const CopySensor& sensor : copy.sensors[copy.stretches[k].log])
      quantum = std::max(quantum, sensor.quantum);
    const double aside = kAside * quantum * random.uniform();
    motions[k].q.rowwise() += aside * turn.links.transpose().array();
    motions[k].theta.rowwise() += aside * turn.motors.transpose().array();
  }
  return motions;
}

/// What the method finds in the copy, per equation; values only.
std::vector<LinearSolution> fit_copy(const DynamicJob& job, const std::vector<LogSurvey>& copy,
                                     std::size_t which) {
  DynamicOptions options = job.options;
  options.robust_sd = false;
  const DynamicJob own{copy,       options,   job.preload,  job.wanted,         job.elastic,
                       job.models, job.rigid, job.settings, job.joint_settings, job.links_alone,
                       job.added};
  std::vector<EquationRows> equations = make_equations(own);
  collect_rows(own, equations);
  return solve_equations(equations, own.elastic, which);
}

/// Differences of parameters that both determine.
Eigen::VectorXd error_of(const LinearSolution& found, const LinearSolution& truth) {
  Eigen::VectorXd error = found.x - truth.x;
  for (Eigen::Index k = 0; k < error.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (!found.not_identifiable[at].empty() || !truth.not_identifiable[at].empty()) error(k) = 0;
  }
  return error;
}

}  // namespace

CopyDraws::CopyDraws(const DynamicJob& job, const Model& model, bool exact, bool rounded,
                     std::vector<double> torque_noise)
    : rounded_(rounded), exact_(exact), torque_noise_(std::move(torque_noise)), random_(1) {
  const CopiedLogs copied = logs_to_copy(job);
  share_ = copied.share;
  const SignalSettings& signal = job.settings.rows.signal;
  copy_ = make_copy(model, copied.logs, job.wanted,
                    {signal.torque_held, signal.torque_period, signal.cutoff, true, kStep});
  motions_ = run_copy(copy_, {}, random_, job.options.samples.threads);
  require_that_it_follows(copy_, motions_);
}

void CopyDraws::for_each(const std::function<void(const CopyDraw&)>& use) {
  if (exact_) use({record_copy(copy_, motions_, random_), true, 1, share_});
  if (!rounded_) return;
  choose_encoders(copy_, motions_, torque_noise_);
  if (!torque_noise_.empty()) {
    use_noisy_pair(use);
    return;
  }
  for (int draw = 0; draw < kFloorDraws; ++draw)
    use({record_copy(copy_, moved_aside(copy_, motions_, random_), random_), false,
         1.0 / kFloorDraws, share_});
}

void CopyDraws::use_noisy_pair(const std::function<void(const CopyDraw&)>& use) {
  const std::vector<SimulationResult> moved = moved_aside(copy_, motions_, random_);
  Random same = random_;
  use({record_copy(copy_, moved, random_), false, 0.5, share_});
  for (std::vector<CopySensor>& log : copy_.sensors)
    for (CopySensor& sensor : log) sensor.noise = -sensor.noise;
  use({record_copy(copy_, moved, same), false, 0.5, share_});
}

MethodFloor method_floor(const DynamicJob& job, const std::vector<EquationRows>& equations,
                         const std::vector<LinearSolution>& solutions,
                         const std::vector<bool>& with_instruments, std::size_t which) {
  MethodFloor floor;
  const auto any = [&](bool instruments) {
    return std::find(with_instruments.begin(), with_instruments.end(), instruments) !=
           with_instruments.end();
  };
  try {
    for (const LinearSolution& solution : solutions)
      floor.variance.emplace_back(Eigen::VectorXd::Zero(solution.x.size()));
    CopyDraws draws(job, model_of_solutions(job, equations, solutions, which), any(true),
                    any(false));
    draws.for_each([&](const CopyDraw& draw) {
      const std::vector<LinearSolution> found = fit_copy(job, draw.logs, which);
      for (std::size_t k = 0; k < solutions.size(); ++k)
        if (with_instruments[k] == draw.exact)
          floor.variance[k] += draw.weight * error_of(found[k], solutions[k]);
    });
    for (Eigen::VectorXd& v : floor.variance) v = v.cwiseAbs2().eval();
    floor.note = kFloorNote;
  } catch (const Error& error) {
    floor = {{}, fmt::format("not measured: {}", error.what())};
  }
  return floor;
}

}  // namespace cablefit
