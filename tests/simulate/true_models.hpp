// The truth simulator's rigs as models, and shipped logs as a simulation wants them.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "cablefit/simulate/replay.hpp"
#include "tests/simulate/benches.hpp"
#include "tests/truth/rig.hpp"

namespace cablefit::test {

/// The model with the true parameters, without a rig of its own.
inline Model true_model(const truth::Rig& rig, const std::string& preload) {
  Model model = spring_joint({rig.J_link, rig.f_v, rig.f_s},
                             {rig.J_motor, rig.f_vm, rig.f_sm, rig.offset}, 0);
  model.name = "poly";
  model.preload = preload;
  model.transmission = antagonist_pair(2);
  const truth::Cable* cables[] = {&rig.cable_1, &rig.cable_2};
  for (std::size_t k = 0; k < 2; ++k) {
    model.transmission.cables[k].coefficients = cables[k]->stiffness;
    model.transmission.cables[k].initial_elongation = cables[k]->initial_elongation;
  }
  return model;
}

inline Model true_model(const std::string& preload) {
  return true_model(preload == "low" ? truth::Rig::low() : truth::Rig::high(), preload);
}

/// A shipped log, "low/blocked.csv", for the simulation by `model`.
inline LogSurvey shipped_for(const Model& model, const std::string& name) {
  return survey_for_simulation(std::string(CABLEFIT_DATA) + '/' + name, "", model);
}

inline ReplayOptions in_mode(ReplayMode mode) {
  ReplayOptions options;
  options.mode = mode;
  return options;
}

/// The simulation of one shipped log, which has one part.
inline SimulatedPart simulate_shipped(const Model& model, const std::string& name,
                                      const ReplayOptions& options = {}) {
  const std::vector<LogSurvey> logs = {shipped_for(model, name)};
  return simulate_logs(model, logs, options).parts.at(0);
}

inline const SignalGap& gap_of(const SimulatedPart& part, const std::string& signal) {
  for (const SignalGap& gap : part.gaps) {
    if (gap.signal == signal) return gap;
  }
  throw std::runtime_error("no gap of " + signal);
}

}  // namespace cablefit::test
