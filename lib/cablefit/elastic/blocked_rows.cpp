#include "cablefit/elastic/blocked_rows.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/samples/agreement.hpp"

namespace cablefit {
namespace {

constexpr double kSlidingShare = 0.1;     // fewer rows in motion: the log is made of plateaus
constexpr double kSpeedCollinear = 0.98;  // speed and direction tell the same

}  // namespace

Transmission with_order(Transmission transmission, int order) {
  for (Cable& cable : transmission.cables) cable.order = std::min(order, cable.law->max_order);
  return transmission;
}

ElasticJob make_job(std::span<const LogSurvey> logs, const ElasticOptions& options,
                    const std::string& name) {
  const bool still = options.still;
  ElasticJob job{logs,
                 [name, still](const PartSurvey& part) {
                   return part.preload == name && (still || part.phase == Phase::blocked);
                 },
                 options,
                 {},
                 0,
                 {},
                 false};
  require_agreement(logs, job.wanted, name);
  job.settings = blocked_settings(logs, job.wanted, options.samples);
  const Rig& rig = job.rig();
  job.orders_given = rig.cables_given && options.order == 0;
  job.basis = rig.transmission;
  if (!job.orders_given)
    job.basis = with_order(job.basis, options.order > 0 ? options.order : options.max_order);
  if (still) {
    job.settings.rows.signal.quasi_static = false;  // the motor need not be slow
    job.still_speed = std::max(job.settings.rest_speed_q, 1e-12);
    // The link rests only for moments: keep more rows of them.
    if (!options.samples.decimate) {
      job.settings.rows.decimate = std::max(1, job.settings.rows.decimate / 8);
      for (Decision& decision : job.settings.decisions)
        if (decision.name == "decimation")
          decision = {"decimation", std::to_string(job.settings.rows.decimate),
                      "the link rests only for moments"};
    }
  }
  return job;
}

BlockedRows collect_blocked(const ElasticJob& job, double theta_0, const Transmission* pilot) {
  BlockedRows blocked;
  blocked.transmission = job.basis;
  blocked.transmission.theta_0 = Eigen::VectorXd::Constant(job.basis.n_joints, theta_0);
  blocked.columns = blocked_columns(blocked.transmission);
  const std::vector<Equation> both = {
      blocked_equation(blocked.transmission, pilot, true, job.settings.rest_speed_theta,
                       job.still_speed),
      blocked_equation(blocked.transmission, pilot, false, job.settings.rest_speed_theta,
                       job.still_speed)};
  const Eigen::Index expected = expected_rows(job.logs, job.wanted, job.settings.rows);
  const RowStatistics blank(blocked.columns.count, expected);
  std::vector<RowStatistics> statistics(both.size(), blank);
  std::vector<RowCounts> counts(both.size());
  std::vector<std::shared_ptr<RowArchive>> archives;
  for (std::size_t k = 0; k < both.size(); ++k) archives.push_back(std::make_shared<RowArchive>());
  struct Result {
    std::vector<RowStatistics> statistics;
    RowBatch batch;
  };
  blocked.windows = stream_rows(
      job.logs, job.wanted, job.settings.rows, both, job.options.samples.threads,
      [&](RowBatch batch) {
        Result result;
        for (const EquationBatch& equation : batch.equations) {
          result.statistics.push_back(blank.empty_copy());
          result.statistics.back().add(equation.rows, equation.numbers);
        }
        result.batch = std::move(batch);
        return result;
      },
      [&](const Result& result) {
        for (std::size_t k = 0; k < both.size(); ++k) {
          statistics[k].add(result.statistics[k]);
          archives[k]->append(result.batch.equations[k]);
          counts[k] += result.batch.equations[k].counts;
        }
      });
  const auto sliding = static_cast<double>(counts[0].rows_used);
  const auto holding = static_cast<double>(counts[1].rows_used);
  // Plateaus: the torque at rest lies anywhere within the friction band, but the side from which a
  // place was approached decides on which half; better than nothing, and said so.
  blocked.plateaus = sliding < kSlidingShare * (sliding + holding);
  const std::size_t chosen = blocked.plateaus ? 1 : 0;
  blocked.equations = {both[chosen]};
  blocked.rows = statistics[chosen];
  blocked.archive = archives[chosen];
  blocked.counts = counts[chosen];
  if (!blocked.plateaus) blocked.counts.rows_at_rest = counts[0].rows_at_rest;
  blocked.archive->for_each([&](const Eigen::MatrixXd& rows, std::span<const Eigen::Index>) {
    const auto deflection = rows.col(blocked.columns.deflection);
    blocked.deflection_low = std::min(blocked.deflection_low, deflection.minCoeff());
    blocked.deflection_high = std::max(blocked.deflection_high, deflection.maxCoeff());
  });
  return blocked;
}

bool has_both_branches(const BlockedRows& rows) {
  const auto& r = rows.rows->r();
  const double sum = r.col(rows.columns.direction).dot(r.col(rows.columns.offset));
  const double n = r.col(rows.columns.offset).squaredNorm();
  return n > 0 && std::abs(sum) < 0.95 * n;
}

bool speed_tells_more(const BlockedRows& rows) {
  const auto& r = rows.rows->r();
  const auto direction = r.col(rows.columns.direction);
  const auto speed = r.col(rows.columns.speed);
  const double norms = direction.norm() * speed.norm();
  return norms > 0 && std::abs(direction.dot(speed)) < kSpeedCollinear * norms;
}

}  // namespace cablefit
