#include "cablefit/base/files/digest.hpp"

#include <catch2/catch.hpp>

#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit {

// Expected digests: the examples of FIPS 180-2 (appendix B).
TEST_CASE("SHA-256 of texts") {
  CHECK(sha256_of_text("abc") ==
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256_of_text("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_CASE("SHA-256 of a file of many blocks") {
  const test::TempFolder folder;
  const std::string path = folder.write("million.txt", std::string(1'000'000, 'a'));
  CHECK(sha256_of_file(path) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("a file that cannot be read has no digest") {
  CHECK(test::message_of([] { sha256_of_file("no/such.csv"); }) ==
        "cannot read no/such.csv: No such file or directory");
  const test::TempFolder folder;
  CHECK(test::message_of([&] { sha256_of_file(folder.path()); }) ==
        "cannot read " + folder.path().string() + ": Is a directory");
}

}  // namespace cablefit
