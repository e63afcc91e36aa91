#include "cablefit/dynamic/loops/fitted_model.hpp"

namespace cablefit {
namespace {

/// The effects of the equation's own joint with their values.
std::vector<EffectInstance> effects_of(const DynamicColumns& columns, const LinearSolution& s) {
  std::vector<EffectInstance> result;
  Eigen::Index next = columns.first_effect;
  for (const Effect* effect : columns.effects) {
    EffectInstance& instance = result.emplace_back();
    instance.effect = effect;
    for (std::size_t k = 0; k < effect->parameters.size(); ++k) {
      const DynamicParameter& parameter = columns.parameters[static_cast<std::size_t>(next)];
      Estimate& e = instance.parameters.emplace_back();
      e.name = parameter.name;
      e.value = parameter.given ? *parameter.given : s.x(next);
      ++next;
    }
  }
  return result;
}

/// The effects beyond (31), with what the columns of either side say of their parameters.
std::vector<RefinementInstance> added_of(const DynamicJob& job,
                                         const std::vector<EquationRows>& equations,
                                         const std::vector<LinearSolution>& solutions) {
  std::vector<RefinementInstance> added = job.added;
  for (std::size_t k = 0; k < equations.size(); ++k)
    take_values(equations[k].columns, solutions[k].x, added);
  return added;
}

}  // namespace

Model fitted_model(const DynamicJob& job, const std::vector<EquationRows>& equations,
                   const std::vector<LinearSolution>& solutions, std::size_t which) {
  Model model;
  model.name = job.models[which];
  model.preload = job.preload;
  model.rig = job.rig();
  model.rigid = job.rigid;
  if (!job.rigid) model.transmission = job.elastic[which]->transmission;
  model.joints.resize(static_cast<std::size_t>(job.n_joints()));
  for (std::size_t k = 0; k < equations.size(); ++k) {
    const DynamicColumns& columns = equations[k].columns;
    JointModel& joint = model.joints[static_cast<std::size_t>(columns.place.joint)];
    (columns.side == Side::link ? joint.link : joint.motor) = effects_of(columns, solutions[k]);
  }
  model.joints.front().refinements = added_of(job, equations, solutions);
  return model;
}

}  // namespace cablefit
