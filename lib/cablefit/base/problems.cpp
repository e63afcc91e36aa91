#include "cablefit/base/problems.hpp"

#include <algorithm>
#include <array>

namespace cablefit {
namespace {

// Where several hold: could not write, bad input, not identifiable, then usage
// (docs/reference/exit-codes.md).
constexpr std::array kGravestFirst{ErrorKind::output, ErrorKind::input, ErrorKind::not_identifiable,
                                   ErrorKind::usage};

ErrorKind graver(ErrorKind a, ErrorKind b) {
  return *std::find_if(kGravestFirst.begin(), kGravestFirst.end(),
                       [=](ErrorKind kind) { return kind == a || kind == b; });
}

}  // namespace

void Problems::add(const Error& error) {
  if (kind_) messages_ += '\n';
  messages_ += error.what();
  kind_ = kind_ ? graver(*kind_, error.kind()) : error.kind();
}

void Problems::throw_if_any() const {
  if (kind_) throw Error(*kind_, messages_);
}

}  // namespace cablefit
