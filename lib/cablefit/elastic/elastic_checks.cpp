#include "cablefit/elastic/elastic_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/model/modes.hpp"

namespace cablefit {
namespace {

constexpr double kPathShare = 0.02;  // of the peak torque: left over by the best static law
constexpr double kLoopShare = 0.05;  // of the peak torque: a loop this wide is worth words

}  // namespace

void check_passive(ElasticFit& fit, const ElasticPreload& preload, const ElongationUnit& unit) {
  if (fit.model == "linear") {
    fit.passive = fit.transmission.linear_stiffness(0) >= 0;
    if (!fit.passive)
      fit.warnings.emplace_back(
          "the stiffness is negative: the sign of tau or of theta is turned round");
    return;
  }
  for (const Cable& cable : fit.transmission.cables) {
    const double longest = longest_elongation(fit.transmission, cable, preload.deflection_low,
                                              preload.deflection_high);
    if (longest <= 0) {
      fit.warnings.push_back(fmt::format("cable {} was never taut in these logs", cable.name));
      continue;
    }
    const std::optional<Push> push = find_push(cable, longest);
    if (!push) continue;
    fit.passive = false;
    fit.warnings.push_back(fmt::format(
        "{}, which breaks (5) and (16) of the paper: do not use this fit; without --unconstrained "
        "cables only pull",
        push_text(cable, *push, unit)));
  }
}

void select_model(ElasticPreload& preload, double materiality) {
  const ElasticFit& linear = preload.fits.front();
  const ElasticFit& poly = preload.fits.back();
  const char* unit = preload.linear_motion ? "N" : "N m";
  const double allowed = materiality * preload.peak_torque;
  const double best = std::min(linear.held_out_max, poly.held_out_max);
  const bool linear_will_do = linear.held_out_max <= best + allowed;
  preload.selected = linear_will_do ? "linear" : "poly";
  preload.selection.push_back(
      fmt::format("materiality: largest error on held-out blocks {:.3g} {} linear, {:.3g} {} poly; "
                  "{:.3g} {} ({:g} % of the "
                  "peak torque) may separate them: {}",
                  linear.held_out_max, unit, poly.held_out_max, unit, allowed, unit,
                  100 * materiality, preload.selected));
  preload.selection.push_back(
      fmt::format("significance: rms on held-out blocks {:.3g} {} linear, {:.3g} {} poly: {}",
                  linear.held_out_rms, unit, poly.held_out_rms, unit,
                  poly.held_out_rms < linear.held_out_rms ? "poly" : "linear"));
}

void note_loop(ElasticPreload& preload, bool plateaus) {
  const char* unit = preload.linear_motion ? "N" : "N m";
  const ElasticFit& best = *preload.find(preload.selected);
  const Estimate* friction = find_estimate(best.parameters, "f_sm");
  preload.loop_half_width =
      friction != nullptr && friction->not_identifiable.empty() ? friction->value : 0;
  const double peak = preload.peak_torque;
  const double share = peak > 0 ? preload.loop_half_width / peak : 0;
  const double left = peak > 0 ? best.rms_error / peak : 0;
  // A friction band is as wide everywhere; what is left beyond it depends on the path.
  if (left > kPathShare && (share > kLoopShare || left > kLoopShare))
    preload.warnings.push_back(fmt::format(
        "no static law explains this loop: it is {:.3g} {} wide ({:.0f} % of the peak torque of "
        "{:.3g} {}) and {:.3g} "
        "{} rms remain beyond a constant friction band; suspect hysteresis or friction that grows "
        "with load",
        2 * preload.loop_half_width, unit, 200 * share, peak, unit, best.rms_error, unit));
  if (plateaus)
    preload.warnings.emplace_back(
        "the motor hardly moves between plateaus: torques at rest lie within the friction band, so "
        "f_sm is a lower "
        "estimate; sweep slowly up and down instead");
}

void note_closure(ElasticPreload& preload) {
  const ElasticFit& poly = preload.fits.back();
  if (poly.model != "poly" || poly.transmission.cables.size() != 2) return;
  for (const Cable& cable : poly.transmission.cables)
    if (cable.initial_elongation != 0 || cable.coefficients.empty()) return;
  // With l_o = 0 each cable acts on its own side. A preloaded pair is about twice as stiff at zero
  // as where one cable has gone slack, so its slope FALLS away from zero on both sides.
  const double reach = std::min(-preload.deflection_low, preload.deflection_high);
  if (!(reach > 0)) return;
  int falling = 0;
  for (const Cable& cable : poly.transmission.cables) {
    const double stretch = std::abs(cable.motor_map.front().radius(0)) * reach;
    falling += cable.stiffness(0.2 * stretch) < 0.9 * cable.stiffness(1e-6 * stretch);
  }
  if (falling == 2)
    preload.warnings.emplace_back(
        "the stiffness falls on both sides of zero, as with cables that are both taut there "
        "(preload): with l_o = 0 "
        "the coefficients describe the curve, not the cables");
}

}  // namespace cablefit
