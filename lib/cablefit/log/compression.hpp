// The compressions behind the table in byte_source.cpp; each has a file of its own.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "cablefit/base/error.hpp"
#include "cablefit/log/byte_source.hpp"

namespace cablefit {

/// Packed bytes are read in blocks of this size.
inline constexpr std::size_t kPackedBlockBytes = 1u << 16;

bool is_gzip(std::string_view head);
/// Concatenated members are one text, as gzip itself has it.
std::unique_ptr<ByteSource> unpack_gzip(std::unique_ptr<ByteSource> packed, std::string path);

bool is_zstd(std::string_view head);
/// Any number of frames; a frame may not require a window of more than 128 MiB.
std::unique_ptr<ByteSource> unpack_zstd(std::unique_ptr<ByteSource> packed, std::string path);

/// "log.csv.gz: gzip data ends early after 123 good bytes; ..": bytes count unpacked.
Error truncated_error(const std::string& path, std::string_view compression, std::size_t n_good);
Error corrupt_error(const std::string& path, std::string_view compression, std::size_t n_good,
                    std::string_view reason);

}  // namespace cablefit
