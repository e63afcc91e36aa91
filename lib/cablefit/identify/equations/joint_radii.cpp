#include "cablefit/identify/equations/joint_radii.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/identify/equations/equilibrium.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/samples/weigh/coarse_rows.hpp"

namespace cablefit {
namespace {

constexpr double kFollows = 0.95;  // correlation of theta and q of a link that moves far
// Between positions of a blocked link, over its flicker in one: r_m is then wrong by 1 % at most.
constexpr double kStandsOut = 10;

bool is_of(const std::vector<PreloadJob>& jobs, const PartSurvey& part) {
  return std::any_of(jobs.begin(), jobs.end(),
                     [&](const PreloadJob& job) { return job.name == part.preload; });
}

/// theta on q over all blocks of the preloads' parts, blocked and moving.
CoarseLine followed_line(std::span<const LogSurvey> logs, const std::vector<PreloadJob>& jobs) {
  std::vector<double> q, theta;
  for (const CoarsePart& part : coarse_parts(logs)) {
    if (!is_of(jobs, logs[part.log].parts[part.part])) continue;
    const CoarsePart::Joint& joint = part.joints.front();
    q.insert(q.end(), joint.q.begin(), joint.q.end());
    theta.insert(theta.end(), joint.theta.begin(), joint.theta.end());
  }
  const auto n = static_cast<Eigen::Index>(std::min(q.size(), theta.size()));
  return coarse_line(Eigen::Map<const Eigen::ArrayXd>(q.data(), n),
                     Eigen::Map<const Eigen::ArrayXd>(theta.data(), n));
}

/// An l_o of the rig file is a length that a motor radius can be measured by.
bool knows_length(const PreloadJob& job) {
  for (std::size_t c = 0; c < job.searched.size(); ++c)
    if (!job.searched[c] && job.transmission.cables[c].initial_elongation != 0) return true;
  return false;
}

/// How far q differs between blocked parts, and at most within one; rad.
struct LinkPositions {
  double between = 0, within = 0;
};
LinkPositions positions_of(std::span<const LogSurvey> logs, const std::vector<PreloadJob>& jobs) {
  double low = kUnbounded, high = -kUnbounded;
  LinkPositions positions;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts) {
      if (!is_of(jobs, part)) continue;
      const auto slot = static_cast<std::size_t>(log.plan.find(Channel::q, 0));
      const ChannelSurvey& q = part.channels[slot];
      const double middle = (q.min + q.max) / 2;
      low = std::min(low, middle);
      high = std::max(high, middle);
      positions.within = std::max(positions.within, q.range());
    }
  positions.between = high - low;
  return positions;
}

void require_link_positions(std::span<const LogSurvey> logs, const std::vector<PreloadJob>& jobs) {
  if (std::any_of(jobs.begin(), jobs.end(), knows_length)) return;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts)
      if (is_of(jobs, part) && part.phase == Phase::moving) return;
  const LinkPositions positions = positions_of(logs, jobs);
  if (positions.between > kStandsOut * positions.within) return;
  const std::vector<bool>& searched = jobs.front().searched_radius;
  const auto first = std::find(searched.begin(), searched.end(), true) - searched.begin();
  const Cable& cable = jobs.front().transmission.cables[static_cast<std::size_t>(first)];
  throw Error(ErrorKind::not_identifiable,
              fmt::format("{} is not separable from the stiffness: the link is blocked in one "
                          "position (q differs by {:.2g} rad between logs, by {:.2g} rad within "
                          "one), which shows motor_radius^2 k_0 alone; record moving logs for "
                          "`cablefit identify`, block the link in several positions, or give the "
                          "radius",
                          radius_name(cable), positions.between, positions.within));
}

/// Whether a cable of the group may be stretched in the reference pose.
bool may_be_taut(const PreloadJob& job, const std::vector<std::size_t>& group) {
  return std::any_of(group.begin(), group.end(), [&](std::size_t c) {
    return job.searched[c] || job.transmission.cables[c].initial_elongation > 0;
  });
}

}  // namespace

