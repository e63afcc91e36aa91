// The program: picks a command, and is the one place that catches.
#include <fmt/format.h>

#include <exception>
#include <new>

#include "cablefit/base/error.hpp"
#include "cablefit/base/files/output_file.hpp"
#include "cablefit/version.hpp"
#include "commands/command.hpp"
#include "origin.hpp"
#include "process.hpp"

namespace {

using cablefit::Error;
using cablefit::write_whole;
namespace apps = cablefit::apps;

constexpr int kInternalError = 70;  // EX_SOFTWARE of sysexits.h: a mistake of ours, not the user's

int run(apps::Arguments arguments) {
  apps::remember_command(arguments);
  if (arguments.empty()) throw cablefit::usage_error("no command given", "see 'cablefit --help'");
  const std::string name = arguments.front();
  arguments.erase(arguments.begin());
  const bool wants_help = name == "help" || name == "--help" || name == "-h";
  const bool names_command =
      !arguments.empty() && arguments.front() != "--help" && arguments.front() != "-h";
  if (name == "help" && names_command)  // 'help X' is 'X --help'
    return apps::find_command(arguments.front()).run({"--help"});
  if (wants_help) {
    write_whole("-", apps::overview());
    return 0;
  }
  if (name == "--version" || name == "-V") {
    write_whole("-", fmt::format("cablefit {}\n{}\n", cablefit::kVersion, cablefit::kBuildFacts));
    return 0;
  }
  return apps::find_command(name).run(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  apps::prepare_process();
  try {
    return run(apps::Arguments(argv + 1, argv + argc));
  } catch (const Error& error) {
    apps::complain(fmt::format("{}\n", error.what()));
    return static_cast<int>(error.kind());
  } catch (const std::bad_alloc&) {
    apps::complain("out of memory; close other programs, or raise the limit (ulimit -v)\n");
    return kInternalError;
  } catch (const std::exception& error) {
    apps::complain(fmt::format("internal error: {}; please report it with the command you ran\n",
                               error.what()));
    return kInternalError;
  }
}
