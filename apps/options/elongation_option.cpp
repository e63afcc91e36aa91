#include "options/elongation_option.hpp"

#include "options/command_line.hpp"

namespace cablefit::apps {

void add_elongation_option(CLI::App& app, ElongationMode& mode) {
  add_choice(
      app, "--l-o", "mode", {"auto", "search", "known"},
      [&mode](const std::string& name) {
        mode = name == "search"  ? ElongationMode::search
               : name == "known" ? ElongationMode::known
                                 : ElongationMode::automatic;
      },
      "initial elongations: search them, or take those of the rig file (else 0) "
      "[auto: search where the rig file says so; if it has no cables, search for "
      "several preloads, or when the stiffness falls on both sides of zero]");
}

}  // namespace cablefit::apps
