#include "cablefit/identify/equations/preload_jobs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/elastic/rows/blocked_rows.hpp"
#include "cablefit/identify/equations/equilibrium.hpp"
#include "cablefit/identify/equations/joint_radii.hpp"
#include "cablefit/model/effects/effects_per_joint.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

PartFilter parts_of(const std::string& preload) {
  return [preload](const PartSurvey& part) { return part.preload == preload; };
}

bool same_maps(const std::vector<DisplacementMap>& a, const std::vector<DisplacementMap>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const DisplacementMap& x, const DisplacementMap& y) {
                      return x.kind == y.kind &&
                             x.kind->entries(x.parameters) == y.kind->entries(y.parameters);
                    });
}

bool same_pairs(const std::vector<PairMap>& a, const std::vector<PairMap>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const PairMap& x, const PairMap& y) {
    return x.kind == y.kind && x.joints == y.joints &&
           x.kind->entries(x.parameters) == y.kind->entries(y.parameters);
  });
}

/// Cables of one rig are those of the other: only l_o may differ.
bool same_cables(const Transmission& a, const Transmission& b) {
  if (a.cables.size() != b.cables.size()) return false;
  for (std::size_t c = 0; c < a.cables.size(); ++c) {
    const Cable &x = a.cables[c], &y = b.cables[c];
    if (x.name != y.name || x.law != y.law || x.order != y.order || x.toe != y.toe) return false;
    if (!same_maps(x.motor_map, y.motor_map) || !same_maps(x.link_map, y.link_map)) return false;
    if (!same_pairs(x.motor_pairs, y.motor_pairs) || !same_pairs(x.link_pairs, y.link_pairs))
      return false;
  }
  return true;
}

bool same_arm(const Arm* a, const Arm* b) {
  if (a == nullptr || b == nullptr) return a == b;
  return a->kind == b->kind && a->kind->entries(a->parameters) == b->kind->entries(b->parameters);
}

Transmission cables_of(const Rig& rig, int order) {
  if (order > 0) return with_order(rig.transmission, order);
  return rig.cables_given ? rig.transmission : with_order(rig.transmission, kDefaultOrder);
}

/// Per cable whether l_o is looked for, and why.
std::vector<bool> searched_cables(const Rig& rig, const IdentifyOptions& options, bool several,
                                  std::string& reason) {
  const std::size_t n = rig.transmission.cables.size();
  std::vector<bool> searched(n, false);
  for (std::size_t c = 0; c < rig.search_elongation.size() && c < n; ++c)
    searched[c] = rig.search_elongation[c];
  reason = "by the rig file";
  if (options.elongations == ElongationMode::search) {
    reason = options.search_reason;
    return std::vector<bool>(n, true);
  }
  if (options.elongations == ElongationMode::known) {
    reason =
        rig.cables_given ? "given; those of the rig file" : "given; 0, no cables in a rig file";
    if (std::find(searched.begin(), searched.end(), true) != searched.end())
      throw input_error({rig.path, 0, 0}, "the rig file says to search an initial elongation",
                        "give a number, or leave --l-o known out");
    return searched;
  }
  if (rig.cables_given) return searched;
  reason = several ? "several preloads, and no cables in the rig file" : "one preload alone";
  return std::vector<bool>(n, several);
}

void decide_elongations(PreloadJob& job, bool several, const IdentifyOptions& options,
                        PreloadFacts& facts) {
  std::string reason;
  job.searched = searched_cables(facts.rig, options, several, reason);
  std::string value;
  for (std::size_t c = 0; c < job.searched.size(); ++c) {
    Cable& cable = job.transmission.cables[c];
    if (job.searched[c]) cable.initial_elongation = 0;
    value +=
        fmt::format("{}{} {}", c > 0 ? ", " : "", elongation_name(cable),
                    job.searched[c] ? "searched" : fmt::format("= {:g}", cable.initial_elongation));
  }
  facts.decisions.push_back({"l_o", value, reason});
  require_tied_radii(job, facts.rig.path);
  const bool any = std::find(job.searched.begin(), job.searched.end(), true) != job.searched.end();
  if (!any && !can_balance(job.transmission, elongations_of(job.transmission)))
    throw input_error(
        {facts.rig.path, 0, 0},
        fmt::format("preload '{:.40}': no cable forces balance these initial elongations in the "
                    "reference pose: motor and link would move",
                    job.name),
        "give every cable its elongation, or \"search\"; check the signs of the radii, and that "
        "motor_radius / link_radius is the same for cables that pull against each other");
}

