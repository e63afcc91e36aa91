#include "cablefit/base/files/output_file.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit {
namespace {

namespace fs = std::filesystem;
using test::content_of;
using test::message_of;

std::size_t n_entries(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("a file is written with its folders, and replaced whole") {
  const test::TempFolder folder;
  const std::string path = folder.file("a/b/result.json");
  write_whole(path, "first");
  CHECK(content_of(path) == "first");
  write_whole(path, "second");
  CHECK(content_of(path) == "second");
  CHECK(n_entries(folder.path() / "a/b") == 1);
}

TEST_CASE("a symbolic link stays one") {
  const test::TempFolder folder;
  folder.write("target.json", "old");
  fs::create_symlink("target.json", folder.file("link.json"));
  write_whole(folder.file("link.json"), "new");
  CHECK(fs::is_symlink(folder.file("link.json")));
  CHECK(content_of(folder.file("target.json")) == "new");
}

TEST_CASE("a device is written to, not replaced") {
  write_whole("/dev/null", "gone");
  CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("failing to write names the path and the reason, and leaves nothing") {
  const test::TempFolder folder;
  folder.write("file", "");
  const std::string below_a_file = folder.file("file/result.json");
  CHECK(message_of([&] { write_whole(below_a_file, "x"); }) ==
        "cannot write " + below_a_file + ": Not a directory");
  CHECK(message_of([&] { write_whole(folder.path(), "x"); }) ==
        "cannot write " + folder.path().string() + ": Is a directory");
  CHECK(message_of([] { write_whole("/dev/full", "x"); }) ==
        "cannot write /dev/full: No space left on device");
  CHECK(n_entries(folder.path()) == 1);
  try {
    write_whole(below_a_file, "x");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::output);
  }
}

TEST_CASE("files of one run appear together or not at all") {
  const test::TempFolder folder;
  folder.write("file", "no folder");
  folder.write("old.json", "old");
  {
    WholeFiles files;
    files.add(folder.file("old.json"), "new");
    files.add(folder.file("page.html"), "page");
    CHECK(message_of([&] { files.add(folder.file("file/report.md"), "report"); }) ==
          "cannot write " + folder.file("file/report.md") + ": Not a directory");
  }
  CHECK(content_of(folder.file("old.json")) == "old");
  CHECK(n_entries(folder.path()) == 2);
  WholeFiles files;
  files.add(folder.file("old.json"), "new");
  files.add(folder.file("page.html"), "page");
  files.add("/dev/null", "gone");
  CHECK(content_of(folder.file("old.json")) == "old");
  files.finish();
  CHECK(content_of(folder.file("old.json")) == "new");
  CHECK(content_of(folder.file("page.html")) == "page");
  CHECK(fs::is_character_file("/dev/null"));
}

}  // namespace cablefit
