#include <fmt/format.h>

#include <array>

#include "describe/descriptor_fields.hpp"

namespace relievo {
namespace {

constexpr std::array<std::string_view, 6> class_names = {"non_iterative", "unsafe",   "quasi_safe",
                                                         "safe",          "combined", "reference"};

void read_technique(TomlReader& reader, TechniqueDescriptor& technique) {
  reader.allow_keys({"schema", "name", "title", "source", "summary", "class", "first_hit", "module", "maps", "features",
                     "loops", "parameters", "axes"});
  technique.technique_class = reader.choice_of<TechniqueClass>("class", class_names);
  technique.first_hit = reader.choice_of<FirstHit>("first_hit", first_hit_names);
  technique.module = reader.path("module");
  technique.maps = reader.names("maps");
  technique.features = read_features(reader);
}

}  // namespace

std::string_view to_string(TechniqueClass value) {
  return class_names[static_cast<std::size_t>(value)];
}

std::string_view to_string(FirstHit value) {
  return first_hit_names[static_cast<std::size_t>(value)];
}

Result<TechniqueDescriptor> parse_technique(std::string_view text, const std::string& path) {
  auto technique = parse_descriptor<TechniqueDescriptor>(text, path, "technique", read_technique);
  if (!technique) return technique;
  for (const Parameter& parameter : technique->parameters) {
    if (parameter.name != "trace") continue;
    return fail(
        ErrorCode::descriptor, "describe.name",
        fmt::format("a parameter has the name \"trace\", but {}_trace is the technique's function", technique->name),
        path, parameter.line, 1);
  }
  return technique;
}

}  // namespace relievo
