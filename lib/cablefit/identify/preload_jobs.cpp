#include "cablefit/identify/preload_jobs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/dynamic/dynamic_job.hpp"
#include "cablefit/elastic/blocked_rows.hpp"
#include "cablefit/identify/joint_model.hpp"
#include "cablefit/samples/agreement.hpp"

namespace cablefit {
namespace {

constexpr int kDefaultOrder = 2;    // the paper's
constexpr double kWideBand = 0.15;  // of the rate: the widest band the differences allow
constexpr std::size_t kMinRows = 10;

PartFilter moving_parts(const std::string& preload) {
  return [preload](const PartSurvey& part) {
    return part.phase == Phase::moving && part.preload == preload;
  };
}

PartFilter parts_of(const std::string& preload) {
  return [preload](const PartSurvey& part) { return part.preload == preload; };
}

/// Cables of one rig are those of the other: only l_o may differ.
bool same_cables(const Transmission& a, const Transmission& b) {
  if (a.cables.size() != b.cables.size()) return false;
  for (std::size_t c = 0; c < a.cables.size(); ++c) {
    const Cable &x = a.cables[c], &y = b.cables[c];
    if (x.name != y.name || x.law != y.law || x.order != y.order || x.toe != y.toe) return false;
    for (const double angle : {-0.1, 0.0, 0.2})
      if (x.motor_map.front().radius(angle) != y.motor_map.front().radius(angle) ||
          x.link_map.front().radius(angle) != y.link_map.front().radius(angle))
        return false;
  }
  return true;
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
    reason = "given";
    return std::vector<bool>(n, true);
  }
  if (options.elongations == ElongationMode::known) {
    reason =
        rig.cables_given ? "given; those of the rig file" : "given; 0, no cables in a rig file";
    if (std::find(searched.begin(), searched.end(), true) != searched.end())
      throw input_error({rig.path, 0, 0}, "the rig file says to search an initial elongation",
                        "give a number, or leave --l_o known out");
    return searched;
  }
  if (rig.cables_given) return searched;
  reason =
      several ? "several preloads, and no cables in the rig file to tell" : "one preload alone";
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
  const bool any = std::find(job.searched.begin(), job.searched.end(), true) != job.searched.end();
  if (!any && !can_balance(job.transmission, elongations_of(job.transmission)))
    throw input_error(
        {facts.rig.path, 0, 0},
        fmt::format("preload '{:.40}': the initial elongations cannot balance, whatever the cables "
                    "that are taut in the reference pose pull with: motor and link would move",
                    job.name),
        "give every cable its elongation, or \"search\"; check the signs of the radii, and that "
        "motor_radius / link_radius is the same for cables that pull against each other");
}

JointEquation equation_of(Side side, const ChosenSettings& settings) {
  const DynamicColumns columns = dynamic_columns(side, {});
  JointEquation equation;
  equation.base =
      dynamic_equation(columns, {}, settings.rows.signal.torque_held,
                       side == Side::link ? settings.rest_speed_q : settings.rest_speed_theta);
  if (side == Side::link) equation.base.cutoff = settings.cutoff_q;
  for (const Effect* effect : columns.effects)
    for (const ParameterInfo& info : effect->parameters)
      equation.own.push_back(
          {std::string(info.name), static_cast<Eigen::Index>(equation.own.size())});
  equation.response = columns.torque;
  equation.motor_side = side == Side::motor;
  return equation;
}

JointRecord record_of(const std::string& preload, const ChosenSettings& settings) {
  return {moving_parts(preload),
          settings.rows,
          {equation_of(Side::link, settings), equation_of(Side::motor, settings)}};
}

void note_load(std::span<const LogSurvey> logs, PreloadFacts& facts) {
  const Load& load = facts.rig.load;
  if (load.law != nullptr) {
    facts.load_inertia = load.law->inertia(load.parameters);
    return;
  }
  for (const LogSurvey& log : logs)
    if (std::any_of(log.parts.begin(), log.parts.end(), moving_parts(facts.name)) &&
        !log.plan.has(Channel::tau_load))
      facts.warnings.push_back(fmt::format(
          "{}: no tau_load column and no load law in the rig file: the load torque is taken as 0",
          log.plan.path));
}

}  // namespace

