// One simulated campaign of a rig, fitted as a user would.
#pragma once

#include "cablefit/identify/elastic_stage.hpp"
#include "tests/support/recover.hpp"

namespace cablefit::test {

/// Stage 1 on a blocked log and stage 2 on two moving ones. Every log has a seed of its own: equal
/// seeds would give both moving logs the same noise.
inline std::vector<Estimate> both_stages(const truth::Rig& rig, std::uint64_t& seed) {
  truth::BlockedOptions blocked;
  blocked.seed = seed++;
  Bench stage1;
  stage1.add(truth::simulate_blocked(rig, blocked));
  const ElasticResult elastic = fit_elastic_stage(stage1.logs(), {}, ElongationMode::automatic);
  Bench stage2;
  for (const double load : {30.0, -40.0}) {
    truth::MovingOptions moving;
    moving.seed = seed++;
    moving.duration = 8;
    moving.load = load;
    stage2.add(truth::simulate_moving(rig, moving));
  }
  std::vector<Estimate> all =
      fit_dynamic(stage2.logs(), elastic, {}).preloads.at(0).fits.at(0).parameters;
  for (const Estimate& e : elastic.preloads.at(0).find("poly")->parameters)
    if (e.name.front() == 'K') all.push_back(e);
  return all;
}

}  // namespace cablefit::test
