// The table of commands. A new one is one file with a function and one row in commands.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "options/arguments.hpp"

namespace cablefit::apps {

/// Exit code of a command that did its work, and whose result does not pass a gate asked for.
inline constexpr int kGateFailed = 1;

struct Command {
  std::string_view name;
  std::string_view help;                   ///< one line
  int (*run)(const Arguments& arguments);  ///< returns the exit code
};

std::span<const Command> commands();
/// Throws Error(usage) with a near match.
const Command& find_command(const std::string& name);
/// What `cablefit --help` prints.
std::string overview();

/// The rows of the table.
int run_check(const Arguments& arguments);
int run_study(const Arguments& arguments);
int run_elastic(const Arguments& arguments);
int run_dynamic(const Arguments& arguments);
int run_identify(const Arguments& arguments);
int run_simulate(const Arguments& arguments);
int run_predict(const Arguments& arguments);
int run_refine(const Arguments& arguments);
int run_design(const Arguments& arguments);
int run_compare(const Arguments& arguments);
int run_batch(const Arguments& arguments);
int run_init(const Arguments& arguments);
int run_list(const Arguments& arguments);

}  // namespace cablefit::apps
