// Results appear whole or not at all: written beside the target under a temporary name, flushed to
// disk, then renamed.
#pragma once

#include <string>
#include <string_view>
#include <system_error>

#include "cablefit/base/error.hpp"

namespace cablefit {

/// Creates missing parent folders. "-" writes to standard output. Throws Error(output) naming the
/// path and the system's reason; nothing is left behind then.
void write_whole(const std::string& path, std::string_view content);

/// "cannot write PATH: the system's reason".
Error output_error(const std::string& path, const std::system_error& failure);

/// Removes what is written at this moment and not finished. For signal handlers; the process must
/// end afterwards.
void remove_temporaries() noexcept;

}  // namespace cablefit
