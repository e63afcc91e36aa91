#include "cablefit/base/files/streamed_file.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit {
namespace {

namespace fs = std::filesystem;
using test::content_of;
using test::message_of;

TEST_CASE("a streamed file appears when it is finished, with its folders") {
  const test::TempFolder folder;
  const std::string path = folder.file("a/rows.csv");
  StreamedFile file(path);
  std::string expected;
  for (int row = 0; row < 20000; ++row) {
    const std::string line = std::to_string(row) + "\n";
    file.append(line);
    expected += line;
  }
  CHECK_FALSE(fs::exists(path));
  file.finish();
  CHECK(content_of(path) == expected);
}

TEST_CASE("a streamed file that is given up leaves nothing, and the old one stands") {
  const test::TempFolder folder;
  const std::string path = folder.write("rows.csv", "old");
  {
    StreamedFile file(path);
    file.append("new");
  }
  CHECK(content_of(path) == "old");
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}

TEST_CASE("a streamed file that cannot be written says so") {
  const test::TempFolder folder;
  folder.write("file", "");
  const std::string below_a_file = folder.file("file/rows.csv");
  CHECK(message_of([&] { StreamedFile file(below_a_file); }) ==
        "cannot write " + below_a_file + ": Not a directory");
  CHECK(message_of([] {
          StreamedFile file("/dev/full");
          file.append("x");
          file.finish();
        }) == "cannot write /dev/full: No space left on device");
}

}  // namespace
}  // namespace cablefit
