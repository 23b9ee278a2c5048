// Hashes of files and texts.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace rouleau {

/// SHA-256 of a file, lower-case hexadecimal. Throws Error(input_output).
std::string sha256(const std::filesystem::path& file);
/// SHA-256 of a text, in the same form.
std::string sha256_of(std::string_view text);

}  // namespace rouleau
