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

/// theta on q over all blocks of the preloads' parts, blocked and moving.
CoarseLine followed_line(std::span<const LogSurvey> logs, const std::vector<PreloadJob>& jobs) {
  std::vector<double> q, theta;
  for (const CoarsePart& part : coarse_parts(logs)) {
    const std::string& preload = logs[part.log].parts[part.part].preload;
    if (std::none_of(jobs.begin(), jobs.end(),
                     [&](const PreloadJob& job) { return job.name == preload; }))
      continue;
    const CoarsePart::Joint& joint = part.joints.front();
    q.insert(q.end(), joint.q.begin(), joint.q.end());
    theta.insert(theta.end(), joint.theta.begin(), joint.theta.end());
  }
  const auto n = static_cast<Eigen::Index>(std::min(q.size(), theta.size()));
  return coarse_line(Eigen::Map<const Eigen::ArrayXd>(q.data(), n),
                     Eigen::Map<const Eigen::ArrayXd>(theta.data(), n));
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
  const CoarseLine line = followed_line(logs, jobs);
  if (std::abs(line.correlation) < kFollows) return;
  for (PreloadJob& job : jobs)
    for (std::size_t c = 0; c < job.searched_radius.size(); ++c) {
      if (!job.searched_radius[c]) continue;
      const Cable& cable = job.transmission.cables[c];
      const double on_link = cable.link_radii(job.transmission.reference_q())(0);
      const double radius = on_link / line.slope;
      // Of the other sign, or of a link pulley without radius there: the rig file knows better.
      if (radius * cable.motor_map.front().radius(0) > 0)
        set_motor_radius(job.transmission, c, radius);
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
