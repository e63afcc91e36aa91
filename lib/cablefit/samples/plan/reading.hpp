// Options for reading a log, besides its rig file.
#pragma once

#include "cablefit/log/mended_log.hpp"

namespace cablefit {

struct Reading {
  bool trust_units = false;  ///< accepts units or signs that cannot be right, with a warning
  std::size_t skipped_lines = 0;
  bool units_row = false;
  MendingRules mending;
  double rate = 0;  ///< Hz, instead of a time column; 0: not given

  LogText text() const { return {skipped_lines, units_row, mending.missing != Missing::refuse}; }
};

}  // namespace cablefit
