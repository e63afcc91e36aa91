#include "drive.hpp"

#include <stdexcept>

#include "parts.hpp"

namespace truth {
namespace {

struct Clock {
  int steps_per_sample;
  double h;  // s
  long samples;
};

Clock make_clock(const DriveOptions& o) {
  if (!(o.duration > 0.0 && o.rate > 0.0 && o.fine_rate >= o.rate) || o.control_period != 0.0) {
    throw std::invalid_argument("duration, rate and fine_rate do not fit together");
  }
  const int steps = static_cast<int>(std::lround(o.fine_rate / o.rate));
  return {steps, 1.0 / (o.rate * steps), std::lround(o.duration * o.rate)};
}

std::vector<double> make_reference(const DriveOptions& options, const Clock& clock) {
  Random random = stream(options.seed, kReferenceStream);
  std::vector<Line> lines = slow_lines(options.slow_peak, options.duration, &random);
  const std::vector<Line> fast = fast_lines(options.fast_accel, &random);
  lines.insert(lines.end(), fast.begin(), fast.end());
  std::vector<double> reference;
  for (long i = 0; i < clock.samples; ++i) {
    const double t = static_cast<double>(i) / options.rate;
    reference.push_back(quantise(smooth_step(t / kRampTime) * sum_of(lines, t), kReferenceQuantum));
  }
  return reference;
}

// One run: the controller on `reference`, or the torque of every sample when `replayed` has any.
// Returns the true motor positions and torques.
struct Run {
  std::vector<double> theta, tau;
};
Run run(const Drive& drive, const DriveOptions& o, const std::vector<double>& reference,
        const std::vector<double>& replayed) {
  const Clock clock = make_clock(o);
  const Body body{drive.J, drive.f_v, drive.f_s};
  Disturbance disturbance(o.disturbance_sd, o.disturbance_time, 1.0 / o.rate, o.seed);
  PdController controller(o, 1.0 / o.rate, reference.front(), 0.0);
  Run result;
  double theta = 0.0;
  double speed = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double command = controller.command(reference[i], quantise(theta, o.quantum_theta));
    const double tau = replayed.empty() ? command : replayed[i];
    result.theta.push_back(theta);
    result.tau.push_back(tau - (o.on_sensor ? disturbance.at(0.0) : 0.0));
    for (int step = 0; step < clock.steps_per_sample; ++step) {
      const double fraction = (step + 0.5) / clock.steps_per_sample;
      const double outer = o.on_sensor ? 0.0 : disturbance.at(fraction);
      const double before = speed;
      speed = body.advance(speed, tau - drive.offset + outer, clock.h);
      theta += 0.5 * clock.h * (before + speed);
    }
    disturbance.advance();
  }
  return result;
}

}  // namespace

Log simulate_drive(const Drive& drive, const DriveOptions& options) {
  const Clock clock = make_clock(options);
  const std::vector<double> reference = make_reference(options, clock);
  std::vector<double> replayed;
  if (options.open_loop) {
    DriveOptions ideal = options;
    ideal.disturbance_sd = ideal.quantum_theta = 0.0;
    replayed = run(drive, ideal, reference, {}).tau;
  }
  const Run truth = run(drive, options, reference, replayed);
  Random noise = stream(options.seed, kNoiseStream);
  Log log;
  for (std::size_t i = 0; i < truth.theta.size(); ++i) {
    log.t.push_back(static_cast<double>(i) / options.rate);
    log.theta.push_back(quantise(truth.theta[i], options.quantum_theta));
    log.tau.push_back(truth.tau[i] + options.noise_tau * noise.normal());
  }
  if (!options.open_loop) log.theta_ref = reference;
  return log;
}

}  // namespace truth
