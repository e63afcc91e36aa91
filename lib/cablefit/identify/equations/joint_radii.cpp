#include "cablefit/identify/equations/joint_radii.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

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

/// theta of the motor that a cable winds on, against h(q) of the cable, over all blocks of the
/// preloads' parts, blocked and moving. What the cable gets from other motors is part of h.
CoarseLine followed_line(std::span<const LogSurvey> logs, const std::vector<PreloadJob>& jobs,
                         const Cable& cable, std::size_t motor) {
  std::vector<double> way, theta;
  for (const CoarsePart& part : coarse_parts(logs)) {
    if (!is_of(jobs, logs[part.log].parts[part.part])) continue;
    const auto q_at = [&](Eigen::Index i) {
      return [&part, i](std::size_t k) { return part.joints[k].q(i); };
    };
    const Eigen::ArrayXd& turned = part.joints[motor].theta;
    for (Eigen::Index i = 0; i < turned.size(); ++i) {
      double h = cable.link_side().displacement(q_at(i));
      for (std::size_t k = 0; k < part.joints.size(); ++k)
        if (k != motor) h -= cable.motor_map[k].displacement(part.joints[k].theta(i));
      way.push_back(h);
      theta.push_back(turned(i));
    }
  }
  const auto n = static_cast<Eigen::Index>(theta.size());
  return coarse_line(Eigen::Map<const Eigen::ArrayXd>(way.data(), n),
                     Eigen::Map<const Eigen::ArrayXd>(theta.data(), n));
}

/// An l_o of the rig file is a length that a motor radius can be measured by.
bool knows_length(const PreloadJob& job) {
  for (std::size_t c = 0; c < job.searched.size(); ++c)
    if (!job.searched[c] && job.transmission.cables[c].initial_elongation != 0) return true;
  return false;
}

/// How far q of a joint differs between blocked parts, and at most within one; rad.
struct LinkPositions {
  double between = 0, within = 0;
  bool differ() const { return between > kStandsOut * within; }
};
LinkPositions positions_of(std::span<const LogSurvey> logs, const std::vector<PreloadJob>& jobs,
                           int joint) {
  double low = kUnbounded, high = -kUnbounded;
  LinkPositions positions;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts) {
      if (!is_of(jobs, part)) continue;
      const auto slot = static_cast<std::size_t>(log.plan.find(Channel::q, joint));
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
  const PreloadJob& job = jobs.front();
  for (std::size_t c = 0; c < job.searched_radius.size(); ++c) {
    if (!job.searched_radius[c]) continue;
    const Cable& cable = job.transmission.cables[c];
    LinkPositions positions;
    for (int joint = 0; joint < job.n_joints() && !positions.differ(); ++joint)
      if (cable.link_side().passes(static_cast<std::size_t>(joint)))
        positions = positions_of(logs, jobs, joint);
    if (positions.differ()) continue;
    throw Error(
        ErrorKind::not_identifiable,
        fmt::format("{} is not separable from the stiffness: the link is blocked in one position "
                    "(q differs by {:.2g} rad between logs, by {:.2g} rad within one), which shows "
                    "motor_radius^2 k_0 alone; record moving logs for `cablefit identify`, block "
                    "the link in several positions, or give the radius",
                    radius_name(cable), positions.between, positions.within));
  }
}

/// Cables with a pulley on the motor of a joint.
std::vector<std::size_t> cables_on(const Transmission& transmission, std::size_t motor) {
  std::vector<std::size_t> cables;
  for (std::size_t c = 0; c < transmission.cables.size(); ++c)
    if (transmission.cables[c].motor_side().passes(motor)) cables.push_back(c);
  return cables;
}

/// Whether a cable of the group may be stretched in the reference pose.
bool may_be_taut(const PreloadJob& job, const std::vector<std::size_t>& group) {
  return std::any_of(group.begin(), group.end(), [&](std::size_t c) {
    return job.searched[c] || job.transmission.cables[c].initial_elongation > 0;
  });
}

/// The radius of a cable that the logs show over the one it starts from; none: they do not show it.
std::optional<double> factor_shown(std::span<const LogSurvey> logs,
                                   const std::vector<PreloadJob>& jobs, std::size_t c) {
  const PreloadJob& job = jobs.front();
  const Cable& cable = job.transmission.cables[c];
  const CoarseLine line = followed_line(logs, jobs, cable, *job.searched_radius[c]);
  if (std::abs(line.correlation) < kFollows) return std::nullopt;
  const double radius = 1 / line.slope, given = searched_radius(job, c);
  if (radius * given < 0)
    throw input_error({logs.front().plan.rig.path, 0, 0},
                      fmt::format("the search of the motor radius of cable '{}' starts from {:.3g} "
                                  "m, but theta against q shows about {:.2g} m",
                                  cable.name, given, radius),
                      "turn its sign, or that of link_radius");
  return radius / given;
}

