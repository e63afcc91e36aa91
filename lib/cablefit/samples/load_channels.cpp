#include "cablefit/samples/load_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "cablefit/samples/plan/rig_files.hpp"
#include "cablefit/samples/survey/phases.hpp"

namespace cablefit {
namespace {

bool share_preload(const LogSurvey& a, const LogSurvey& b) {
  return std::any_of(a.parts.begin(), a.parts.end(), [&](const PartSurvey& part) {
    return std::any_of(b.parts.begin(), b.parts.end(),
                       [&](const PartSurvey& other) { return other.preload == part.preload; });
  });
}

bool has_law(const LogSurvey& log) {
  const LoadLaw* law = log.plan.rig.load.law;
  return law != nullptr && !law->from_column;
}

/// Whether another log of its preload has a rig file that differs in the load alone.
bool is_under_another_load(const LogSurvey& log, const std::vector<LogSurvey>& logs) {
  return has_law(log) && std::any_of(logs.begin(), logs.end(), [&](const LogSurvey& other) {
           return share_preload(log, other) &&
                  compare_rig_files(log.plan.rig, other.plan.rig).difference == RigDifference::load;
         });
}

/// A position and the channel that its load goes to; both as places among the slots.
struct LoadSlot {
  std::size_t position, load;
};

/// Makes a slot for the load of every joint that has a position; of a rigid drive that is theta.
std::vector<LoadSlot> add_slots(LogPlan& plan) {
  std::vector<LoadSlot> added;
  for (int joint = 0; joint < plan.rig.n_joints(); ++joint) {
    const int q = plan.find(Channel::q, joint), theta = plan.find(Channel::theta, joint);
    if (q < 0 && theta < 0) continue;
    const auto position = static_cast<std::size_t>(q >= 0 ? q : theta);
    int load = plan.find(Channel::tau_load, joint);
    if (load < 0) {
      load = static_cast<int>(plan.slots.size());
      plan.slots.push_back({Channel::tau_load, joint, plan.slots[position].column, 1, 0});
    }
    added.push_back({position, static_cast<std::size_t>(load)});
  }
  return added;
}

/// The rows with the loads, in pieces as before.
std::shared_ptr<SampleStore> with_loads(const SampleStore& samples, const Load& load,
                                        const std::vector<LoadSlot>& added, std::size_t n_slots,
                                        std::vector<PartSurvey>& parts) {
  auto store = std::make_shared<SampleStore>();
  std::vector<std::vector<ChannelScan>> scans(parts.size(), std::vector<ChannelScan>(added.size()));
  Eigen::MatrixXd rows;
  for (const SamplePiece& piece : samples.pieces()) {
    samples.read(piece, rows);
    rows.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(1 + n_slots));
    for (std::size_t k = 0; k < added.size(); ++k) {
      auto to = rows.col(static_cast<Eigen::Index>(1 + added[k].load));
      to = rows.col(static_cast<Eigen::Index>(1 + added[k].position)).unaryExpr([&load](double q) {
        return load.law->torque(load.parameters, q);
      });
      scans[piece.part][k].add(to.array());
    }
    store->append(piece.part, piece.follows, rows);
  }
  for (std::size_t part = 0; part < parts.size(); ++part) {
    parts[part].channels.resize(n_slots);
    for (std::size_t k = 0; k < added.size(); ++k) {
      ChannelSurvey& channel = parts[part].channels[added[k].load];
      channel = scans[part][k].result();
      channel.quantum = channel.noise = 0;  // no sensor's
    }
  }
  return store;
}

void make_load_channel(LogSurvey& log) {
  LogPlan& plan = log.plan;
  const Load load = std::exchange(plan.rig.load, {&find_load_law("column"), {}});
  const std::vector<LoadSlot> added = add_slots(plan);
  log.samples = with_loads(*log.samples, load, added, plan.slots.size(), log.parts);
  plan.decisions.push_back({"tau_load", fmt::format("by the load law '{}'", load.law->name),
                            "the rig files of the logs differ in their load alone"});
}

/// What is lost where the law of a moving log becomes a channel.
void warn_of_law(LogSurvey& log) {
  if (!has_phase(log, Phase::moving)) return;
  const Load& load = log.plan.rig.load;
  const double inertia = load.law->inertia(load.parameters);
  if (inertia > 0)
    log.warnings.push_back(fmt::format(
        "{}: J_link includes the inertia of its load ({:.3g} {}), because the rig files of the "
        "logs differ in their load; fit one load at a time for the J_link of the link alone",
        log.plan.path, inertia, unit_for(log.plan.rig.axes.all(), "kg m^2")));
  if (load.law->free_fall != nullptr)
    log.warnings.push_back(fmt::format(
        "{}: not checked whether the rope of its load goes slack, because the rig files of the "
        "logs differ in their load; fit this load alone to check it",
        log.plan.path));
}

}  // namespace

void make_load_channels(std::vector<LogSurvey>& logs) {
  std::vector<LogSurvey*> chosen;  // all before the first one changes
  for (LogSurvey& log : logs)
    if (is_under_another_load(log, logs)) chosen.push_back(&log);
  for (LogSurvey* log : chosen) {
    warn_of_law(*log);
    make_load_channel(*log);
  }
}

}  // namespace cablefit
