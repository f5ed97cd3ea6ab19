#include "describe/origins.hpp"

namespace relievo {

namespace {

/// The lines of a message after its first begin with a place of their own.
void replace_places(std::string& message, const std::string& source, const std::string& origin) {
  const std::string before = "\n  " + source + ":", after = "\n  " + origin + ":";
  for (std::size_t at = message.find(before); at != std::string::npos; at = message.find(before, at + after.size()))
    message.replace(at, before.size(), after);
}

}  // namespace

Error name_file_on_disk(Error error, const Registry& registry) {
  const auto origin = registry.origins.find(error.file);
  if (origin != registry.origins.end()) error.file = origin->second;
  if (error.message.find('\n') == std::string::npos) return error;
  for (const auto& [source, place] : registry.origins) replace_places(error.message, source, place);
  return error;
}

}  // namespace relievo
