// The program, run while a system call fails or a signal comes. See failing_calls.cpp for the
// environment.
#pragma once

#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

namespace cablefit::test {

using Arguments = std::vector<std::string>;
using Environment = std::map<std::string, std::string>;

struct Ended {
  int exit_code = -1;  ///< -1: by a signal
  int signal = 0;
  std::string err;
};

/// What a run is killed by, and when.
struct Blow {
  int signal = 0;
  long after_us = 0;
};

/// Run in `folder`; what it says on stderr goes to the file "err" there.
Ended run_program(const std::string& folder, const Arguments& arguments,
                  const Environment& environment = {}, Blow blow = {});

}  // namespace cablefit::test
