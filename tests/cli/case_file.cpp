#include "tests/cli/case_file.hpp"

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>

#include "tests/support/temp_folder.hpp"

namespace cablefit::test {
namespace {

namespace fs = std::filesystem;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string with_data(const std::string& text) { return replaced(text, "{data}", CABLEFIT_DATA); }
std::string without_data(const std::string& text) {
  return replaced(text, CABLEFIT_DATA, "{data}");
}

/// A line-wise reader of one case file.
class CaseReader {
 public:
  explicit CaseReader(const std::string& path) : path_(path) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) lines_.push_back(line);
    if (lines_.empty()) throw std::runtime_error("no cases in " + path);
  }

  std::vector<Case> read() {
    std::vector<Case> cases;
    while (at_ < lines_.size()) {
      const std::string line = lines_[at_++];
      if (line.empty() || line.front() == '#') continue;
      if (line.rfind("=== ", 0) == 0) {
        cases.push_back({});
        cases.back().name = line.substr(4);
        cases.back().place = path_ + ":" + std::to_string(at_);
      } else {
        if (cases.empty()) fail(line);
        take(line, cases.back());
      }
    }
    return cases;
  }

 private:
  void take(const std::string& line, Case& to) {
    const auto blank = line.find(' ');
    const std::string word = line.substr(0, blank);
    const std::string rest = blank == std::string::npos ? "" : line.substr(blank + 1);
    if (word == "file") {
      to.files.emplace_back(rest, joined(indented()));
    } else if (word == "prepare") {
      to.prepare.push_back(with_data(rest));
    } else if (word == "run") {
      to.run = with_data(rest);
    } else if (word == "exit") {
      to.exit_code = std::stoi(rest);
    } else if (word == "stdout") {
      to.out = joined(indented());
    } else if (word == "stderr") {
      to.err = joined(indented());
    } else if (word == "says") {
      to.says = indented();
    } else if (word == "creates") {
      to.creates = indented();
    } else {
      fail(line);
    }
  }

  /// Empty lines within a text need no blanks in front.
  std::vector<std::string> indented() {
    std::vector<std::string> lines;
    std::size_t n_empty = 0;
    for (; at_ < lines_.size(); ++at_) {
      const std::string& line = lines_[at_];
      if (line.empty()) {
        ++n_empty;
        continue;
      }
      if (line.rfind("  ", 0) != 0) break;
      lines.insert(lines.end(), std::exchange(n_empty, 0), "");
      lines.push_back(line.substr(2));
    }
    return lines;
  }

  static std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
  }

  [[noreturn]] void fail(const std::string& line) const {
    throw std::runtime_error(path_ + ":" + std::to_string(at_) + ": cannot make sense of " + line);
  }

  std::string path_;
  std::vector<std::string> lines_;
  std::size_t at_ = 0;
};

std::set<std::string> files_below(const fs::path& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_directory()) files.insert(fs::relative(entry.path(), folder).string());
  }
  return files;
}

// AddressSanitizer takes terabytes of address space for itself.
#ifdef __SANITIZE_ADDRESS__
constexpr const char* kLimit = ":";
#else
constexpr const char* kLimit = "ulimit -v 400000";
#endif

int run_shell(const fs::path& folder, const std::string& command, const std::string& redirection) {
  const std::string script = folder.string() + ".sh";
  std::ofstream(script) << "cablefit() { '" << CABLEFIT_PROGRAM << "' \"$@\"; }\nbounded() { ("
                        << kLimit << "; cablefit \"$@\" --threads 1); }\ncd '" << folder.string()
                        << "' || exit 99\n"
                        << command << "\n";
  const int status = std::system(("sh '" + script + "'" + redirection).c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

std::vector<Case> read_cases(const std::string& path) { return CaseReader(path).read(); }

/// Files of cells are named by 64 digits that depend on the version.
static std::string without_key(const std::string& file) {
  const std::size_t end = file.rfind(".json"), start = end == std::string::npos ? 0 : end - 64;
  if (!file.starts_with("cablefit-out/cells/") || start != 19) return file;
  return "cablefit-out/cells/KEY.json";
}

Outcome run_case(const Case& wanted) {
  const TempFolder outer;
  const fs::path folder = outer.path() / "work";  // what is captured lies beside it
  fs::create_directory(folder);
  for (const auto& [name, content] : wanted.files) {
    std::ofstream(folder / name, std::ios::binary) << content;
  }
  for (const std::string& command : wanted.prepare) {
    if (run_shell(folder, command, "") != 0) throw std::runtime_error("cannot " + command);
  }
  const std::set<std::string> before = files_below(folder);
  Outcome outcome;
  outcome.exit_code = run_shell(folder, wanted.run,
                                " > '" + outer.file("out") + "' 2> '" + outer.file("err") + "'");
  outcome.out = without_data(content_of(outer.file("out")));
  outcome.err = without_data(content_of(outer.file("err")));
  for (const std::string& file : files_below(folder)) {
    if (before.count(file) == 0) outcome.created.push_back(without_key(file));
  }
  return outcome;
}

}  // namespace cablefit::test
