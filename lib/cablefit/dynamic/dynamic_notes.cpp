#include "cablefit/dynamic/dynamic_notes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/dynamic/estimates/estimates.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

constexpr double kRangeSlack = 0.02;  // of stage 1's range: rounding, not extrapolation
constexpr double kFarBeyond = 2;      // of stage 1's range: the curve there is a guess

/// Stage 1's range is where its curve was fitted; beyond it the curve is a guess.
struct Range {
  double low = kUnbounded, high = -kUnbounded;
};

Range deflections_of(const ElasticPreload& stage1, int joint) {
  if (stage1.joints.empty()) return {stage1.deflection_low, stage1.deflection_high};
  const ElasticJoint& own = stage1.joints[static_cast<std::size_t>(joint)];
  return {own.deflection_low, own.deflection_high};
}

/// Of the moving logs, as stage 1 counts them.
Range deflections_of(const std::vector<EquationRows>& equations, int joint, double theta_0) {
  Range seen;
  for (const EquationRows& e : equations) {
    if (e.columns.place.joint != joint) continue;
    seen.low = std::min(seen.low, e.deflection_low - theta_0);
    seen.high = std::max(seen.high, e.deflection_high - theta_0);
  }
  return seen;
}

std::string extrapolation(const ElasticPreload& stage1, const Range& known, const Range& seen,
                          int joint) {
  const double slack = kRangeSlack * (known.high - known.low);
  if (seen.low >= known.low - slack && seen.high <= known.high + slack) return {};
  return fmt::format(
      "{}deflections of {:.3g} to {:.3g} {} are outside the range of stage 1 ({:.3g} "
      "to {:.3g}): the elastic torque is extrapolated there",
      stage1.joints.empty() ? "" : fmt::format("joint {}: ", joint + 1), seen.low, seen.high,
      stage1.unit, known.low, known.high);
}

/// Stage 1 of the job's preload; nullptr: there is none, as for a rigid drive.
const ElasticPreload* stage1_of(const DynamicJob& job, const ElasticResult& elastic) {
  if (job.rigid) return nullptr;
  for (const ElasticPreload& stage1 : elastic.preloads)
    if (stage1.name == job.preload) return &stage1;
  return nullptr;
}

bool is_far_beyond(const DynamicJob& job, const std::vector<EquationRows>& equations,
                   const ElasticResult& elastic) {
  const ElasticPreload* const stage1 = stage1_of(job, elastic);
  if (stage1 == nullptr) return false;
  for (int joint = 0; joint < job.n_joints(); ++joint) {
    const Range known = deflections_of(*stage1, joint);
    const Range seen =
        deflections_of(equations, joint, job.elastic.front()->transmission.theta_0(joint));
    if (known.high > known.low && seen.high - seen.low > kFarBeyond * (known.high - known.low))
      return true;
  }
  return false;
}

/// Coefficients that stage 1 left open, of cables that pull.
std::vector<std::string> open_coefficients(const ElasticFit& stage1) {
  std::vector<std::string> open;
  std::size_t k = 0;  // coefficients are the first parameters
  for (const Cable& cable : stage1.transmission.cables)
    for (const double coefficient : cable.coefficients) {
      if (k == stage1.parameters.size()) break;
      const Estimate& e = stage1.parameters[k++];
      if (coefficient != 0 && !e.not_identifiable.empty()) open.push_back(e.name);
    }
  return open;
}

/// An offset that stage 1 does not separate from its curve is that of the chosen curve.
void refuse_offsets(const ElasticFit& stage1, DynamicFit& fit) {
  for (Estimate& e : fit.parameters) {
    const Estimate* same = find_estimate(stage1.parameters, e.name);
    if (!e.name.starts_with("offset") || same == nullptr || same->not_identifiable.empty())
      continue;
    refuse(e, "stage 1 does not separate it from its curve");
    fit.verdicts[e.name] = "not identifiable";
    fit.covariance = {};
  }
}

/// The equation of a fit that explains least, among those that explain little; nullptr: none does.
const JudgedEquation* worst_equation(const DynamicPreload& preload, const std::string& model) {
  const JudgedEquation* worst = nullptr;
  for (const JudgedEquation& e : preload.residual_tests)
    if (e.model == model && !e.headline.empty() &&
        (worst == nullptr || e.relative > worst->relative))
      worst = &e;
  return worst;
}

}  // namespace

void note_extrapolations(const DynamicJob& job, const std::vector<EquationRows>& equations,
                         const ElasticResult& elastic, DynamicPreload& preload) {
  const ElasticPreload* const stage1 = stage1_of(job, elastic);
  if (stage1 == nullptr || has_trusted_finding(job.logs, job.wanted)) return;
  std::vector<std::string> warnings;
  for (int joint = 0; joint < job.n_joints(); ++joint) {
    const double theta_0 = job.elastic.front()->transmission.theta_0(joint);
    const Range known = deflections_of(*stage1, joint);
    if (!(known.high > known.low)) continue;  // the cables of a model
    std::string warning =
        extrapolation(*stage1, known, deflections_of(equations, joint, theta_0), joint);
    if (!warning.empty()) warnings.push_back(std::move(warning));
  }
  preload.warnings.insert(preload.warnings.begin(), warnings.begin(), warnings.end());
}