bool is_searched_on(const PreloadJob& job, std::size_t cable, std::size_t motor) {
  return job.searched_radius[cable] == std::optional(motor);
}

}  // namespace

double searched_radius(const PreloadJob& job, std::size_t cable) {
  return job.transmission.cables[cable].motor_map[*job.searched_radius[cable]].radius(0);
}

std::vector<std::vector<Eigen::Index>> radius_groups(std::span<const PreloadJob> jobs) {
  const PreloadJob& job = jobs.front();
  const auto is_tied = [&](std::size_t motor) {
    const std::vector<std::size_t> cables = cables_on(job.transmission, motor);
    return std::any_of(jobs.begin(), jobs.end(),
                       [&](const PreloadJob& j) { return may_be_taut(j, cables); });
  };
  std::vector<std::vector<Eigen::Index>> groups;
  std::vector<std::size_t> place_in(static_cast<std::size_t>(job.n_joints()));
  std::vector<bool> begun(place_in.size(), false);
  Eigen::Index next = 0;
  for (std::size_t c = 0; c < job.searched_radius.size(); ++c) {
    if (!job.searched_radius[c]) continue;
    const std::size_t motor = *job.searched_radius[c];
    if (!begun[motor] || !is_tied(motor)) {
      begun[motor] = true;
      place_in[motor] = groups.size();
      groups.emplace_back();
    }
    groups[place_in[motor]].push_back(next++);
  }
  return groups;
}

Eigen::VectorXd searched_radii(const JointFit& fit) {
  std::vector<double> radii;
  const PreloadJob& job = fit.jobs.front();
  for (std::size_t c = 0; c < job.searched_radius.size(); ++c)
    if (job.searched_radius[c]) radii.push_back(searched_radius(job, c));
  return Eigen::Map<const Eigen::VectorXd>(radii.data(), static_cast<Eigen::Index>(radii.size()));
}

void set_radii(const Eigen::VectorXd& radii, std::vector<PreloadJob>& jobs) {
  for (PreloadJob& job : jobs) {
    Eigen::Index next = 0;
    for (std::size_t c = 0; c < job.searched_radius.size(); ++c)
      if (job.searched_radius[c])
        set_motor_radius(job.transmission, c, *job.searched_radius[c], radii(next++));
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
  const PreloadJob& start = jobs.front();
  Eigen::VectorXd radii(0);
  std::vector<std::optional<double>> factor;
  for (std::size_t c = 0; c < start.searched_radius.size(); ++c) {
    if (!start.searched_radius[c]) continue;
    const double given = searched_radius(start, c);
    radii.conservativeResize(radii.size() + 1);
    radii.tail<1>()(0) = given;
    factor.push_back(factor_shown(logs, jobs, c));
  }
  // Radii that balance stay so.
  for (const std::vector<Eigen::Index>& group : radius_groups(jobs)) {
    double ln_sum = 0, n = 0;
    for (const Eigen::Index k : group)
      if (const auto shown = factor[static_cast<std::size_t>(k)]) {
        ln_sum += std::log(*shown);
        ++n;
      }
    for (const Eigen::Index k : group)
      if (n > 0) radii(k) *= std::exp(ln_sum / n);
  }
  set_radii(radii, jobs);
}

Eigen::MatrixXd tie_rows(const PreloadJob& job, const JointLayout& layout) {
  const auto n_params = static_cast<Eigen::Index>(layout.parameters.size());
  Eigen::MatrixXd rows(0, n_params);
  if (!searches_radius(job)) return rows;
  for (const std::vector<Eigen::Index>& group : radius_groups({&job, 1})) {
    const auto relative = [&](Eigen::Index k) -> Eigen::RowVectorXd {
      const Eigen::Index place = layout.first_radius() + k;
      const std::size_t cable = layout.parameters[static_cast<std::size_t>(place)].cable;
      return Eigen::RowVectorXd::Unit(n_params, place) / searched_radius(job, cable);
    };
    for (std::size_t i = 1; i < group.size(); ++i) {
      rows.conservativeResize(rows.rows() + 1, n_params);
      rows.bottomRows(1) = relative(group[i]) - relative(group[0]);
    }
  }
  return rows;
}

void require_tied_radii(const PreloadJob& job, const std::string& rig_path) {
  if (!searches_radius(job)) return;
  bool any_taut = false;
  for (int joint = 0; joint < job.n_joints(); ++joint) {
    const auto motor = static_cast<std::size_t>(joint);
    const std::vector<std::size_t> group = cables_on(job.transmission, motor);
    if (!may_be_taut(job, group)) continue;
    any_taut = true;
    const auto is_searched = [&](std::size_t c) { return is_searched_on(job, c, motor); };
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
  if (any_taut && !can_balance(job.transmission, Eigen::VectorXd::Ones(n)))
    throw input_error(
        {rig_path, 0, 0},
        fmt::format("preload '{:.40}': no cable forces balance with the motor radii to start from",
                    job.name),
        "start from radii of one motor_radius / link_radius, with their signs");
}

}  // namespace cablefit
