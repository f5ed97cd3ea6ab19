/// Whole files in and out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "relievo/result.hpp"

namespace relievo {

/// What a message calls a file: its name without the folders, which Error::file has.
std::string short_name(const std::filesystem::path& path);

/// An I/O error whose sentence begins with the file's name: "'a.png' is empty".
tl::unexpected<Error> file_error(const std::filesystem::path& path, std::string id, const std::string& rest);

/// Reads a whole file, of 8 GiB at most. Errors: "<kind>.missing", "<kind>.unreadable" (a folder included),
/// "<kind>.empty",
/// "<kind>.size", "<kind>.memory".
Result<std::vector<std::uint8_t>> read_file(const std::filesystem::path& path, const std::string& kind);

/// Whether it exists and is no regular file, or is a name of the system's: a pipe, /dev/stdout.
bool is_written_in_place(const std::filesystem::path& path);

/// Writes a file under a temporary name beside it and renames it when it is complete, so that nobody ever sees half of
/// it; through a symbolic link, which stays. A pipe or device is written in place. Errors: "<kind>.write".
Status write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes, const std::string& kind);

}  // namespace relievo