void note_open_curves(const DynamicJob& job, DynamicPreload& preload) {
  if (job.rigid) return;
  for (std::size_t m = 0; m < job.models.size() && m < job.elastic.size(); ++m) {
    const std::vector<std::string> open = open_coefficients(*job.elastic[m]);
    if (open.empty()) continue;
    for (DynamicFit& fit : preload.fits)
      if (fit.model == job.models[m]) refuse_offsets(*job.elastic[m], fit);
    preload.warnings.push_back(
        fmt::format("{}: stage 1 does not determine {}: offsets depend on which of the equal "
                    "curves is used, and K_rest, f_0 and zeta are not given; let the cables go "
                    "slack in a blocked log",
                    job.models[m], fmt::join(open, ", ")));
  }
}

void note_blocked_friction(const DynamicJob& job, const ElasticResult& elastic,
                           DynamicPreload& preload) {
  constexpr double kFar = 5;      // sd
  constexpr double kMuch = 0.03;  // of the friction in motion
  const ElasticPreload* const stage1 = stage1_of(job, elastic);
  if (stage1 == nullptr) return;
  for (const DynamicFit& fit : preload.fits) {
    const ElasticFit* const same = stage1->find(fit.model);
    if (same == nullptr) continue;
    for (const Estimate& moving : fit.parameters) {
      const Estimate* const blocked = find_estimate(same->parameters, moving.name);
      if (!moving.name.starts_with("f_sm") || blocked == nullptr) continue;
      const double apart = std::abs(moving.value - blocked->value);
      if (!(apart > kFar * std::hypot(moving.sd, blocked->sd) && apart > kMuch * moving.value))
        continue;
      const char* const cause = blocked->value < moving.value
                                    ? "a blocked motor that sticks and slips has less friction on "
                                      "average; sweep faster or log faster"
                                    : "check the torque hold; friction may also depend on speed";
      preload.warnings.push_back(
          fmt::format("{} is {:.4g} {} while the link is blocked and {:.4g} {} in motion: {}",
                      moving.name, blocked->value, moving.unit, moving.value, moving.unit, cause));
    }
  }
}

void keep_causes(const DynamicJob& job, const std::vector<EquationRows>& equations,
                 const ElasticResult& elastic, DynamicPreload& preload) {
  const bool trusted = has_trusted_finding(job.logs, job.wanted);
  const bool explained = trusted || is_far_beyond(job, equations, elastic);
  if (trusted) std::erase(preload.warnings, preload.delay.warning);
  std::vector<std::string> headlines;
  for (DynamicFit& fit : preload.fits) {
    const JudgedEquation* const worst = worst_equation(preload, fit.model);
    if (!explained && worst != nullptr)
      headlines.push_back(
          fmt::format("{} equation, {}: {}", worst->equation, fit.model, worst->headline));
    if (!explained && worst == nullptr)
      fit.warnings.insert(fit.warnings.end(), fit.doubts.begin(), fit.doubts.end());
    fit.doubts.clear();
  }
  preload.warnings.insert(preload.warnings.begin(), headlines.begin(), headlines.end());
}

void note_load(const DynamicJob& job, DynamicPreload& preload) {
  const Load& load = job.rig().load;
  if (load.law != nullptr) {
    preload.load_inertia = load.law->inertia(load.parameters);
    const bool by_position =
        load.law->torque(load.parameters, 0.1) != load.law->torque(load.parameters, -0.2);
    if (job.rigid && !load.law->from_column && by_position)
      require_measured(job.first_log().plan, Channel::theta, "a load that depends on position");
    return;
  }
  if (job.rigid) return;
  // First: most other warnings follow from it.
  const std::vector<std::string> unloaded = unloaded_warnings(job.logs, job.wanted);
  preload.warnings.insert(preload.warnings.begin(), unloaded.begin(), unloaded.end());
}

void note_free_fall(const Load& load, const std::vector<EquationRows>& equations,
                    DynamicPreload& preload) {
  if (load.law == nullptr || load.law->free_fall == nullptr) return;
  const EquationRows& link = equations.front();  // or the one of a rigid drive
  const double most = load.law->free_fall(load.parameters);
  if (link.acceleration > most)
    preload.warnings.push_back(
        fmt::format("the link accelerates with up to {:.3g} rad/s^2, more than {:.3g} rad/s^2 "
                    "(g/r): there the rope of a '{}' load goes slack and tau_load is wrong; "
                    "accelerate less, or hang the mass on a smaller radius",
                    link.acceleration, most, load.law->name));
}

}  // namespace cablefit
