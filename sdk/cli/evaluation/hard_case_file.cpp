/// Hard cases from TOML.
#include <fmt/format.h>
#include <algorithm>

#include "describe/toml_reader.hpp"
#include "evaluation/hard_cases.hpp"
#include "files/whole_file.hpp"

namespace relievo::cli {

// Defined by the build from tests/hard_cases: file name and text.
extern const std::vector<std::pair<const char*, const char*>> embedded_hard_cases;

namespace {

constexpr int max_extent = 4096;
constexpr std::array<std::string_view, 2> axes = {"u", "v"}, exhausted_words = {"wrong", "allowed"};

double number_or(TomlReader& reader, std::string_view key, double fallback, double low, double high) {
  if (!reader.has(key)) return fallback;
  const double value = reader.number(key);
  if (value >= low && value <= high) return value;
  reader.report("hard_cases.range",
                fmt::format("{} of the {} is {}; {} to {} is expected", quote(key), reader.label(), value, low, high),
                key);
  return fallback;
}

int integer_or(TomlReader& reader, std::string_view key, int fallback, int low, int high) {
  return reader.has(key) ? reader.integer(key, low, high) : fallback;
}

template <class Names>
std::string kind_of(TomlReader& reader, const Names& names) {
  return std::string(names[reader.choice("kind", names)]);
}

HardMap read_map(TomlReader reader) {
  reader.allow_keys(
      {"kind", "width", "height", "low", "high", "terraces", "value", "steps", "period", "along", "seed"});
  HardMap map;
  map.kind = kind_of(reader, hard_map_kinds());
  const std::vector<std::string_view> own = hard_map_keys(map.kind);
  for (std::string_view key : {"value", "steps", "period", "along", "seed"}) {
    if (reader.has(key) && std::find(own.begin(), own.end(), key) == own.end())
      reader.report("hard_cases.key", fmt::format("a map of kind {} has no {}", quote(map.kind), quote(key)), key);
  }
  map.width = integer_or(reader, "width", map.width, 1, max_extent);
  map.height = integer_or(reader, "height", map.height, 1, max_extent);
  map.low = number_or(reader, "low", map.low, 0, 1);
  map.high = number_or(reader, "high", map.high, 0, 1);
  map.terraces = integer_or(reader, "terraces", map.terraces, 1, 65535);
  map.value = number_or(reader, "value", map.value, 0, 1);
  map.steps = integer_or(reader, "steps", map.steps, 1, max_extent);
  map.period = integer_or(reader, "period", map.period, 2, max_extent);
  map.along_v = reader.choice("along", axes, 0) == 1;
  map.seed = integer_or(reader, "seed", map.seed, 0, 1 << 30);
  return map;
}

HardRays read_rays(TomlReader reader) {
  reader.allow_keys({"kind", "angle", "angle_to", "scale", "offset", "seed"});
  HardRays rays;
  rays.kind = kind_of(reader, hard_ray_kinds());
  if (reader.has("angle")) rays.angle[1] = rays.angle[0] = number_or(reader, "angle", 0, 0.001, 90);
  rays.angle[1] = number_or(reader, "angle_to", rays.angle[1], rays.angle[0], 90);
  rays.scale = number_or(reader, "scale", rays.scale, 1e-9, 1e9);
  rays.offset = number_or(reader, "offset", rays.offset, 0, 1e9);
  if (rays.offset != std::floor(rays.offset))
    reader.report("hard_cases.range", fmt::format("\"offset\" is {}; a whole number is expected", rays.offset),
                  "offset");
  rays.seed = integer_or(reader, "seed", rays.seed, 0, 1 << 30);
  return rays;
}

HardCase read_case(TomlReader reader) {
  reader.allow_keys({"name", "rule", "map", "address", "rays", "bits", "exhausted"});
  HardCase result;
  result.file = reader.file();
  result.line = reader.line();
  result.name = reader.name("name");
  result.rule = reader.text("rule");
  result.map = read_map(reader.table("map", fmt::format("map of case {}", quote(result.name))));
  result.rays = read_rays(reader.table("rays", fmt::format("rays of case {}", quote(result.name))));
  if (reader.has("address")) {
    result.addresses.clear();
    for (const std::string& name :
         reader.choices("address", {"repeat", "mirror", "clamp", "clip"}, "hard_cases.address"))
      result.addresses.push_back(*parse_address_mode(name));
  }
  result.bits = integer_or(reader, "bits", 0, 8, 32);
  if (result.bits != 0 && result.bits != 8 && result.bits != 16 && result.bits != 32)
    reader.report("hard_cases.range", fmt::format("\"bits\" is {}; 8, 16 or 32 is expected", result.bits), "bits");
  result.may_exhaust = reader.choice("exhausted", exhausted_words, 0) == 1;
  return result;
}

/// Adds the cases of one file to those of others.
Status append(std::vector<HardCase>& cases, Result<std::vector<HardCase>> more) {
  if (!more) return tl::unexpected(more.error());
  for (HardCase& item : *more) {
    const auto same = std::find_if(cases.begin(), cases.end(), [&](const HardCase& c) { return c.name == item.name; });
    if (same != cases.end()) {
      return fail(ErrorCode::descriptor, "hard_cases.duplicate",
                  fmt::format("the case {} is in {}:{} already", quote(item.name), same->file, same->line), item.file,
                  item.line, 1);
    }
    cases.push_back(std::move(item));
  }
  return {};
}

}  // namespace

Result<std::vector<HardCase>> parse_hard_cases(std::string_view text, const std::string& file) {
  Result<TomlValue> root = parse_toml(text, file);
  if (!root) return tl::unexpected(root.error());
  FirstError errors;
  errors.file = file;
  TomlReader reader(*root, "file", errors);
  reader.allow_keys({"schema", "case"});
  reader.integer("schema", 1, 1);
  std::vector<HardCase> cases;
  for (TomlReader& table : reader.table_list("case")) {
    if (errors.error) break;  // later ones would be read from what is known to be broken
    HardCase item = read_case(table);
    if (errors.error) break;
    if (Status status = append(cases, std::vector<HardCase>{std::move(item)}); !status)
      return tl::unexpected(status.error());
  }
  if (errors.error) return tl::unexpected(*errors.error);
  return cases;
}

Result<std::vector<HardCase>> load_hard_cases(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
      if (entry.path().extension() == ".toml") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
  } else {
    files.push_back(path);
  }
  std::vector<HardCase> cases;
  for (const std::filesystem::path& file : files) {
    Result<std::vector<std::uint8_t>> bytes = read_file(file, "hard_cases");
    if (!bytes) return tl::unexpected(bytes.error());
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    if (Status status = append(cases, parse_hard_cases(text, file.string())); !status)
      return tl::unexpected(status.error());
  }
  if (cases.empty())
    return fail(ErrorCode::io, "hard_cases.none", "there are no cases; expected *.toml files with [[case]] tables",
                path.string());
  return cases;
}

Result<std::vector<HardCase>> own_hard_cases() {
  std::vector<HardCase> cases;
  for (const auto& [file, text] : embedded_hard_cases) {
    if (Status status = append(cases, parse_hard_cases(text, file)); !status) return tl::unexpected(status.error());
  }
  return cases;
}

}  // namespace relievo::cli
