// Writes a case as a user of the tool would find it, and the truth beside it.
#pragma once

#include <filesystem>

#include "design.hpp"

namespace hidden {

/// Into `folder` (made if need be): NAME.csv and rig.json per run, in a folder of its own for each
/// preload setting, and truth.json. Throws std::runtime_error when a file cannot be written.
void write_case(const std::filesystem::path& folder, const Case& one);

/// Columns t,q,theta,tau,tau_load and, if wanted, theta_ref; a blocked log has no tau_load.
void write_log(const std::filesystem::path& file, const Signals& log, bool with_reference);

/// `text` into a file; throws std::runtime_error.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace hidden
