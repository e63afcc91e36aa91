// A folder with logs and everything a command needs, and the program run in it while a system call
// fails or a signal comes. See failing_calls.cpp for the environment.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/fault/program.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit::test {

/// A command that writes files: what it is called with, and what it writes.
struct Writer {
  std::string name;
  Arguments arguments;
  std::vector<std::string> targets;
};

class FaultBench {
 public:
  FaultBench();

  Ended run(const Arguments& arguments, const Environment& environment, Blow blow = {}) const;
  /// How many calls that write, that read and that open log.csv a run makes.
  struct Calls {
    int writes = 0, reads = 0, opens = 0;
  };
  Calls count(const Arguments& arguments, const Environment& environment = {}) const;

  /// Contents of the files below out/, by path.
  std::map<std::string, std::string> files() const;
  /// Leaves out/ with an old file in the place of every target, or without any.
  void reset(const Writer& writer, bool with_old) const;
  std::string path(const std::string& name) const { return folder_.file(name); }
  /// log.csv as it was.
  void restore_log() const;

 private:
  TempFolder folder_;
};

/// The first lines of a text, all of them when there are fewer.
std::string first_lines(const std::string& text, int n_lines);
/// Contents of the files below a folder, by path below it; none when there is no such folder.
std::map<std::string, std::string> files_below(const std::filesystem::path& folder);

/// The commands that write, each with all the ways it has.
std::vector<Writer> writers();

inline constexpr const char* kOldContent = "old\n";

/// Asserts that every target is whole: as before the run, or as a run without a fault writes it;
/// and that there is nothing else.
void check_whole(const FaultBench& bench, const Writer& writer, bool with_old,
                 const std::map<std::string, std::string>& whole);

}  // namespace cablefit::test
