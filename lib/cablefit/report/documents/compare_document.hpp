// A comparison for people: what changed, in words, and the numbers behind it.
#pragma once

#include "cablefit/campaign/compare/compare.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

Document compare_document(const CompareResult& result);

/// "f_v (viscous friction of the link): up 12 %, 5.602 -> 6.273 N m s/rad, 25 sd".
std::string change_text(const ComparedParameter& parameter);

}  // namespace cablefit
