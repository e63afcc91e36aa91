#include "cablefit/dynamic/dynamic_result.hpp"

namespace cablefit {

DynamicResult::DynamicResult() = default;
DynamicResult::DynamicResult(const DynamicResult&) = default;
DynamicResult::DynamicResult(DynamicResult&&) noexcept = default;
DynamicResult& DynamicResult::operator=(const DynamicResult&) = default;
DynamicResult& DynamicResult::operator=(DynamicResult&&) noexcept = default;
DynamicResult::~DynamicResult() = default;

}  // namespace cablefit
