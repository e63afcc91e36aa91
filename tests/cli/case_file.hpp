// Whole-program tests as text. A file in cases/ holds any number of
//
//   === name of the case
//   file log.csv            a file to make; its lines follow, indented by two blanks
//   prepare COMMAND         a shell command to run first
//   run COMMAND             what is tested, in a folder of its own
//   exit 3                  exit code
//   stdout | stderr         the exact text, indented by two blanks; missing: nothing is printed
//   says                    lines that stdout contains (then `stdout` is not looked at)
//   creates                 files that appear, one per line; missing: none does; a cell's file is
//                           cablefit-out/cells/KEY.json
//
// `bounded` in a command is cablefit on one thread within 400 MB of address space, {data} stands
// for the repository's data folder, in commands and in texts.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace cablefit::test {

struct Case {
  std::string name, place;
  std::vector<std::pair<std::string, std::string>> files;
  std::vector<std::string> prepare;
  std::string run;
  int exit_code = 0;
  std::string out, err;
  std::vector<std::string> says, creates;
};

/// Throws std::runtime_error at file:line for what it does not understand.
std::vector<Case> read_cases(const std::string& path);

/// What a command did.
struct Outcome {
  int exit_code = 0;
  std::string out, err;
  std::vector<std::string> created;  ///< files, sorted
};

/// Runs the case in a fresh folder; the program is called `cablefit` there.
Outcome run_case(const Case& wanted);

}  // namespace cablefit::test
