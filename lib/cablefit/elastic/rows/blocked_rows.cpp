#include "cablefit/elastic/rows/blocked_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

constexpr double kSlidingShare = 0.1;     // fewer rows in motion: the log is made of plateaus
constexpr double kSpeedCollinear = 0.98;  // speed and direction are not separable

/// The rest speed and the warnings of one of several joints (from 0) among those of all.
void add_joint_rest(ChosenSettings& all, const ChosenSettings& own, int joint, int n_joints) {
  constexpr const char* kRest = "rest speed";  // the only choice that depends on the joint
  std::erase_if(all.decisions, [&](const Decision& decision) { return decision.name == kRest; });
  for (Decision decision : own.decisions) {
    if (decision.name != kRest) continue;
    decision.name = joint_parameter_name(kRest, joint + 1, n_joints);
    all.decisions.push_back(std::move(decision));
  }
  for (const std::string& warning : own.warnings)
    if (std::find(all.warnings.begin(), all.warnings.end(), warning) == all.warnings.end())
      all.warnings.push_back(warning);
}

}  // namespace

Transmission with_orders(Transmission transmission, std::span<const int> orders) {
  for (std::size_t c = 0; c < orders.size(); ++c) {
    Cable& cable = transmission.cables[c];
    cable.order = std::min(orders[c], cable.law->max_order);
  }
  return transmission;
}

Transmission with_order(const Transmission& transmission, int order) {
  return with_orders(transmission, std::vector<int>(transmission.cables.size(), order));
}

std::vector<int> orders_of(const Transmission& transmission) {
  std::vector<int> orders;
  for (const Cable& cable : transmission.cables) orders.push_back(cable.order);
  return orders;
}

namespace {

/// Empty: to be chosen.
std::vector<int> given_orders(const Rig& rig, const ElasticOptions& options) {
  const std::size_t n = rig.transmission.cables.size();
  if (options.order > 0) return std::vector<int>(n, options.order);
  if (options.orders.empty())
    return rig.cables_given && !options.choose_orders ? orders_of(rig.transmission)
                                                      : std::vector<int>{};
  if (options.orders.size() == n) return options.orders;
  throw usage_error(
      fmt::format("--order gives {} orders, but there are {} cables", options.orders.size(), n),
      "give one order for all, or one per cable in the order of the rig file");
}

/// Rest speeds of every joint; decisions and warnings of the others beside those of the first.
void add_joint_speeds(ElasticJob& job) {
  const int n = job.basis.n_joints;
  for (int joint = 0; joint < n; ++joint) {
    const ChosenSettings own =
        joint == 0 ? job.settings
                   : blocked_settings(job.logs, job.wanted, job.options.samples, joint);
    job.rest_speeds.push_back(own.rest_speed_theta);
    job.still_speeds.push_back(job.options.still ? std::max(own.rest_speed_q, 1e-12) : 0);
    if (n > 1) add_joint_rest(job.settings, own, joint, n);
  }
}

}  // namespace

ElasticJob make_job(std::span<const LogSurvey> logs, const ElasticOptions& options,
                    const std::string& name) {
  const bool still = options.still;
  ElasticJob job{logs,
                 [name, still](const PartSurvey& part) {
                   return part.preload == name && (still || part.phase == Phase::blocked);
                 },
                 options,
                 {},
                 {},
                 {},
                 {},
                 {}};
  require_agreement(logs, job.wanted, name);
  job.settings = blocked_settings(logs, job.wanted, options.samples);
  const Rig& rig = job.rig();
  job.orders = given_orders(rig, options);
  job.basis = job.orders.empty() ? with_order(rig.transmission, options.max_order)
                                 : with_orders(rig.transmission, job.orders);
  add_joint_speeds(job);
  if (still) {
    job.settings.rows.signal.quasi_static = false;  // the motor need not be slow
    // The link rests only for moments: keep more rows of them.
    if (!options.samples.decimate) {
      job.settings.rows.decimate = std::max(1, job.settings.rows.decimate / 8);
      for (Decision& decision : job.settings.decisions)
        if (decision.name == "decimation")
          decision = {"decimation", std::to_string(job.settings.rows.decimate),
                      "the link stands still only for short times"};
    }
  }
  return job;
}

std::vector<int> preliminary_orders(const ElasticJob& job) {
  constexpr int kPreliminaryOrder = 2;
  return job.orders.empty() ? std::vector<int>(job.basis.cables.size(), kPreliminaryOrder)
                            : job.orders;
}

