// The true curve against a fitted one, and what least squares makes of it.
#pragma once

#include <Eigen/QR>

#include "cablefit/elastic/rows/blocked_rows.hpp"
#include "tests/support/recover.hpp"

#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit::test {

/// tau_elas of a fit at a deflection from its zero, link at 0.
inline double fitted_torque(const ElasticFit& fit, double phi) {
  if (fit.transmission.cables.empty()) return fit.transmission.linear_stiffness(0) * phi;
  Eigen::VectorXd link, motor;
  fit.transmission.torques(Eigen::VectorXd::Zero(1),
                           fit.transmission.encoder_zero() + Eigen::VectorXd::Constant(1, phi),
                           link, motor);
  return motor[0];
}

inline double largest_curve_error(const ElasticFit& fit, const truth::Rig& rig, double low,
                                  double high) {
  double largest = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double phi = low + (high - low) * i / 1000;
    largest = std::max(largest, std::abs(fitted_torque(fit, phi) - rig.tau_elas(phi)));
  }
  return largest;
}

/// Least-squares slope of the true curve against phi, with a constant, on a uniform grid.
inline double slope_on_grid(const truth::Rig& rig, double low, double high) {
  constexpr int kPoints = 2001;
  double mean = 0, xy = 0, xx = 0;
  for (int i = 0; i < kPoints; ++i) mean += (low + (high - low) * i / (kPoints - 1)) / kPoints;
  for (int i = 0; i < kPoints; ++i) {
    const double phi = low + (high - low) * i / (kPoints - 1);
    xy += (phi - mean) * rig.tau_elas(phi);
    xx += (phi - mean) * (phi - mean);
  }
  return xy / xx;
}

/// The same on the rows stage 1 uses, with its nuisance columns: constant, direction, speed.
inline double slope_on_rows(std::span<const LogSurvey> logs, const truth::Rig& rig) {
  const ElasticOptions options;
  const ElasticJob job = make_job(logs, options, logs.front().parts.at(0).preload);
  const BlockedRows blocked = collect_blocked(job, 0, nullptr);
  std::vector<Eigen::Vector4d> regressors;
  std::vector<double> torque;
  stream_rows(
      logs, job.wanted, job.settings.rows, blocked.equations, 1,
      [](RowBatch batch) { return batch; },
      [&](const RowBatch& batch) {
        const Eigen::MatrixXd& rows = batch.equations.at(0).rows;
        const BlockedColumns& c = blocked.columns;
        for (Eigen::Index i = 0; i < rows.rows(); ++i) {
          regressors.emplace_back(rows(i, c.deflection), rows(i, c.offset), rows(i, c.direction),
                                  rows(i, c.speed));
          torque.push_back(rig.tau_elas(rows(i, c.deflection)));
        }
      });
  Eigen::MatrixXd a(static_cast<Eigen::Index>(torque.size()), 4);
  for (std::size_t i = 0; i < torque.size(); ++i)
    a.row(static_cast<Eigen::Index>(i)) = regressors[i].transpose();
  const Eigen::Map<Eigen::VectorXd> b(torque.data(), a.rows());
  return a.colPivHouseholderQr().solve(b)(0);
}

}  // namespace cablefit::test
