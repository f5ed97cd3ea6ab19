#include "permute_stamp.hpp"

#include <fmt/format.h>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common.hpp"

namespace relievo::cli {

namespace {

constexpr std::string_view last_line = "whole";

/// Empty where there is no archive.
std::string describe(const std::string& archive) {
  std::error_code error;
  const auto size = std::filesystem::file_size(archive, error);
  if (error) return {};
  const auto time = std::filesystem::last_write_time(archive, error).time_since_epoch().count();
  return error ? std::string() : fmt::format("{} {}", size, time);
}

/// The rest of the next line, which starts with `word`.
bool read_line(std::istream& stream, std::string_view word, std::string& rest) {
  if (!std::getline(stream, rest) || !rest.starts_with(word)) return false;
  rest.erase(0, word.size());
  return true;
}

}  // namespace

Fingerprint fingerprint(std::string_view manifest, const Registry& registry, std::string_view shard,
                        std::string_view costs) {
  std::vector<std::string_view> parts = {compiler_version(), manifest};
  for (const auto& [path, text] : registry.sources) {
    parts.push_back(path);
    parts.push_back(text);
  }
  // Without shards, costs divide nothing.
  return {to_string(cache_key(parts)), to_string(cache_key({shard, shard.empty() ? std::string_view() : costs}))};
}

std::optional<Stamp> read_stamp(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  Stamp stamp;
  if (!read_line(stream, "plan ", stamp.made_from.plan) || !read_line(stream, "shard ", stamp.made_from.shard) ||
      !read_line(stream, "archive ", stamp.archive))
    return std::nullopt;
  for (std::string line; std::getline(stream, line); stamp.files.push_back(std::move(line))) {
    if (line == last_line) return stamp;
  }
  return std::nullopt;
}

Status write_stamp(const std::string& path, const std::string& archive, const Fingerprint& made_from,
                   const std::vector<std::string>& files) {
  std::string text = fmt::format("plan {}\nshard {}\narchive {}\n", made_from.plan, made_from.shard, describe(archive));
  for (const std::string& file : files) text += file + "\n";
  return write_text(path, fmt::format("{}{}\n", text, last_line));
}

bool is_up_to_date(const Stamp& stamp, const std::string& archive, const Fingerprint& now) {
  return stamp.made_from == now && stamp.archive == describe(archive) && Archive::open(archive).has_value();
}

std::string stamp_path(const std::string& archive) {
  return std::filesystem::path(archive).replace_extension(".stamp").string();
}

}  // namespace relievo::cli
