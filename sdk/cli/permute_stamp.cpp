#include "permute_stamp.hpp"

#include <fmt/format.h>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common.hpp"

namespace relievo::cli {

namespace {

std::string read_all(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Everything that decides the archive, and the archive as it lies there.
std::string describe(const std::string& archive, const Manifest& manifest, const Registry& registry,
                     const std::string& shard) {
  std::error_code error;
  const auto size = std::filesystem::file_size(archive, error);
  if (error) return {};
  const auto time = std::filesystem::last_write_time(archive, error).time_since_epoch().count();
  if (error) return {};
  const std::string manifest_text = read_all(manifest.file);
  std::vector<std::string_view> parts = {compiler_version(), manifest_text, shard};
  for (const auto& [path, text] : registry.sources) {
    parts.push_back(path);
    parts.push_back(text);
  }
  return fmt::format("{} {} {}\n", to_string(cache_key(parts)), size, time);
}

}  // namespace

bool is_up_to_date(const std::string& stamp, const std::string& archive, const Manifest& manifest,
                   const Registry& registry, const std::string& shard) {
  const std::string now = describe(archive, manifest, registry, shard);
  return !now.empty() && now == read_all(stamp) && Archive::open(archive).has_value();
}

Status write_stamp(const std::string& stamp, const std::string& archive, const Manifest& manifest,
                   const Registry& registry, const std::string& shard) {
  return write_text(stamp, describe(archive, manifest, registry, shard));
}

}  // namespace relievo::cli
