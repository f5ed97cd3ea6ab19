/// What the three kinds of descriptor have in common.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "describe/toml_reader.hpp"
#include "relievo/describe.hpp"

namespace relievo {

/// The newest schema that this version reads.
inline constexpr int descriptor_schema = 1;

/// The words for the values of BindingTime and FirstHit, in their order.
inline constexpr std::array<std::string_view, 3> binding_names = {"macro", "specialization", "uniform"};
inline constexpr std::array<std::string_view, 3> first_hit_names = {"never", "if_steps_under_texel", "always"};

/// Rejects a newer schema before anything else: it may well have keys unknown here.
void check_schema(TomlReader& descriptor);

/// The required "name", which is also its folder's: a reader finds a thing by its name.
std::string read_name(TomlReader& descriptor);

/// [loops.*], then [parameters.*], then [axes.*], in the file's order. `owner` is the descriptor's name.
std::vector<Parameter> read_parameters(TomlReader& descriptor, const std::string& owner);

FeatureSet read_features(TomlReader& descriptor);

/// Parses `text` with `read`, which fills all but the fields above every kind has.
template <class Descriptor>
Result<Descriptor> parse_descriptor(std::string_view text, const std::string& path, const std::string& label,
                                    void (*read)(TomlReader&, Descriptor&)) {
  const Result<TomlValue> document = parse_toml(text, path);
  if (!document) return tl::unexpected(document.error());
  FirstError errors{path, {}};
  TomlReader reader(*document, label, errors);
  check_schema(reader);
  Descriptor descriptor;
  descriptor.file = path;
  read(reader, descriptor);
  reader.integer("schema", 1, descriptor_schema);  // required, after a misspelling of it had its chance
  descriptor.name = read_name(reader);
  descriptor.title = reader.text("title");
  descriptor.source = reader.text_or("source", "");
  descriptor.summary = reader.text_or("summary", "");
  descriptor.parameters = read_parameters(reader, descriptor.name);
  if (errors.error) return tl::unexpected(*errors.error);
  return descriptor;
}

}  // namespace relievo