namespace {

/// One pass over the logs; rows in motion (even) and at rest (odd) of every joint.
struct Collected {
  std::vector<Equation> equations;
  std::vector<RowStatistics> statistics;
  std::vector<RowCounts> counts;
  std::vector<std::shared_ptr<RowArchive>> archives;
  WindowCounts windows;
};

Collected collect(const ElasticJob& job, const Transmission& transmission,
                  const Transmission* preliminary) {
  Collected all;
  for (int joint = 0; joint < transmission.n_joints; ++joint)
    for (const bool sliding : {true, false}) {
      all.equations.push_back(blocked_equation(
          transmission, preliminary, sliding, job.rest_speeds[static_cast<std::size_t>(joint)],
          job.still_speeds[static_cast<std::size_t>(joint)], joint));
      all.equations.back().shares_columns = !sliding;  // of the same joint
    }
  const Eigen::Index expected = expected_rows(job.logs, job.wanted, job.settings.rows);
  const RowStatistics blank(blocked_columns(transmission).count, expected);
  all.statistics.assign(all.equations.size(), blank);
  all.counts.resize(all.equations.size());
  for (std::size_t k = 0; k < all.equations.size(); ++k)
    all.archives.push_back(std::make_shared<RowArchive>());
  struct Result {
    std::vector<RowStatistics> statistics;
    RowBatch batch;
  };
  all.windows = stream_rows(
      job.logs, job.wanted, job.settings.rows, all.equations, job.options.samples.threads,
      [&](RowBatch batch) {
        Result result;
        for (const EquationBatch& equation : batch.equations) {
          result.statistics.push_back(blank.empty_copy());
          result.statistics.back().add(equation.rows, equation.numbers);
        }
        result.batch = std::move(batch);
        return result;
      },
      [&](Result&& result) {
        for (std::size_t k = 0; k < all.equations.size(); ++k) {
          all.statistics[k].add(std::move(result.statistics[k]));
          all.archives[k]->append(result.batch.equations[k]);
          all.counts[k] += result.batch.equations[k].counts;
        }
      });
  return all;
}

/// A cable is taut where its (low-passed) elongation is positive, not where its basis is: that
/// rings beyond its slack point.
void count_modes(BlockedRows& blocked, const Eigen::MatrixXd& rows) {
  using Flags = Eigen::Array<bool, Eigen::Dynamic, 1>;
  Flags closure = Flags::Constant(rows.rows(), true);
  for (std::size_t k = 0; k < blocked.modes.slack.size(); ++k) {
    const Flags taut =
        rows.col(blocked.columns.elongation + static_cast<Eigen::Index>(k)).array() > 0;
    blocked.modes.slack[k].rows += static_cast<std::size_t>(taut.size() - taut.count());
    closure = closure && taut;
  }
  blocked.modes.closure += static_cast<std::size_t>(closure.count());
}

/// Deflections, modes and elongations of the rows.
void measure_ranges(BlockedRows& blocked, Eigen::Index deflection_column) {
  const BlockedColumns& c = blocked.columns;
  blocked.elongations.resize(blocked.transmission.cables.size());
  for (const Cable& cable : blocked.transmission.cables)
    blocked.modes.slack.push_back({cable.name, 0});
  blocked.archive->for_each([&](const Eigen::MatrixXd& rows, std::span<const Eigen::Index>) {
    const auto deflection = rows.col(deflection_column);
    blocked.deflection_low = std::min(blocked.deflection_low, deflection.minCoeff());
    blocked.deflection_high = std::max(blocked.deflection_high, deflection.maxCoeff());
    count_modes(blocked, rows);
    for (std::size_t k = 0; k < blocked.elongations.size(); ++k)
      blocked.elongations[k].include(rows.col(c.elongation + static_cast<Eigen::Index>(k)));
  });
}

/// Of one joint, in motion or, where there is hardly any, at rest. Takes them out of `all`: those
/// of a hand fill some hundred megabytes.
BlockedRows take_joint(Collected& all, const Transmission& transmission, int joint) {
  const std::size_t first = 2 * static_cast<std::size_t>(joint);
  BlockedRows blocked;
  blocked.transmission = transmission;
  blocked.columns = blocked_columns(transmission);
  blocked.windows = all.windows;
  const auto sliding = static_cast<double>(all.counts[first].rows_used);
  const auto holding = static_cast<double>(all.counts[first + 1].rows_used);
  // Plateaus: the torque at rest lies anywhere within the friction band, but the side from which a
  // place was approached decides on which half; better than nothing, and said so.
  blocked.plateaus = sliding < kSlidingShare * (sliding + holding);
  const std::size_t chosen = first + (blocked.plateaus ? 1 : 0);
  blocked.equations = {all.equations[chosen]};
  blocked.equations.front().shares_columns = false;  // it now stands alone
  blocked.rows = std::move(all.statistics[chosen]);
  blocked.archive = std::move(all.archives[chosen]);
  blocked.counts = all.counts[chosen];
  if (!blocked.plateaus) blocked.counts.rows_at_rest = all.counts[first].rows_at_rest;
  measure_ranges(blocked, blocked.columns.of_joint(joint).deflection);
  return blocked;
}

}  // namespace

