#include "cablefit/elastic/checks/elastic_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/model/equilibrium.hpp"
#include "cablefit/model/modes.hpp"

namespace cablefit {
namespace {

constexpr double kPathShare = 0.02;  // of the peak torque: left over by the best static law
constexpr double kLoopShare = 0.05;  // of the peak torque: a loop this wide is worth words

}  // namespace

void check_passive(ElasticFit& fit, std::span<const double> all_longest,
                   const ElongationUnit& unit) {
  if (fit.model == "linear") {
    fit.passive = fit.transmission.linear_stiffness.minCoeff() >= 0;
    if (!fit.passive)
      fit.warnings.emplace_back(
          "the stiffness is negative: the sign of tau or of theta is reversed");
    return;
  }
  for (std::size_t c = 0; c < fit.transmission.cables.size(); ++c) {
    const Cable& cable = fit.transmission.cables[c];
    const double longest = all_longest[c];
    if (longest <= 0) {
      fit.warnings.push_back(fmt::format("cable {} was never taut in these logs", cable.name));
      continue;
    }
    const std::optional<Push> push = find_push(cable, longest);
    if (!push) continue;
    fit.passive = false;
    fit.warnings.push_back(
        fmt::format("{}, not physical by (5) and (16) of the paper: do not use this fit; fit again "
                    "without --unconstrained",
                    push_text(cable, *push, unit)));
  }
}

void select_model(ElasticPreload& preload, double materiality) {
  const ElasticFit& linear = preload.fits.front();
  const ElasticFit& poly = preload.fits.back();
  const std::string unit = torque_unit(preload.axes);
  const double allowed = materiality * preload.peak_torque;
  const double best = std::min(linear.held_out_max, poly.held_out_max);
  const bool linear_will_do = linear.held_out_max <= best + allowed;
  preload.selected = linear_will_do ? "linear" : "poly";
  preload.selection.push_back(
      fmt::format("materiality: largest error on held-out blocks {:.3g} {} linear, {:.3g} {} "
                  "poly; a difference below {:.3g} {} ({:g} % of the peak torque) does not "
                  "matter: {}",
                  linear.held_out_max, unit, poly.held_out_max, unit, allowed, unit,
                  100 * materiality, preload.selected));
  preload.selection.push_back(
      fmt::format("significance: rms on held-out blocks {:.3g} {} linear, {:.3g} {} poly: {}",
                  linear.held_out_rms, unit, poly.held_out_rms, unit,
                  poly.held_out_rms < linear.held_out_rms ? "poly" : "linear"));
}

void select_joint_model(ElasticPreload& preload, double materiality) {
  const ElasticFit& linear = preload.fits.front();
  const ElasticFit& poly = preload.fits.back();
  const std::string unit = torque_unit(preload.axes);
  bool linear_will_do = true;
  for (std::size_t k = 0; k < preload.joints.size(); ++k) {
    const double allowed = materiality * preload.joints[k].peak_torque;
    const double best = std::min(linear.joints[k].held_out_max, poly.joints[k].held_out_max);
    const bool will_do = linear.joints[k].held_out_max <= best + allowed;
    linear_will_do = linear_will_do && will_do;
    preload.selection.push_back(
        fmt::format("joint {}: largest error on held-out blocks {:.3g} {} linear, {:.3g} {} poly; "
                    "a difference below {:.3g} {} ({:g} % of its peak torque) does not matter: {}; "
                    "rms {:.3g} linear, {:.3g} poly",
                    k + 1, linear.joints[k].held_out_max, unit, poly.joints[k].held_out_max, unit,
                    allowed, unit, 100 * materiality, will_do ? "linear" : "poly",
                    linear.joints[k].held_out_rms, poly.joints[k].held_out_rms));
  }
  preload.selected = linear_will_do ? "linear" : "poly";
}

bool depends_on_path(const LoopSeen& loop) {
  if (!(loop.peak > 0)) return false;
  const double share = loop.half_width / loop.peak, left = loop.rms / loop.peak;
  // A friction band is as wide everywhere; what is left beyond it depends on the path.
  return left > kPathShare && (share > kLoopShare || left > kLoopShare);
}

std::vector<std::string> loop_warnings(const LoopSeen& loop, Axes axes) {
  const std::string unit = torque_unit(axes);
  std::vector<std::string> warnings;
  if (depends_on_path(loop))
    warnings.push_back(
        fmt::format("no static friction explains this loop: it is {:.3g} {} wide ({:.0f} % of the "
                    "peak torque of {:.3g} {}) and {:.3g} {} rms remain beyond a constant friction "
                    "band; suspect hysteresis or friction that grows with load",
                    2 * loop.half_width, unit, 200 * loop.half_width / loop.peak, loop.peak, unit,
                    loop.rms, unit));
  if (loop.plateaus)
    warnings.emplace_back(
        "the motor hardly moves between plateaus: torques at rest lie within the friction band, so "
        "f_sm is a lower "
        "estimate; sweep slowly up and down instead");
  return warnings;
}

namespace {

ElasticMisfit& misfit_of_selected(ElasticPreload& preload) {
  return std::find_if(preload.fits.begin(), preload.fits.end(),
                      [&](const ElasticFit& fit) { return fit.model == preload.selected; })
      ->misfit;
}

double largest(const ElasticMisfit& misfit, double MisfitPoint::*part) {
  double most = 0;
  for (const MisfitPoint& point : misfit.points) most = std::max(most, std::abs(point.*part));
  return most;
}

/// Where means by deflection do not show the loop, its half width is the rms of the residual.
void add_loop(double left, ElasticPreload& preload) {
  ElasticMisfit& misfit = misfit_of_selected(preload);
  if (largest(misfit, &MisfitPoint::half_width) > 0) return;
  if (misfit.empty()) misfit.points = {{preload.deflection_low}, {preload.deflection_high}};
  for (MisfitPoint& point : misfit.points) point.half_width = left;
}

void note_misfit(ElasticPreload& preload) {
  const ElasticMisfit& misfit = misfit_of_selected(preload);
  if (misfit.empty()) return;
  const std::string unit = torque_unit(preload.axes);
  preload.decisions.push_back({"misfit of the " + preload.selected + " fit",
                               fmt::format("a curve of up to {:.2g} {}, a loop of +-{:.2g} {}",
                                           largest(misfit, &MisfitPoint::torque), unit,
                                           largest(misfit, &MisfitPoint::half_width), unit),
                               "stage 2 carries it into its intervals"});
}

}  // namespace

void note_loop(ElasticPreload& preload, double left, bool plateaus) {
  const ElasticFit& best = *preload.find(preload.selected);
  const Estimate* friction = find_estimate(best.parameters, "f_sm");
  preload.loop_half_width =
      friction != nullptr && friction->not_identifiable.empty() ? friction->value : 0;
  const LoopSeen loop{preload.loop_half_width, preload.peak_torque, left, plateaus};
  for (std::string& warning : loop_warnings(loop, preload.axes))
    preload.warnings.push_back(std::move(warning));
  if (depends_on_path(loop)) add_loop(left, preload);
  note_misfit(preload);
}

bool looks_preloaded(const Transmission& transmission, std::span<const ElongationRange> ranges) {
  if (transmission.n_joints > 1 || transmission.cables.size() != 2) return false;
  // With l_o = 0 each cable acts on its own side. A preloaded pair is about twice as stiff at zero
  // as where one cable has gone slack, so its slope FALLS away from zero on both sides.
  for (std::size_t c = 0; c < 2; ++c) {
    const Cable& cable = transmission.cables[c];
    if (cable.initial_elongation != 0 || cable.coefficients.empty()) return false;
    const double stretch = std::min(-ranges[c].low, ranges[c].high);
    if (!(stretch > 0) || !(cable.stiffness(0.2 * stretch) < 0.9 * cable.stiffness(1e-6 * stretch)))
      return false;
  }
  return true;
}

void note_closure(std::span<const ElongationRange> ranges, ElasticPreload& preload) {
  const ElasticFit& poly = preload.fits.back();
  if (poly.model != "poly" || !looks_preloaded(poly.transmission, ranges)) return;
  preload.shape_doubt =
      "the stiffness falls on both sides of zero, as with cables that are both taut there "
      "(preload)";
  preload.warnings.push_back(preload.shape_doubt +
                             ": with l_o = 0 the coefficients describe the curve, not the cables");
}

void note_imbalance(ElasticPreload& preload) {
  const ElasticFit& cables = preload.fits.back();
  if (!is_preloaded(cables.transmission)) return;
  for (Eigen::Index k = 0; k < cables.covariance.rows(); ++k)
    if (!cables.parameters[static_cast<std::size_t>(k)].not_identifiable.empty()) return;
  for (const Imbalance& imbalance : imbalances(cables.transmission))
    preload.warnings.push_back(
        imbalance_text(imbalance, cables.transmission.n_joints, preload.axes));
}

}  // namespace cablefit
