#include "depfile.hpp"

namespace relievo::cli {

namespace {

std::string escape_name(std::string name) {
  for (std::size_t at = 0; (at = name.find_first_of(" #$", at)) != std::string::npos; at += 2)
    name.insert(at, name[at] == '$' ? "$" : "\\");
  return name;
}

}  // namespace

std::set<std::string> files_on_disk(const Registry& registry, const std::vector<std::string>& sources) {
  std::set<std::string> files;
  for (const std::string& source : sources) {
    const auto origin = registry.origins.find(source);
    if (origin != registry.origins.end()) files.insert(origin->second);
  }
  for (const auto& [source, origin] : registry.origins) {
    if (source.ends_with(".toml")) files.insert(origin);
  }
  return files;
}

std::string depfile_rule(const std::string& target, const std::set<std::string>& files) {
  std::string text = escape_name(target) + ":";
  for (const std::string& file : files) text += " \\\n  " + escape_name(file);
  return text + "\n";
}

}  // namespace relievo::cli
