#include "cablefit/dynamic/estimators/output_error_floor.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/loops/method_floor.hpp"
#include "cablefit/dynamic/output_error/log_stretches.hpp"

namespace cablefit::estimation {
namespace {

/// N m, per joint: the last axes are the motors, or the rigid drives.
std::vector<double> torque_noise_of(const OutputErrorFit& fit, int n_joints) {
  const Eigen::VectorXd motors = fit.noise.force.tail(n_joints);
  return {motors.begin(), motors.end()};
}

/// A prior around the values that the copies are simulated with.
void move_prior(const OutputErrorFit& fit, GaussianPrior& prior) {
  for (std::size_t k = 0; k < prior.names.size(); ++k)
    if (const Estimate* e = find_estimate(fit.parameters, prior.names[k]))
      prior.mean[static_cast<Eigen::Index>(k)] = e->value;
}

/// Mean error of a parameter over the copies that determine it.
struct MeanError {
  double sum = 0, weight = 0;
};

void add_errors(const OutputErrorFit& found, const OutputErrorFit& truth, double weight,
                std::map<std::string, MeanError>& means) {
  for (const Estimate& e : found.parameters) {
    const Estimate* simulated = find_estimate(truth.parameters, e.name);
    if (!e.not_identifiable.empty() || !simulated->not_identifiable.empty()) continue;
    MeanError& mean = means[e.name];
    mean.sum += weight * (e.value - simulated->value);
    mean.weight += weight;
  }
}

}  // namespace

OutputErrorFloor output_error_floor(const DynamicJob& job, const OutputErrorFit& fit,
                                    OutputErrorOptions options) {
  OutputErrorFloor floor;
  options.force_sd = fit.noise.force;
  move_prior(fit, options.prior);
  const Eigen::MatrixXd prior = options.prior.covariance;
  std::map<std::string, MeanError> means;
  try {
    CopyDraws draws(job, fit.model, false, true, torque_noise_of(fit, job.n_joints()));
    draws.for_each([&](const CopyDraw& draw) {
      options.prior.covariance = prior / draw.share;  // as heavy beside the rows as in the fit
      const OutputErrorFit found =
          fit_output_error(fit.model, measured_stretches(job, draw.logs), options);
      if (!found.converged) throw Error(ErrorKind::not_identifiable, found.message);
      add_errors(found, fit, draw.weight, means);
    });
    for (const auto& [name, mean] : means) floor.sd[name] = std::abs(mean.sum) / mean.weight;
    floor.note = "fit of two simulated copies of the motion, with opposite noise";
  } catch (const Error& error) {
    floor = {{}, fmt::format("not measured: {}", error.what())};
  }
  return floor;
}

}  // namespace cablefit::estimation
