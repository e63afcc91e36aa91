// The message of the Error that an action throws, for tests that assert the exact text.
#pragma once

#include <string>

#include "cablefit/base/error.hpp"

namespace cablefit::test {

template <typename Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// The same with every `folder` + "/" taken out, for files in a temporary folder.
template <typename Action>
std::string message_of(Action action, const std::string& folder) {
  std::string message = message_of(action);
  const std::string prefix = folder + '/';
  for (auto at = message.find(prefix); at != std::string::npos; at = message.find(prefix)) {
    message.erase(at, prefix.size());
  }
  return message;
}

}  // namespace cablefit::test
