#include <fmt/format.h>

#include <array>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/base/quote.hpp"
#include "commands/command.hpp"

namespace cablefit::apps {
namespace {

constexpr std::array kCommands{
    Command{"study",
            "everything in one run, from logs to the missing effect; the others give more "
            "detail",
            run_study},
    Command{"check", "what is in a log, is it usable, and what can be identified from it",
            run_check},
    Command{"elastic", "stage 1, link blocked: linear and per-cable polynomial stiffness (Table 1)",
            run_elastic},
    Command{"dynamic", "stage 2, link moving: inertias, friction and offset with sd (Table 2)",
            run_dynamic},
    Command{"identify", "one step: elastic and dynamic parameters together, l_o searched (26)-(28)",
            run_identify},
    Command{"simulate",
            "run a model on the input of logs: positions, torques, gap to the measurement",
            run_simulate},
    Command{"predict",
            "predicted along logs: elastic torques, sensor torque and contacts, with 95 % bands",
            run_predict},
    Command{"refine",
            "where model and logs disagree, which effect is missing, whether adding it "
            "helps",
            run_refine},
    Command{"design", "effect of the preload, error of simpler models, which motion to record",
            run_design},
    Command{"compare",
            "whether two results differ by more than their uncertainty, and in which "
            "parameters",
            run_compare},
    Command{"batch", "all preloads of a campaign in parallel, with gates for CI", run_batch},
    Command{"init", "write a first campaign file and rig files from the logs in a folder",
            run_init},
    Command{"list", "effects, models, estimators and formats that cablefit knows", run_list},
};

}  // namespace

std::span<const Command> commands() { return kCommands; }

const Command& find_command(const std::string& name) {
  std::vector<std::string_view> known;
  for (const Command& command : kCommands) {
    if (command.name == name) return command;
    known.push_back(command.name);
  }
  throw usage_error("unknown command " + in_quotes(name), suggestion(name, known));
}

std::string overview() {
  std::string text =
      "cablefit: identification of cable-driven robot transmissions from logs\n\n"
      "Usage: cablefit COMMAND [ARGUMENTS]\n\nCommands:\n";
  for (const Command& command : kCommands) {
    text += fmt::format("  {:<10}{}\n", command.name, command.help);
  }
  return text +
         "\n'cablefit help COMMAND' shows its options and an example, 'cablefit --version' the "
         "version.\n"
         "Exit codes: 0 done, 1 a gate failed, 2 usage, 3 bad input, 4 not identifiable or not "
         "converged,\n5 could not write, 70 internal error.\n";
}

}  // namespace cablefit::apps
