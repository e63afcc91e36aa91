// Standard input as a file: it is read more than once, which a pipe cannot be.
#pragma once

#include <string_view>

namespace cablefit {

/// The path that stands for it.
inline constexpr std::string_view kStandardInput = "-";

/// A descriptor of its own, at the beginning. The first call copies all of it to a temporary file
/// without a name. Throws Error(input) with the system's reason.
int open_standard_input();

}  // namespace cablefit
