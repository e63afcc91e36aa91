#include "tests/refine/hidden_logs.hpp"

#include <algorithm>

#include "cablefit/samples/survey/recorded.hpp"
#include "tests/simulate/benches.hpp"

namespace cablefit::test {
namespace {

Rig rig_of(const hidden::Bench& bench) {
  Rig rig = default_rig();
  rig.torque_hold = TorqueHold::zoh;
  rig.load.law = &find_load_law("column");
  rig.controller.emplace();
  rig.controller->kp = bench.kp;
  rig.controller->kd = bench.kd;
  rig.controller->limit = bench.limit;
  rig.sensors["q"].quantum = bench.quantum_q;
  rig.sensors["theta"].quantum = bench.quantum_theta;
  rig.sensors["tau"].noise = bench.noise_tau;
  return rig;
}

Model model_of(const hidden::Bench& bench, const hidden::Rig& rig, const std::string& preload) {
  Model model = spring_joint({rig.J_link, rig.f_v, rig.f_s},
                             {rig.J_motor, rig.f_vm, rig.f_sm, rig.offset}, 0);
  model.name = "poly";
  model.preload = preload;
  model.rig = rig_of(bench);
  model.transmission = antagonist_pair(2);
  const hidden::Cable* cables[] = {&rig.cable_1, &rig.cable_2};
  for (std::size_t k = 0; k < 2; ++k) {
    model.transmission.cables[k].coefficients = {cables[k]->c[0], cables[k]->c[1]};
    model.transmission.cables[k].initial_elongation = cables[k]->l_o;
  }
  return model;
}

LogSurvey log_of(const hidden::Run& run, const hidden::Recording& recording, const Rig& rig,
                 const std::string& preload) {
  const hidden::Signals& s = recording.logged;
  const auto n = static_cast<Eigen::Index>(s.q.size());
  RecordedPart part;
  part.preload = preload;
  part.phase = run.blocked ? Phase::blocked : Phase::moving;
  part.rows.resize(n, 6);
  part.rows.col(0) = Eigen::VectorXd::LinSpaced(n, 0, static_cast<double>(n - 1) / hidden::kRate);
  const std::vector<double>* columns[] = {&s.q, &s.theta, &s.tau, &s.theta_ref};
  for (Eigen::Index k = 0; k < 4; ++k)
    part.rows.col(1 + k) = Eigen::Map<const Eigen::VectorXd>(columns[k]->data(), n);
  part.rows.col(5).setConstant(run.blocked ? 0 : s.load);
  return survey_recorded(recorded_plan(run.name, rig,
                                       {Channel::q, Channel::theta, Channel::tau,
                                        Channel::theta_ref, Channel::tau_load}),
                         {part});
}

hidden::Wish wish_of(const std::string& effect) {
  const std::size_t at = effect.find('=');
  return {&hidden::row_of(effect.substr(0, at)), std::stod(effect.substr(at + 1))};
}

}  // namespace

HiddenLogs hidden_logs(const std::vector<std::string>& effects, unsigned long seed,
                       const std::string& design, double clutter) {
  hidden::CaseSpec spec;
  spec.design = design;
  spec.seed = seed;
  spec.clutter = clutter;
  for (const std::string& effect : effects) spec.effects.push_back(wish_of(effect));
  HiddenLogs out{{}, {}, hidden::make_case(spec)};
  const hidden::Case& truth = out.truth;
  std::vector<std::string> preloads;
  for (std::size_t k = 0; k < truth.runs.size(); ++k) {
    const hidden::Run& run = truth.runs[k];
    const std::string preload = run.preload.empty() ? "default" : run.preload;
    if (std::find(preloads.begin(), preloads.end(), preload) == preloads.end()) {
      preloads.push_back(preload);
      const hidden::Rig rig =
          run.l_o != 0 ? hidden::preloaded(truth.bench.rig, run.l_o) : truth.bench.rig;
      out.models.push_back(model_of(truth.bench, rig, preload));
    }
    LogSurvey log = log_of(run, truth.recordings[k], rig_of(truth.bench), preload);
    (run.blocked          ? out.logs.blocked
     : run.role == "test" ? out.logs.test
                          : out.logs.train)
        .push_back(std::move(log));
  }
  return out;
}

EffectInstance effect_at(std::string_view name, Site site, const std::vector<double>& values) {
  EffectInstance effect{&find_candidate(name, site), {}};
  for (std::size_t k = 0; k < values.size(); ++k) {
    Estimate& e = effect.parameters.emplace_back();
    e.name = effect.effect->parameters[k].name;
    e.value = values[k];
  }
  return effect;
}

std::vector<LogSurvey> all_training(const RefineLogs& logs) {
  std::vector<LogSurvey> all = logs.blocked;
  all.insert(all.end(), logs.train.begin(), logs.train.end());
  return all;
}

}  // namespace cablefit::test
