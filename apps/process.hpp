// What the program asks of the system before anything else: that no way in which a run can be ended
// or cut off leaves half a file, a wrong exit code or a soiled terminal.
#pragma once

#include <string_view>

namespace cablefit::apps {

/// Standard streams that are closed are opened on nothing, so that no result file takes their
/// place; a closed pipe and a file beyond the size allowed are errors of writing (exit code 5), not
/// signals; SIGINT, SIGTERM and SIGHUP remove temporary files, clear the progress line and end the
/// process as they would have (130, 143, 129 in the shell).
void prepare_process();

/// One or more lines for people. Nothing can be done, or said, where stderr cannot be written.
void complain(std::string_view message) noexcept;

}  // namespace cablefit::apps
