// Bytes as text and back: the vectors of RFC 4648, section 10.
#include "cablefit/base/base64.hpp"

#include <catch2/catch.hpp>
#include <utility>
#include <vector>

namespace cablefit {
namespace {

TEST_CASE("the test vectors of RFC 4648, both ways") {
  const std::vector<std::pair<std::string, std::string>> vectors = {{"", ""},
                                                                    {"f", "Zg=="},
                                                                    {"fo", "Zm8="},
                                                                    {"foo", "Zm9v"},
                                                                    {"foob", "Zm9vYg=="},
                                                                    {"fooba", "Zm9vYmE="},
                                                                    {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) {
    CHECK(base64(bytes) == text);
    CHECK(from_base64(text) == bytes);
  }
}

TEST_CASE("every byte comes back") {
  std::string bytes;
  for (int k = 0; k < 256; ++k) bytes += static_cast<char>(k);
  CHECK(from_base64(base64(bytes)) == bytes);
}

TEST_CASE("what is no base64 is refused") {
  for (const char* text : {"Zg", "Zg=", "Z===", "====", "Zg==Zg==", "Zm9!", "Zm 9v"})
    CHECK(!from_base64(text));
}

}  // namespace
}  // namespace cablefit
