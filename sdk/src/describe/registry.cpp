#include <fmt/format.h>

#include <utility>

#include "describe/descriptor_place.hpp"
#include "describe/origins.hpp"
#include "describe/registry_checks.hpp"
#include "describe/source_path.hpp"
#include "describe/toml_reader.hpp"
#include "describe/user_folder.hpp"
#include "relievo/describe.hpp"

namespace relievo {
namespace {

/// Parses one descriptor and adds it to those of its kind.
template <class Descriptor, class Parse>
Status add(std::map<std::string, Descriptor, std::less<>>& known, const std::string& path, const std::string& text,
           Parse parse) {
  Result<Descriptor> descriptor = parse(text, path);
  if (!descriptor) return tl::unexpected(descriptor.error());
  const auto [first, is_new] = known.try_emplace(descriptor->name, *descriptor);
  if (is_new) return {};
  const Place place = find_place(text, "name");
  return fail(
      ErrorCode::descriptor, "describe.duplicate",
      fmt::format("the name {} is already taken by {}", quote(descriptor->name), quote_path(first->second.file)), path,
      place.line, place.column);
}

/// A descriptor is found by its file name, wherever in the tree it is.
Status add_descriptors(Registry& registry) {
  Status status;
  for (const auto& [path, text] : registry.sources) {
    const std::string file = file_name_of(path);
    if (file == "technique.toml") status = add(registry.techniques, path, text, parse_technique);
    if (file == "map.toml") status = add(registry.maps, path, text, parse_map);
    if (file == "stage.toml") status = add(registry.stages, path, text, parse_stage);
    if (!status) return status;
  }
  return status;
}

Result<Registry> finish(Registry registry) {
  Status status = add_descriptors(registry);
  if (status) status = check_registry(registry);
  if (!status) return tl::unexpected(name_file_on_disk(status.error(), registry));
  return registry;
}

template <class Descriptor>
Result<const Descriptor*> look_up(const std::map<std::string, Descriptor, std::less<>>& known, std::string_view name,
                                  const std::string& kind) {
  const auto found = known.find(name);
  if (found != known.end()) return &found->second;
  std::vector<std::string> names;
  for (const auto& [key, descriptor] : known) names.push_back(key);
  return fail(ErrorCode::usage, "describe.unknown-" + kind,
              fmt::format("the {} {} is not known{}", kind, quote(name), suggest(name, names)));
}

}  // namespace

Result<const TechniqueDescriptor*> Registry::technique(std::string_view name) const {
  return look_up(techniques, name, "technique");
}

Result<const MapDescriptor*> Registry::map(std::string_view name) const {
  return look_up(maps, name, "map");
}

Result<const StageDescriptor*> Registry::stage(std::string_view name) const {
  return look_up(stages, name, "stage");
}

Result<Registry> load_registry(SourceTree sources) {
  Registry registry;
  registry.sources = std::move(sources);
  return finish(std::move(registry));
}

Result<Registry> load_registry(const std::vector<std::filesystem::path>& folders) {
  Registry registry;
  registry.sources = embedded_sources();
  for (const std::filesystem::path& folder : folders) {
    if (const Status read = read_user_folder(folder, registry); !read) return tl::unexpected(read.error());
  }
  return finish(std::move(registry));
}

}  // namespace relievo
