// cablefit init: a campaign file and rig files to begin with.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cablefit/base/error.hpp"
#include "cablefit/base/files/output_file.hpp"
#include "cablefit/base/problems.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/campaign/campaign.hpp"
#include "cablefit/campaign/plan/templates.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "options/common_options.hpp"
#include "output/progress.hpp"
#include "process.hpp"

namespace cablefit::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInitExample =
    "Example:\n  cablefit init data --dry-run\nWrites FOLDER/campaign.json, and a "
    "rig.json into every folder of logs that has none. An\nexisting rig.json is "
    "never changed, an existing campaign.json only with --force.\n";

struct InitCommand {
  std::string folder = ".";
  bool force = false, dry_run = false, quiet = false;
};

std::string below(const InitCommand& command, const std::string& name) {
  return (fs::path(command.folder) / name).lexically_normal().string();
}

void refuse_to_overwrite(const InitCommand& command, const std::string& campaign) {
  std::error_code ignored;
  if (!fs::is_directory(command.folder, ignored))
    throw input_error({command.folder, 0, 0}, "no such folder", "name a folder with logs");
  if (fs::exists(campaign, ignored) && !command.force && !command.dry_run)
    throw usage_error(fmt::format("{} already exists", in_quotes(campaign)),
                      "move it, or replace it with --force");
}

std::string campaign_name(const InitCommand& command) {
  fs::path folder = fs::absolute(command.folder).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  return folder.filename().string();
}

/// What is wrong, from the file's name on.
std::string_view reason_of(const UnreadLog& log) {
  const std::string_view problem = log.problem;
  const std::size_t at = problem.find(log.path);
  return at == std::string_view::npos ? problem : problem.substr(at + log.path.size());
}

/// Each reason once, with the first log that it is of.
std::string unread_text(const std::vector<UnreadLog>& logs) {
  std::string text;
  std::vector<std::string_view> seen;
  for (const UnreadLog& log : logs) {
    const std::string_view reason = reason_of(log);
    if (std::find(seen.begin(), seen.end(), reason) != seen.end()) continue;
    seen.push_back(reason);
    text += fmt::format("not read: {}\n", printable(log.problem));
    const auto n = std::count_if(logs.begin(), logs.end(), [&](const UnreadLog& other) {
      return reason_of(other) == reason;
    });
    if (n > 1) text += fmt::format("not read for the same reason: {} more\n", n - 1);
  }
  return text;
}

std::string found_text(const FoundLogs& found) {
  std::string text;
  for (const FoundCell& cell : found.cells)
    text += fmt::format("{}{}: {} blocked, {} moving{}\n", printable(cell.preload),
                        cell.date.empty() ? "" : ", " + cell.date + " by the folder's name",
                        cell.blocked.size(), cell.moving.size(),
                        is_complete(cell) ? "" : "; left out: stage 1 needs a blocked log");
  return text + unread_text(found.unread);
}

void say(const InitCommand& command, const std::string& text) {
  if (!command.quiet) write_whole("-", text);
}

/// What was found, and the rig files that were missing.
void write_rigs(const InitCommand& command, const FoundLogs& found) {
  say(command, found_text(found));
  Problems problems;
  for (const FolderWithoutRig& folder : found.without_rig)
    problems.collect([&] {
      const std::string path = below(command, folder.path + "/rig.json");
      write_whole(path, rig_template(folder));
      say(command, "wrote " + printable(path) + "\n");
    });
  problems.throw_if_any();
}

/// Cells whose rig file was made just now name it too.
void add_new_rigs(const FoundLogs& found, std::vector<FoundCell>& cells) {
  for (FoundCell& cell : cells) {
    if (!cell.rig.empty()) continue;
    const std::string& log = cell.blocked.empty() ? cell.moving.front() : cell.blocked.front();
    const std::string folder = fs::path(log).parent_path().generic_string();
    for (const FolderWithoutRig& made : found.without_rig)
      if (made.path == (folder.empty() ? "." : folder))
        cell.rig = folder.empty() ? "rig.json" : folder + "/rig.json";
  }
}

}  // namespace

int run_init(const Arguments& arguments) {
  CLI::App app("Write a first campaign file and rig files from the logs in a folder.", "init");
  InitCommand command;
  app.add_option("FOLDER", command.folder, "folder of the logs; its subfolders are read too [.]")
      ->type_name("");
  app.add_flag("--force", command.force, "replace an existing campaign.json");
  app.add_flag("--dry-run", command.dry_run, "print the campaign file, write nothing");
  app.add_flag("--quiet", command.quiet, "print problems only");
  app.footer(kInitExample);
  if (!parse(app, arguments)) return 0;

  const std::string campaign = below(command, "campaign.json");
  refuse_to_overwrite(command, campaign);
  FoundLogs found = [&] {
    const Progress progress(command.quiet, "reading logs");
    return find_logs(command.folder, default_threads());
  }();
  if (found.cells.empty() && found.unread.empty())
    throw input_error({command.folder, 0, 0},
                      "no logs in this folder or its subfolders (three levels)",
                      "a log is .csv, .tsv, .txt or .json, also .gz or .zst");
  if (!command.dry_run) write_rigs(command, found);
  add_new_rigs(found, found.cells);
  if (std::none_of(found.cells.begin(), found.cells.end(), is_complete))
    throw input_error(
        {command.folder, 0, 0}, "no campaign file written: no log has the link blocked",
        found.unread.empty() ? "record one: the link held, the motor swept slowly up and down"
                             : "map the columns in the rig files, then run this again");
  const std::string text = campaign_template(campaign_name(command), found);
  write_whole(command.dry_run ? "-" : campaign, text);
  if (command.dry_run) return 0;
  (void)read_campaign(campaign);  // what is written here is read there
  say(command,
      fmt::format("wrote {}\nnext: cablefit batch {}\n", printable(campaign), printable(campaign)));
  return 0;
}

}  // namespace cablefit::apps
