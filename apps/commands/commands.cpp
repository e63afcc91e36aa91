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
            "all in one go, from logs to what the model lacks; the other commands go deeper",
            run_study},
    Command{"check", "what is in a log, is it usable, and what can be identified from it",
            run_check},
    Command{"elastic", "stage 1, link blocked: linear and per-cable polynomial stiffness (Table 1)",
            run_elastic},
    Command{"dynamic", "stage 2, link moving: inertias, friction and offset with sd (Table 2)",
            run_dynamic},
    Command{"identify", "one step: elastic and dynamic parameters together, l_o searched (26)-(28)",
            run_identify},
    Command{"simulate", "a model on the input of logs: positions, torques, gap to the measured",
            run_simulate},
    Command{"predict",
            "what a model says of logs: elastic torques, a sensor's torque, contacts, with bands",
            run_predict},
    Command{"refine",
            "where model and logs disagree, which effect is missing, and does adding it help",
            run_refine},
    Command{"design", "what a preload buys, what simpler models cost, which motion to record",
            run_design},
    Command{"compare", "whether two results differ by more than their uncertainty, and in what",
            run_compare},
    Command{"batch", "all preloads of a campaign side by side, with gates for CI", run_batch},
    Command{"init", "a campaign file and rig files to begin with, from the logs in a folder",
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
  throw usage_error("unknown command " + cablefit::quoted(name), suggestion(name, known));
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