std::vector<PreloadJob> begin_jobs(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                                   std::vector<PreloadFacts>& facts, IdentifyResult& result) {
  std::vector<PreloadJob> jobs;
  for (const PreloadFacts& f : facts) {
    PreloadJob job;
    job.name = f.name;
    job.transmission = cables_of(f.rig, options.order);
    job.transmission.theta_0 = Eigen::VectorXd::Zero(1);
    job.cable_space = f.rig.cables_given;
    job.linear_motion = f.rig.linear_motion;
    jobs.push_back(std::move(job));
  }
  for (std::size_t j = 1; j < jobs.size(); ++j)
    if (!same_cables(jobs[0].transmission, jobs[j].transmission) ||
        jobs[0].cable_space != jobs[j].cable_space ||
        jobs[0].linear_motion != jobs[j].linear_motion)
      throw input_error(
          {first_log_with(logs, parts_of(jobs[j].name)).plan.path, 0, 0},
          fmt::format("preloads '{:.40}' and '{:.40}' have rigs with different cables",
                      jobs[0].name, jobs[j].name),
          "one fit is of one set of cables: only \"initial_elongation\" may differ");
  for (std::size_t j = 0; j < jobs.size(); ++j)
    decide_elongations(jobs[j], jobs.size() > 1, options, facts[j]);
  result.linear_motion = jobs[0].linear_motion;
  result.cable_space = jobs[0].cable_space;
  return jobs;
}

JointRecord blocked_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                           bool moving, PreloadFacts& facts) {
  ElasticOptions elastic;
  elastic.samples = options.samples;
  elastic.order = 1;
  const ElasticJob job = make_job(logs, elastic, facts.name);
  const BlockedRows rows = collect_blocked(job, 0, nullptr);
  if (static_cast<std::size_t>(rows.rows->n_rows()) < kMinRows)
    throw Error(ErrorKind::not_identifiable,
                fmt::format("preload '{:.40}': {} usable rows of a blocked link are too few; sweep "
                            "the motor slowly up and down, several times",
                            facts.name, rows.rows->n_rows()));
  const bool both = has_both_branches(rows);
  if (!both)
    facts.warnings.push_back(
        "theta moves in one direction only while the link is blocked: the motor's static friction "
        "cannot be told from the elastic torque; sweep up and down");
  JointEquation equation;
  equation.base = blocked_equation(job.basis, nullptr, !rows.plateaus, job.rest_speeds.front(),
                                   job.still_speeds.front());
  equation.own = {{"offset", rows.columns.offset}};
  if (both) equation.own.push_back({moving ? kBlockedFriction : "f_sm", rows.columns.direction});
  if (both && speed_tells_more(rows)) equation.own.push_back({kCreep, rows.columns.speed});
  equation.response = rows.columns.tau;
  for (const Decision& d : job.settings.decisions)
    facts.decisions.push_back({"blocked: " + d.name, d.value, d.reason});
  facts.warnings.insert(facts.warnings.end(), job.settings.warnings.begin(),
                        job.settings.warnings.end());
  return {job.wanted, job.settings.rows, {equation}};
}

JointRecord first_moving_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                                const PreloadFacts& facts) {
  const PartFilter wanted = moving_parts(facts.name);
  SampleOptions wide = options.samples;
  if (!wide.cutoff) wide.cutoff = kWideBand * sample_rates(logs, wanted).lowest;
  ChosenSettings settings = moving_settings(logs, wanted, wide, 0);
  settings.rows.signal.torque_period = facts.rig.torque_period;
  settings.rows.signal.torque_held =
      options.samples.torque_hold.value_or(facts.rig.torque_hold) == TorqueHold::zoh;
  return record_of(facts.name, settings);
}

JointRecord moving_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                          const Transmission& fitted, const DeflectionRange& deflections,
                          PreloadFacts& facts) {
  const PartFilter wanted = moving_parts(facts.name);
  require_agreement(logs, wanted, facts.name);
  note_load(logs, facts);
  ElasticFit elastic;
  elastic.model = "poly";
  elastic.transmission = fitted;
  ElasticResult stage1;
  stage1.preloads.emplace_back();
  stage1.preloads.back().name = facts.name;
  stage1.preloads.back().deflection_low = deflections.low;
  stage1.preloads.back().deflection_high = deflections.high;
  DynamicOptions dynamic;
  dynamic.samples = options.samples;
  DynamicJob job{logs, dynamic, facts.name, wanted, {&elastic}, {"poly"}, false, {}, {}};
  DynamicPreload found;
  choose_settings(job, found, stage1);
  facts.delay = found.delay;
  facts.resonance = found.resonance;
  for (const Decision& d : job.settings.decisions)
    facts.decisions.push_back({"moving: " + d.name, d.value, d.reason});
  for (const auto* warnings : {&found.warnings, &job.settings.warnings})
    facts.warnings.insert(facts.warnings.end(), warnings->begin(), warnings->end());
  return record_of(facts.name, job.settings);
}

}  // namespace cablefit
