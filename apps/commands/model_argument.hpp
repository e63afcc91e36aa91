// MODEL, the first of the arguments of commands that apply one to logs.
#pragma once

#include <string>

#include "commands/common_options.hpp"

namespace cablefit::apps {

/// Taken off the front of options.logs: a .json file, else OUT/dynamic.json. Throws Error(usage)
/// when there is neither; `command` is named in the remedy.
std::string take_model_path(CommonOptions& options, const std::string& command);

/// A file of rows never takes the place of what it is made from, nor of another result of the same
/// run: throws Error(usage). `path` empty: none is written.
void require_own_place(const std::string& path, const std::string& model,
                       const CommonOptions& options, const std::string& result_file);

}  // namespace cablefit::apps
