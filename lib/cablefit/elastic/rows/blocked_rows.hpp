// Rows of one preload's blocked logs, collected once for all models fitted to them.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cablefit/elastic/elastic_fit.hpp"
#include "cablefit/elastic/rows/elastic_columns.hpp"
#include "cablefit/elastic/rows/elongation_range.hpp"
#include "cablefit/estimate/solve/row_statistics.hpp"
#include "cablefit/samples/rows/row_archive.hpp"

namespace cablefit {

/// What all steps of stage 1 share for one preload.
struct ElasticJob {
  std::span<const LogSurvey> logs;
  PartFilter wanted;
  const ElasticOptions& options;
  ChosenSettings settings;
  Transmission basis;       ///< cables of the highest order in question, theta_0 = 0
  std::vector<int> orders;  ///< per cable, given by options or the rig file; empty: to be chosen
  /// Per joint, rad/s: motor in motion; link still (0: moving links count, too).
  std::vector<double> rest_speeds, still_speeds;

  /// Of the first log with rows of this preload.
  const Rig& rig() const { return first_log_with(logs, wanted).plan.rig; }
};

/// The job of the preload `name`, its settings chosen. It refers to `logs` and `options`.
ElasticJob make_job(std::span<const LogSurvey> logs, const ElasticOptions& options,
                    const std::string& name);

/// Orders of the cables in the first fit, which finds the encoder zeros: those given, else 2.
std::vector<int> preliminary_orders(const ElasticJob& job);

/// Of the torque's amplitude, sqrt(2) times its rms about the offset: a larger offset suggests an
/// encoder's zero. Of one joint it is then searched, of several it is reported.
inline constexpr double kArbitraryZero = 0.05;

/// Rows of one joint's equation under one choice of theta_0, or of all joints' together.
struct BlockedRows {
  Transmission transmission;  ///< as ElasticJob::basis, theta_0 set
  BlockedColumns columns;
  std::vector<Equation> equations;  ///< the one whose rows are used
  std::optional<RowStatistics> rows;
  std::shared_ptr<const RowArchive> archive;  ///< the rows themselves, for a second look
  RowCounts counts;
  WindowCounts windows;
  double deflection_low = kUnbounded, deflection_high = -kUnbounded;  ///< of the rows
  std::vector<ElongationRange> elongations;                           ///< per cable, of the rows
  ModeCounts modes;
  bool plateaus = false;         ///< rows at rest were used, there are hardly others
  std::optional<double> offset;  ///< N m, where the options give it
  Eigen::VectorXd taken_off;     ///< known torques beside it, as a combination of columns; or empty

  /// tau, less a given offset and what else is known.
  Eigen::VectorXd torque_response() const;
};

/// `preliminary`: a first curve, whose slope gives the column of theta_0; may be null.
BlockedRows collect_blocked(const ElasticJob& job, double theta_0, const Transmission* preliminary);
/// The same for every joint of the rig, in one pass. `theta_0`: n_joints.
std::vector<BlockedRows> collect_joints(const ElasticJob& job, const Eigen::VectorXd& theta_0,
                                        const Transmission* preliminary);
/// The rows of all joints under each other, each joint's with its weight. Neither equations nor an
/// archive.
BlockedRows stack(const std::vector<BlockedRows>& joints, const std::vector<double>& weights);

/// The rows that `keep` wants, for a fit of their own; ranges and modes stay those of all.
using KeepRow = std::function<bool(const Eigen::Ref<const Eigen::RowVectorXd>& row)>;
BlockedRows rows_where(const BlockedRows& rows, const KeepRow& keep);

/// Motion of the joint (from 0) in both directions: the direction column is not (nearly) a
/// constant.
bool has_both_branches(const BlockedRows& rows, int joint = 0);
/// Speeds vary enough to separate viscous from static friction of the motor.
bool speed_tells_more(const BlockedRows& rows, int joint = 0);

/// The same cables with these orders, one per cable (as far as their laws go).
Transmission with_orders(Transmission transmission, std::span<const int> orders);
/// The same with one order of all.
Transmission with_order(const Transmission& transmission, int order);
std::vector<int> orders_of(const Transmission& transmission);

}  // namespace cablefit
