#include "cablefit/dynamic/loops/model_of_solutions.hpp"

#include <algorithm>

#include "cablefit/model/assembled_model.hpp"
#include "cablefit/model/effects/effects_per_joint.hpp"

namespace cablefit {
namespace {

/// What the equations' columns say of a parameter: the value that was given, or else the solution.
FindEstimate finder(const std::vector<EquationRows>& equations,
                    const std::vector<LinearSolution>& solutions) {
  return [&](const Estimate& blank) -> std::optional<Estimate> {
    for (std::size_t k = 0; k < equations.size(); ++k) {
      const std::vector<DynamicParameter>& parameters = equations[k].columns.parameters;
      const auto found =
          std::find_if(parameters.begin(), parameters.end(),
                       [&](const DynamicParameter& p) { return p.name == blank.name; });
      if (found == parameters.end()) continue;
      Estimate e = blank;
      e.value = found->given.value_or(solutions[k].x(found - parameters.begin()));
      return e;
    }
    return std::nullopt;
  };
}

/// The effects beyond (31), with what the columns of either side say of their parameters.
EffectsPerJoint added_of(const DynamicJob& job, const std::vector<EquationRows>& equations,
                         const std::vector<LinearSolution>& solutions) {
  EffectsPerJoint added = job.added;
  for (std::size_t k = 0; k < equations.size(); ++k)
    take_values(equations[k].columns, solutions[k].x, added);
  return added;
}

}  // namespace

Model model_of_solutions(const DynamicJob& job, const std::vector<EquationRows>& equations,
                         const std::vector<LinearSolution>& solutions, std::size_t which) {
  Model model = assembled_model(job.rig(), job.rigid, finder(equations, solutions));
  model.name = job.models[which];
  model.preload = job.preload;
  if (!job.rigid) model.transmission = job.elastic[which]->transmission;
  set_added_effects(added_of(job, equations, solutions), model);
  return model;
}

}  // namespace cablefit
