#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include "describe/descriptor_fields.hpp"
#include "describe/rules.hpp"
#include "relievo/permute.hpp"

namespace relievo {

namespace {

/// `address = ["repeat", "clamp"]` is short for a table with `values` alone.
TomlValue long_form(const TomlEntry& axis) {
  if (axis.value.kind == TomlValue::Kind::table) return axis.value;
  TomlValue table;
  table.line = axis.value.line;
  table.column = axis.value.column;
  table.entries.push_back({"values", axis.value, axis.line, axis.column});
  return table;
}

ManifestAxis read_manifest_axis(const TomlEntry& entry, FirstError& errors) {
  TomlReader table(long_form(entry), fmt::format("axis {}", quote(entry.key)), errors);
  table.allow_keys({"values", "default", "binding"});
  ManifestAxis axis;
  axis.name = entry.key;
  axis.line = entry.line;
  axis.values = table.words("values");
  if (axis.values.empty()) {
    table.report("describe.missing-key",
                 fmt::format("the {} has no \"values\"; at least one is expected", table.label()), "values");
  }
  const std::vector<std::string> defaults = table.words("default");
  if (!defaults.empty()) axis.default_value = defaults.front();
  if (!axis.default_value.empty() && axis.values != std::vector<std::string>{"all"} &&
      std::find(axis.values.begin(), axis.values.end(), axis.default_value) == axis.values.end()) {
    table.report("describe.range",
                 fmt::format("\"default\" of the {} is {}, which is none of its values{}", table.label(),
                             quote(axis.default_value), suggest(axis.default_value, axis.values)),
                 "default");
  }
  if (table.has("binding")) axis.binding = table.choice_of<BindingTime>("binding", binding_names);
  return axis;
}

void read_axes(const TomlValue& root, TomlReader& reader, Manifest& manifest, FirstError& errors) {
  const TomlEntry* axes = find_entry(root, "axes");
  if (!axes || axes->value.kind != TomlValue::Kind::table) {
    reader.table("axes", "axes");  // reports what is wrong
    return;
  }
  for (const TomlEntry& entry : axes->value.entries) manifest.axes.push_back(read_manifest_axis(entry, errors));
}

void read_targets(TomlReader& reader, Manifest& manifest) {
  const std::vector<std::string> names = reader.words("targets");
  if (names.empty()) {
    reader.report("describe.missing-key", "the manifest has no \"targets\"; at least one is expected", "targets");
  }
  for (const std::string& name : names) {
    if (const Result<Target> target = parse_target(name)) {
      manifest.targets.push_back(*target);
    } else {
      reader.report(target.error().id, target.error().message, "targets");
    }
  }
}

void read_scene(TomlReader& reader, Manifest& manifest) {
  if (!reader.has("scene")) return;
  TomlReader scene = reader.table("scene", "scene");
  scene.allow_keys({"maps", "first_hit", "without_features"});
  if (scene.has("maps")) manifest.scene.maps = scene.words("maps");
  manifest.scene.first_hit = scene.choice_of<FirstHit>("first_hit", first_hit_names, FirstHit::never);
  const FeatureSet& known = known_features();
  manifest.scene.without_features =
      scene.choices("without_features", {known.begin(), known.end()}, "describe.unknown-feature");
}

void read_rule_tables(TomlReader& reader, Manifest& manifest) {
  for (TomlReader& table : reader.table_list_or_none("rule")) {
    table.allow_keys({"when", "requires", "excludes", "reason"});
    for (Rule& rule : read_rules(table, read_conditions(table, "when", ""), "")) {
      manifest.rules.push_back(std::move(rule));
    }
  }
}

bool read_flag(TomlReader& reader, std::string_view key, bool fallback) {
  const std::vector<std::string> words = reader.words(key);
  if (words.empty()) return fallback;
  if (words.size() == 1 && (words[0] == "on" || words[0] == "off")) return words[0] == "on";
  reader.report("describe.type",
                fmt::format("{} of the manifest is {}; true or false is expected", quote(key), quote(words[0])), key);
  return fallback;
}

/// Relative to the manifest's own folder.
void read_folders(TomlReader& reader, const std::filesystem::path& base, bool must_exist, Manifest& manifest) {
  for (const std::string& folder : reader.words("folders")) {
    manifest.folders.push_back(base / folder);
    std::error_code error;
    if (!must_exist || std::filesystem::is_directory(manifest.folders.back(), error)) continue;
    reader.report(
        "permute.folder",
        fmt::format("{} of \"folders\" is no folder that can be read; one with techniques, maps or stages in it "
                    "is expected",
                    quote(folder)),
        "folders");
  }
}

Result<Manifest> read_manifest(std::string_view text, const std::string& file, bool folders_must_exist) {
  const Result<TomlValue> document = parse_toml(text, file);
  if (!document) return tl::unexpected(document.error());
  FirstError errors{file, {}};
  TomlReader reader(*document, "manifest", errors);
  check_schema(reader);
  reader.allow_keys({"schema", "name", "folders", "targets", "optimize", "scene", "axes", "rule"});
  Manifest manifest;
  manifest.file = file;
  reader.integer("schema", 1, descriptor_schema);
  manifest.name = reader.name("name");
  read_folders(reader, std::filesystem::path(file).parent_path(), folders_must_exist, manifest);
  read_targets(reader, manifest);
  manifest.optimize = read_flag(reader, "optimize", true);
  read_scene(reader, manifest);
  read_axes(*document, reader, manifest, errors);
  read_rule_tables(reader, manifest);
  if (errors.error) return tl::unexpected(*errors.error);
  return manifest;
}

}  // namespace

Result<Manifest> parse_manifest(std::string_view text, const std::string& file) {
  return read_manifest(text, file, false);
}

Result<Manifest> load_manifest(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();  // fails when there is nothing, which the parser has words for
  if (!stream.is_open() || stream.bad() || std::filesystem::is_directory(path)) {
    return fail(ErrorCode::io, "permute.manifest",
                fmt::format("the manifest {} cannot be read; a relievo.toml is expected", quote_path(path.string())),
                path.string());
  }
  return read_manifest(text.str(), path.string(), true);
}

}  // namespace relievo
