// Rows of one preload's blocked logs, collected once for all models fitted to them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cablefit/elastic/elastic_columns.hpp"
#include "cablefit/elastic/elastic_fit.hpp"
#include "cablefit/estimate/row_statistics.hpp"
#include "cablefit/samples/row_archive.hpp"

namespace cablefit {

/// What all steps of stage 1 share for one preload.
struct ElasticJob {
  std::span<const LogSurvey> logs;
  PartFilter wanted;
  const ElasticOptions& options;
  ChosenSettings settings;
  double still_speed = 0;     ///< rad/s; > 0: only rows in which the link is slower
  Transmission basis;         ///< cables of the highest order in question, theta_0 = 0
  bool orders_given = false;  ///< by the rig file, per cable

  /// Of the first log with rows of this preload.
  const Rig& rig() const { return first_log_with(logs, wanted).plan.rig; }
};

/// The job of the preload `name`, its settings chosen. It refers to `logs` and `options`.
ElasticJob make_job(std::span<const LogSurvey> logs, const ElasticOptions& options,
                    const std::string& name);

/// Rows under one choice of theta_0.
struct BlockedRows {
  Transmission transmission;  ///< as ElasticJob::basis, theta_0 set
  BlockedColumns columns;
  std::vector<Equation> equations;  ///< the one whose rows are used
  std::optional<RowStatistics> rows;
  std::shared_ptr<const RowArchive> archive;  ///< the rows themselves, for a second look
  RowCounts counts;
  WindowCounts windows;
  double deflection_low = kUnbounded, deflection_high = -kUnbounded;  ///< of the rows
  bool plateaus = false;  ///< rows at rest were used, there are hardly others

  Eigen::VectorXd torque_response() const {
    return Eigen::VectorXd::Unit(columns.count, columns.tau);
  }
};

/// `pilot`: a first curve, whose slope gives the column of theta_0; may be null.
BlockedRows collect_blocked(const ElasticJob& job, double theta_0, const Transmission* pilot);

/// Motion in both directions: the direction column is not (nearly) a constant.
bool has_both_branches(const BlockedRows& rows);
/// Speeds vary enough to tell viscous from static friction of the motor.
bool speed_tells_more(const BlockedRows& rows);

/// The same cables with the order (as far as their laws go).
Transmission with_order(Transmission transmission, int order);

}  // namespace cablefit
