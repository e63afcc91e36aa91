#include "cablefit/identify/elastic_search.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/identify/identify.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/model/rig_facts.hpp"

namespace cablefit {
namespace {

bool is_elongation(const Estimate& e) { return e.name.starts_with("l_o["); }

bool is_radius(const Estimate& e) { return e.name.starts_with("r_m["); }

void require_determined(const IdentifyResult& joint) {
  for (const Estimate& e : joint.parameters)
    if (is_radius(e) && !e.not_identifiable.empty())
      throw Error(ErrorKind::not_identifiable, fmt::format("{} {}", e.name, e.not_identifiable));
  for (const IdentifyPreload& preload : joint.preloads)
    for (const Estimate& e : preload.parameters)
      if (is_elongation(e) && !e.not_identifiable.empty())
        throw Error(
            ErrorKind::not_identifiable,
            fmt::format("preload '{:.40}': {} {}", preload.name, e.name, e.not_identifiable));
}

/// The logs of one preload, with its l_o and motor radii as known.
std::vector<LogSurvey> known_logs(std::span<const LogSurvey> logs, const IdentifyPreload& preload) {
  std::vector<LogSurvey> known;
  for (const LogSurvey& log : logs) {
    if (std::none_of(log.parts.begin(), log.parts.end(),
                     [&](const PartSurvey& part) { return part.preload == preload.name; }))
      continue;
    known.push_back(log);
    Rig& rig = known.back().plan.rig;
    const SearchedRadii searched = searched_radii(rig.transmission);
    for (std::size_t c = 0; c < rig.transmission.cables.size(); ++c) {
      const Cable& found = preload.transmission.cables[c];
      rig.transmission.cables[c].initial_elongation = found.initial_elongation;
      if (const auto joint = searched[c])
        set_motor_radius(rig.transmission, c, *joint, found.motor_map[*joint].radius(0));
    }
    rig.search_elongation.assign(rig.search_elongation.size(), false);
  }
  return known;
}

/// The first log of a preload, with its rig as the user gave it.
const LogSurvey& log_of(std::span<const LogSurvey> logs, const std::string& preload) {
  return first_log_with(logs, [&](const PartSurvey& part) { return part.preload == preload; });
}

/// The joint fit's numbers with their sd instead of those of this preload alone. Errors and figures
/// are of the given coefficients already; held-out blocks are of fits to the other blocks.
void take_joint(const IdentifyResult& joint, const IdentifyPreload& preload, ElasticFit& fit) {
  fit.parameters = joint.parameters;
  for (const bool elongations : {true, false})
    for (const Estimate& e : preload.parameters)
      if (is_elongation(e) == elongations) fit.parameters.push_back(e);
  fit.transmission = preload.transmission;
  fit.covariance = joint.coefficient_covariance;
  fit.active_bounds = joint.active_bounds;
  if (const Estimate* offset = find_estimate(preload.parameters, "offset"))
    fit.offset = offset->value;
}

void describe_search(const IdentifyResult& joint, const IdentifyPreload& preload,
                     ElasticPreload& out) {
  for (const Decision& d : preload.decisions)
    if (d.name == "l_o") out.decisions.push_back(d);
  out.decisions.push_back(
      {"coefficients", "shared by all preloads",
       fmt::format("{} preload(s) of one set of cables, equilibrium (8c) imposed",
                   joint.preloads.size())});
  const double scale = 1e3;
  const std::string unit = joint.cable_space ? "mm" : unit_for(joint.axes, "mrad");
  for (const Estimate& e : preload.parameters)
    if (is_elongation(e))
      out.selection.push_back(
          fmt::format("{} = {:.5g} +- {:.2g} {}, 95 % within {:.5g} .. {:.5g}{}", e.name,
                      scale * e.value, scale * e.sd, unit, scale * e.ci_low, scale * e.ci_high,
                      e.profiled ? " by profile likelihood" : ""));
  for (const Estimate& e : joint.parameters)
    if (is_radius(e))
      out.selection.push_back(fmt::format("{} = {:.5g} +- {:.2g} {}, 95 % within {:.5g} .. {:.5g}",
                                          e.name, e.value, e.sd, e.unit, e.ci_low, e.ci_high));
  const auto is_there = [&](const Figure& figure) {
    return std::any_of(out.figures.begin(), out.figures.end(),
                       [&](const Figure& other) { return other.title == figure.title; });
  };
  for (const Figure& figure : joint.figures)
    if (figure.section == preload.name && !is_there(figure)) out.figures.push_back(figure);
}

}  // namespace

bool wants_search(std::span<const LogSurvey> logs) {
  return std::any_of(logs.begin(), logs.end(), [](const LogSurvey& log) {
    const std::vector<bool>& search = log.plan.rig.search_elongation;
    return std::find(search.begin(), search.end(), true) != search.end();
  });
}

bool searches_radius(std::span<const LogSurvey> logs) {
  return std::any_of(logs.begin(), logs.end(), [](const LogSurvey& log) {
    return searches_radius(log.plan.rig.transmission);
  });
}

ElasticResult fit_elastic_with_search(std::span<const LogSurvey> logs,
                                      const ElasticOptions& options, bool search_all) {
  IdentifyOptions joint_options;
  joint_options.samples = options.samples;
  joint_options.order = options.order;
  joint_options.elongations = search_all ? ElongationMode::search : ElongationMode::automatic;
  joint_options.unconstrained = options.unconstrained;
  joint_options.robust_sd = options.robust_sd;
  joint_options.preload = options.preload;
  joint_options.figures = options.figures;
  const IdentifyResult joint = identify(logs, joint_options);
  require_determined(joint);

  ElasticOptions each = options;
  each.choose_orders = false;  // the joint fit has them
  if (each.order == 0 && !joint.cable_space) each.order = kDefaultOrder;
  each.zero = ZeroMode::offset;
  ElasticResult result;
  result.inputs = joint.inputs;
  result.elongations = joint.elongations;
  result.warnings = joint.warnings;
  for (const IdentifyPreload& preload : joint.preloads) {
    each.preload = preload.name;
    each.coefficients.clear();
    for (const Cable& cable : preload.transmission.cables)
      each.coefficients.insert(each.coefficients.end(), cable.coefficients.begin(),
                               cable.coefficients.end());
    ElasticResult one = fit_elastic(known_logs(logs, preload), each);
    for (ElasticPreload& stage1 : one.preloads) {
      for (ElasticFit& fit : stage1.fits)
        if (fit.model == "poly") take_joint(joint, preload, fit);
      describe_search(joint, preload, stage1);
      stage1.rig_facts = elastic_facts(log_of(logs, preload.name).plan.rig);
      result.preloads.push_back(std::move(stage1));
    }
  }
  return result;
}

}  // namespace cablefit
