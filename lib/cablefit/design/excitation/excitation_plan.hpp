// The motion to record next: a reference trajectory that shows the parameters of stage 2 best, and
// the sd to expect of it.
#pragma once

#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/design/excitation/excitation.hpp"
#include "cablefit/design/excitation/planned_fit.hpp"
#include "cablefit/figure/figure.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit {

struct ExcitationPlan {
  std::string shape;
  ExcitationLimits limits;
  Axes axes = Axes::rotary;
  std::vector<std::string> joints;
  PlannedFit fit;
  /// The same of one sine over all of the range at full speed, and of one of the best frequency.
  struct Sine {
    double hz = 0;
    PlannedFit fit;    ///< without parameters where there is no such sine
    double worst = 0;  ///< infinite then
  };
  Sine plain, best;
  ExcitedMotion motion;
  int n_tried = 0;
  std::vector<Decision> decisions;
  std::vector<Figure> figures;
  /// How much larger the worst relative error of a plain sine is; infinite: it does not show all.
  double factor() const { return plain.worst / fit.worst(); }
  double factor_of_best() const { return best.worst / fit.worst(); }
};

/// Minimises the worst relative error of FitPlanner. Throws as excitable(), FitPlanner and
/// search_excitation() do.
ExcitationPlan plan_excitation(const Model& model, const ExcitationOptions& options, bool figures);

/// "t,theta_ref,thetad_ref" (theta_ref1, ... for several joints), s, rad, rad/s.
std::string reference_csv(const ExcitedMotion& motion);

}  // namespace cablefit
