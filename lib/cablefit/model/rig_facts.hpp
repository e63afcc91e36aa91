// The data of the rig file that a result of stage 1 depends on, as plain text. A later stage that
// reads the result compares them by content, not by path.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/rig.hpp"

namespace cablefit {

/// ("tau scale", "0.51"), ...: unit, scale and shift of q, theta and tau, the motion, the number of
/// joints, and the cables without l_o, which stage 1 may search. Numbers have the shortest form
/// that reads back to the same bits.
struct RigFact {
  std::string name, value;
};
using RigFacts = std::vector<RigFact>;
RigFacts elastic_facts(const Rig& rig);

/// "with tau scale 0.51, the rig now says 0.255" for the first fact that differs; empty: none does.
/// Facts in only one of the two lists are ignored.
std::string changed_fact(const RigFacts& before, const RigFacts& now);

}  // namespace cablefit
