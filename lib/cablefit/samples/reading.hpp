// How a log is read, beyond what its rig file says.
#pragma once

namespace cablefit {

struct Reading {
  bool trust_units = false;  ///< goes on where units or signs cannot be right, with a warning
};

}  // namespace cablefit