std::vector<BlockedRows> collect_joints(const ElasticJob& job, const Eigen::VectorXd& theta_0,
                                        const Transmission* preliminary) {
  Transmission transmission = job.basis;
  transmission.theta_0 = theta_0;
  Collected all = collect(job, transmission, preliminary);
  std::vector<BlockedRows> joints;
  for (int joint = 0; joint < transmission.n_joints; ++joint) {
    joints.push_back(take_joint(all, transmission, joint));
    joints.back().offset = job.options.offset;
  }
  return joints;
}

BlockedRows collect_blocked(const ElasticJob& job, double theta_0,
                            const Transmission* preliminary) {
  const Eigen::VectorXd zeros = Eigen::VectorXd::Constant(job.basis.n_joints, theta_0);
  return collect_joints(job, zeros, preliminary).front();
}

BlockedRows stack(const std::vector<BlockedRows>& joints, const std::vector<double>& weights) {
  BlockedRows all;
  all.transmission = joints.front().transmission;
  all.columns = joints.front().columns;
  all.windows = joints.front().windows;
  all.offset = joints.front().offset;
  all.elongations.resize(all.transmission.cables.size());
  for (const Cable& cable : all.transmission.cables) all.modes.slack.push_back({cable.name, 0});
  std::vector<const RowStatistics*> rows;
  for (const BlockedRows& joint : joints) {
    rows.push_back(&*joint.rows);
    all.counts += joint.counts;
    all.deflection_low = std::min(all.deflection_low, joint.deflection_low);
    all.deflection_high = std::max(all.deflection_high, joint.deflection_high);
    for (std::size_t k = 0; k < all.elongations.size(); ++k) {
      all.elongations[k].include(joint.elongations[k]);
      all.modes.slack[k].rows += joint.modes.slack[k].rows;
    }
    all.modes.closure += joint.modes.closure;
  }
  all.rows = RowStatistics::weighted(rows, weights);
  return all;
}

Eigen::VectorXd BlockedRows::torque_response() const {
  Eigen::VectorXd response = Eigen::VectorXd::Unit(columns.count, columns.tau);
  if (offset) response.segment(columns.offset, columns.n_joints).setConstant(-*offset);
  if (taken_off.size() > 0) response -= taken_off;
  return response;
}

BlockedRows rows_where(const BlockedRows& rows, const KeepRow& keep) {
  BlockedRows some = rows;
  some.rows = rows.rows->empty_copy();
  rows.archive->for_each([&](const Eigen::MatrixXd& r, std::span<const Eigen::Index> numbers) {
    std::vector<Eigen::Index> kept, kept_numbers;
    for (Eigen::Index i = 0; i < r.rows(); ++i) {
      if (!keep(r.row(i))) continue;
      kept.push_back(i);
      kept_numbers.push_back(numbers[static_cast<std::size_t>(i)]);
    }
    if (!kept.empty()) some.rows->add(r(kept, Eigen::all), kept_numbers);
  });
  return some;
}

bool has_both_branches(const BlockedRows& rows, int joint) {
  const auto& r = rows.rows->r();
  const BlockedColumns c = rows.columns.of_joint(joint);
  const double sum = r.col(c.direction).dot(r.col(c.offset));
  const double n = r.col(c.offset).squaredNorm();
  return n > 0 && std::abs(sum) < 0.95 * n;
}

bool speed_tells_more(const BlockedRows& rows, int joint) {
  const auto& r = rows.rows->r();
  const BlockedColumns c = rows.columns.of_joint(joint);
  const auto direction = r.col(c.direction);
  const auto speed = r.col(c.speed);
  const double norms = direction.norm() * speed.norm();
  return norms > 0 && std::abs(direction.dot(speed)) < kSpeedCollinear * norms;
}

}  // namespace cablefit