void note_radii(const PreloadJob& job, PreloadFacts& facts) {
  std::string value;
  bool moved = false;
  for (std::size_t c = 0; c < job.searched_radius.size(); ++c) {
    if (!job.searched_radius[c]) continue;
    const Cable& cable = job.transmission.cables[c];
    const std::size_t joint = *job.searched_radius[c];
    const double start = cable.motor_map[joint].radius(0);
    value +=
        fmt::format("{}{} searched from {:.3g}{}", value.empty() ? "" : ", ", radius_name(cable),
                    start, facts.rig.axes.of(static_cast<int>(joint)) == Axes::linear ? "" : " m");
    moved = moved || start != facts.rig.transmission.cables[c].motor_map[joint].radius(0);
  }
  facts.decisions.push_back(
      {"r_m", value, moved ? "the reduction that theta against q shows" : "by the rig file"});
}

/// Without any torque.
std::shared_ptr<const Transmission> unknown_cables(int n_joints) {
  Transmission none;
  none.n_joints = n_joints;
  none.linear_stiffness = Eigen::VectorXd::Zero(n_joints);
  none.theta_0 = Eigen::VectorXd::Zero(n_joints);
  return std::make_shared<const Transmission>(std::move(none));
}

}  // namespace

std::vector<PreloadFacts> preloads_of(std::span<const LogSurvey> logs,
                                      const IdentifyOptions& options) {
  std::vector<PreloadFacts> facts;
  for (const std::string& name : preload_names(logs, [&](const PartSurvey& part) {
         return options.preload.empty() || options.preload == part.preload;
       })) {
    PreloadFacts f;
    f.name = name;
    const Rig& rig = first_log_with(logs, parts_of(name)).plan.rig;
    f.added = of_joints(options.effects, rig.n_joints());
    f.rig = rig;
    f.arm = rig.arm.kind != nullptr ? &rig.arm : nullptr;
    f.cables = unknown_cables(rig.n_joints());
    require_agreement(logs, parts_of(name), name);
    const Load& load = f.rig.load;
    if (load.law != nullptr) f.load_inertia = load.law->inertia(load.parameters);
    for (const LogSurvey& log : logs)
      for (const PartSurvey& part : log.parts)
        if (part.preload == name)
          (part.phase == Phase::blocked ? f.has_blocked : f.has_moving) = true;
    facts.push_back(std::move(f));
  }
  return facts;
}

std::vector<PreloadJob> begin_jobs(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                                   std::vector<PreloadFacts>& facts, IdentifyResult& result) {
  std::vector<PreloadJob> jobs;
  for (const PreloadFacts& f : facts) {
    PreloadJob job;
    job.name = f.name;
    job.transmission = cables_of(f.rig, options.order);
    job.transmission.theta_0 = Eigen::VectorXd::Zero(f.rig.n_joints());
    job.cable_space = f.rig.cables_given;
    job.axes = f.rig.axes;
    job.load_inertia = f.load_inertia;
    job.arm = f.arm;
    job.searched_radius = searched_radii(f.rig.transmission);
    for (std::size_t c = 0; c < job.searched_radius.size(); ++c)
      if (const auto joint = job.searched_radius[c])
        set_motor_radius(job.transmission, c, *joint,
                         job.transmission.cables[c].motor_map[*joint].radius(0));
    jobs.push_back(std::move(job));
  }
  for (std::size_t j = 1; j < jobs.size(); ++j)
    if (!same_cables(jobs[0].transmission, jobs[j].transmission) ||
        jobs[0].cable_space != jobs[j].cable_space || jobs[0].axes != jobs[j].axes ||
        jobs[0].searched_radius != jobs[j].searched_radius)
      throw input_error(
          {first_log_with(logs, parts_of(jobs[j].name)).plan.path, 0, 0},
          fmt::format("preloads '{:.40}' and '{:.40}' have rigs with different cables",
                      jobs[0].name, jobs[j].name),
          "one fit is of one set of cables: only \"initial_elongation\" may differ");
  for (std::size_t j = 1; j < jobs.size(); ++j)
    if (!same_arm(jobs[0].arm, jobs[j].arm))
      throw input_error(
          {first_log_with(logs, parts_of(jobs[j].name)).plan.path, 0, 0},
          fmt::format("preloads '{:.40}' and '{:.40}' have rigs with different arms", jobs[0].name,
                      jobs[j].name),
          "one fit is of one arm: give its preloads the same \"arm\", or fit them apart with "
          "--preload");
  for (std::size_t j = 0; j < jobs.size(); ++j)
    decide_elongations(jobs[j], jobs.size() > 1, options, facts[j]);
  start_radii(logs, jobs);
  if (searches_radius(jobs.front()))
    for (std::size_t j = 0; j < jobs.size(); ++j) note_radii(jobs[j], facts[j]);
  result.axes = jobs[0].axes.all();
  result.cable_space = jobs[0].cable_space;
  return jobs;
}

}  // namespace cablefit
