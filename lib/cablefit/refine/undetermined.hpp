// Fits that logs need not determine. Internal to refine/.
#pragma once

#include <optional>

#include "cablefit/base/error.hpp"

namespace cablefit {

/// What `fit` returns, an optional; nothing where it throws Error(not_identifiable).
template <typename Fit>
auto unless_undetermined(Fit fit) -> decltype(fit()) {
  try {
    return fit();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_identifiable) throw;
    return std::nullopt;
  }
}

}  // namespace cablefit
