// The distinct texts of one text column. Logs repeat the same word over many rows, so the previous
// one is tried first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "cablefit/log/log_reader.hpp"

namespace cablefit {

class Words {
 public:
  /// A text column with more distinct texts than this is no label; memory stays bounded.
  static constexpr std::size_t kMaxWords = 100'000;
  static constexpr std::size_t kMaxBytes = std::size_t{16} << 20;  ///< the same of all their bytes

  /// Index of `word` in list(), where it is added when it is new.
  std::uint32_t index_of(std::string_view word) {
    if (previous_ < list_.size() && list_[previous_] == word) return previous_;
    return previous_ = find_or_add(word);
  }
  bool is_full() const { return list_.size() >= kMaxWords || n_bytes_ > kMaxBytes; }
  const std::vector<std::string>& list() const { return list_; }

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view word) const {
      return std::hash<std::string_view>{}(word);
    }
  };

  std::uint32_t find_or_add(std::string_view word);

  std::uint32_t previous_ = 0;
  std::size_t n_bytes_ = 0;
  std::vector<std::string> list_;
  std::unordered_map<std::string, std::uint32_t, Hash, std::equal_to<>> indices_;
};

/// Error for a column whose Words are full.
Error too_many_words(const ColumnHeader& column);

}  // namespace cablefit
