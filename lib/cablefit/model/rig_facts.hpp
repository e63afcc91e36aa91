// What a result of stage 1 takes from its rig file, as plain text: a later stage that reads the
// result compares by content, not by path.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/rig.hpp"

namespace cablefit {

/// ("tau scale", "0.51"), ...: unit, scale and shift of q, theta and tau, the motion, the number of
/// joints, and the cables but for l_o, which stage 1 may search. Numbers in the shortest form that
/// reads back as the same bits.
struct RigFact {
  std::string name, value;
};
using RigFacts = std::vector<RigFact>;
RigFacts elastic_facts(const Rig& rig);

/// "with tau scale 0.51, the rig now says 0.255" of the first fact that differs; empty: none does.
/// Facts that only one of the two has are left out.
std::string changed_fact(const RigFacts& before, const RigFacts& now);

}  // namespace cablefit