Eigen::VectorXd searched_radii(const JointFit& fit) {
  std::vector<double> radii;
  const PreloadJob& job = fit.jobs.front();
  for (std::size_t c = 0; c < job.searched_radius.size(); ++c)
    if (job.searched_radius[c])
      radii.push_back(job.transmission.cables[c].motor_map.front().radius(0));
  return Eigen::Map<const Eigen::VectorXd>(radii.data(), static_cast<Eigen::Index>(radii.size()));
}

void set_radii(const Eigen::VectorXd& radii, std::vector<PreloadJob>& jobs) {
  for (PreloadJob& job : jobs) {
    Eigen::Index next = 0;
    for (std::size_t c = 0; c < job.searched_radius.size(); ++c)
      if (job.searched_radius[c]) set_motor_radius(job.transmission, c, radii(next++));
  }
}

JointFit with_radii(JointFit fit, const Eigen::VectorXd& radii) {
  set_radii(radii, fit.jobs);
  for (auto& rows : fit.known) rows.clear();
  return fit;
}

void start_radii(std::span<const LogSurvey> logs, std::vector<PreloadJob>& jobs) {
  if (!searches_radius(jobs.front())) return;
  require_link_positions(logs, jobs);
  const CoarseLine line = followed_line(logs, jobs);
  if (std::abs(line.correlation) < kFollows) return;
  for (PreloadJob& job : jobs)
    for (std::size_t c = 0; c < job.searched_radius.size(); ++c) {
      if (!job.searched_radius[c]) continue;
      const Cable& cable = job.transmission.cables[c];
      const double on_link = cable.link_radii(job.transmission.reference_q())(0);
      const double radius = on_link / line.slope, given = cable.motor_map.front().radius(0);
      if (radius * given < 0)
        throw input_error(
            {logs.front().plan.rig.path, 0, 0},
            fmt::format("the search of the motor radius of cable '{}' starts from {:.3g} m, but "
                        "theta against q shows about {:.2g} m",
                        cable.name, given, radius),
            "turn its sign, or that of link_radius");
      if (radius != 0) set_motor_radius(job.transmission, c, radius);
    }
}

Eigen::MatrixXd tie_rows(const PreloadJob& job, const JointLayout& layout) {
  const auto n_params = static_cast<Eigen::Index>(layout.parameters.size());
  Eigen::MatrixXd rows(0, n_params);
  if (!searches_radius(job)) return rows;
  for (const std::vector<std::size_t>& group : cable_groups(job.transmission)) {
    if (!may_be_taut(job, group)) continue;
    Eigen::RowVectorXd first;
    for (const std::size_t c : group) {
      if (!job.searched_radius[c]) continue;
      const Cable& cable = job.transmission.cables[c];
      Eigen::RowVectorXd relative = Eigen::RowVectorXd::Zero(n_params);
      relative(layout.find(radius_name(cable), kShared)) = 1 / cable.motor_map.front().radius(0);
      if (first.size() == 0) {
        first = relative;
        continue;
      }
      rows.conservativeResize(rows.rows() + 1, n_params);
      rows.bottomRows(1) = relative - first;
    }
  }
  return rows;
}

void require_tied_radii(const PreloadJob& job, const std::string& rig_path) {
  if (!searches_radius(job)) return;
  for (const std::vector<std::size_t>& group : cable_groups(job.transmission)) {
    if (!may_be_taut(job, group)) continue;
    const auto is_searched = [&](std::size_t c) -> bool { return job.searched_radius[c]; };
    if (std::none_of(group.begin(), group.end(), is_searched)) continue;
    const auto given = std::find_if_not(group.begin(), group.end(), is_searched);
    if (given != group.end())
      throw input_error(
          {rig_path, 0, 0},
          fmt::format("preload '{:.40}': the motor radius of cable '{}' is given, but cables that "
                      "pull against each other have one motor_radius / link_radius",
                      job.name, job.transmission.cables[*given].name),
          "search the motor radii of all of them, or give them all");
  }
  const auto n = static_cast<Eigen::Index>(job.transmission.cables.size());
  const bool any_taut = may_be_taut(job, cable_groups(job.transmission).front());
  if (any_taut && !can_balance(job.transmission, Eigen::VectorXd::Ones(n)))
    throw input_error(
        {rig_path, 0, 0},
        fmt::format("preload '{:.40}': no cable forces balance with the motor radii to start from",
                    job.name),
        "start from radii of one motor_radius / link_radius, with their signs");
}

}  // namespace cablefit
