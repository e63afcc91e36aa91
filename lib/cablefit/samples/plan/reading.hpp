// How a log is read, beyond what its rig file says.
#pragma once

#include "cablefit/log/mended_log.hpp"

namespace cablefit {

struct Reading {
  bool trust_units = false;  ///< continues where units or signs cannot be right, with a warning
  std::size_t skipped_lines = 0;
  bool units_row = false;
  MendingRules mending;
  double rate = 0;  ///< Hz, in place of a time column; 0: none given

  LogText text() const { return {skipped_lines, units_row, mending.missing != Missing::refuse}; }
};

}  // namespace cablefit
