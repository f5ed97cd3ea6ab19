/// Maps in files: all levels and layers in one image, and a JSON description beside it (docs/maps.md).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "files/whole_file.hpp"
#include "maps/map_layout.hpp"
#include "relievo/image.hpp"

namespace relievo {

namespace {

using nlohmann::json;
using std::filesystem::path;

constexpr int schema = 1;
constexpr int max_layers = 256, max_levels = 15;

path description_of(const path& image) {
  return image.string() + ".json";
}

/// Calls `copy(texel, pixel)` with the place of every value's texel in the map and its pixel in the image.
template <class Copy>
void for_each_texel(const MapLayout& layout, Copy copy) {
  for (const MapPanel& panel : layout.panels) {
    std::size_t texel = panel.offset;
    for (int y = 0; y < panel.height; ++y) {
      std::size_t pixel = static_cast<std::size_t>(panel.y + y) * static_cast<std::size_t>(layout.width) +
                          static_cast<std::size_t>(panel.x);
      for (int x = 0; x < panel.width; ++x) copy(texel++, pixel++);
    }
  }
}

std::size_t value_count(const MapLayout& layout, int channels) {
  return static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height) *
         static_cast<std::size_t>(channels);
}

/// The pixels of the whole image; `convert` turns a texel's value into one of the file's.
template <class Value, class Convert>
std::vector<Value> to_pixels(const MapData& map, const MapLayout& layout, Convert convert) {
  const auto channels = static_cast<std::size_t>(map.channels);
  std::vector<Value> pixels(value_count(layout, map.channels));
  for_each_texel(layout, [&](std::size_t texel, std::size_t pixel) {
    for (std::size_t c = 0; c < channels; ++c) pixels[pixel * channels + c] = convert(map.texels[texel * channels + c]);
  });
  return pixels;
}

template <class Value>
Status write_quantised(const path& file, const MapData& map, const MapLayout& layout) {
  const double most = std::numeric_limits<Value>::max();
  const auto pixels = to_pixels<Value>(
      map, layout, [=](float value) { return static_cast<Value>(std::lround(static_cast<double>(value) * most)); });
  return write_png(file, layout.width, layout.height, map.channels, std::span<const Value>(pixels));
}

Status write_image(const path& file, const MapData& map, const MapLayout& layout) {
  const std::string extension = file.extension().string();
  if (extension == ".png") {
    if (map.bits == 8) return write_quantised<std::uint8_t>(file, map, layout);
    if (map.bits == 16) return write_quantised<std::uint16_t>(file, map, layout);
    return file_error(file, "maps.format",
                      fmt::format("cannot hold map '{}', whose texels are floats; expected .exr or .pfm", map.name));
  }
  if (extension != ".exr" && extension != ".pfm") {
    return file_error(file, "maps.format",
                      fmt::format("has the extension '{}'; expected .exr, .pfm or .png", extension));
  }
  if (layout.width > max_image_extent || layout.height > max_image_extent) {
    return file_error(file, "maps.format",
                      fmt::format("cannot hold map '{}', which takes {}x{} pixels; at most {} a side are expected",
                                  map.name, layout.width, layout.height, max_image_extent));
  }
  const Image image{layout.width, layout.height, map.channels,
                    to_pixels<float>(map, layout, [](float value) { return value; })};
  if (extension == ".exr") return write_exr(file, image);
  if (map.channels != 1 && map.channels != 3) {
    return file_error(file, "maps.format",
                      fmt::format("cannot hold the {} channels of map '{}'; expected .exr", map.channels, map.name));
  }
  return write_pfm(file, image);
}

std::string shape_text(const MapData& m) {
  return fmt::format("{}x{}x{} texels, {} levels, {} channels, {} bits{}, {}", m.width, m.height, m.depth, m.levels,
                     m.channels, m.bits, m.is_uint ? " as uint" : "", to_string(m.address));
}

bool same_shape(const MapData& a, const MapData& b) {
  return a.name == b.name && shape_text(a) == shape_text(b) && a.dimension == b.dimension;
}

tl::unexpected<Error> description_error(const path& file, const std::string& rest) {
  return file_error(description_of(file), "maps.description", rest);
}

bool is_plausible(const MapData& m) {
  const auto within = [](int value, int least, int most) { return value >= least && value <= most; };
  return within(m.width, 1, max_height_map_extent) && within(m.height, 1, max_height_map_extent) &&
         within(m.channels, 1, 4) && within(m.levels, 1, max_levels) && within(m.depth, 1, max_layers) &&
         (m.depth == 1 || m.levels == 1) && (m.bits == 8 || m.bits == 16 || m.bits == 32) &&
         (!m.is_uint || (m.bits == 16 && m.channels == 4));
}

/// Throws for a word that is none.
MapDimension dimension_of(const std::string& word) {
  for (MapDimension dimension : {MapDimension::flat, MapDimension::array, MapDimension::volume}) {
    if (word == to_string(dimension)) return dimension;
  }
  throw std::runtime_error(fmt::format("the dimension is '{}'", word));
}

/// Throws for a word that is none.
bool is_uint_of(const std::string& word) {
  if (word != "unorm" && word != "uint") throw std::runtime_error(fmt::format("its texels are '{}'", word));
  return word == "uint";
}

/// Throws for what is no whole number, or none that an int holds.
int whole_number(const json& text, const char* key) {
  const json& value = text.at(key);
  if (!value.is_number_integer() || !std::in_range<int>(value.get<std::int64_t>()) ||
      (value.is_number_unsigned() && !std::in_range<int>(value.get<std::uint64_t>())))
    throw std::runtime_error(fmt::format("\"{}\" is {}; a whole number is expected", key, value.dump()));
  return value.get<int>();
}

/// The map of a description, without its texels. Throws what the JSON library throws.
MapFile parse_description(const json& text) {
  MapFile file;
  MapData& map = file.map;
  map.name = text.at("map").get<std::string>();
  map.width = whole_number(text, "width");
  map.height = whole_number(text, "height");
  map.depth = whole_number(text, "layers");
  map.levels = whole_number(text, "levels");
  map.channels = whole_number(text, "channels");
  map.bits = whole_number(text, "bits");
  map.is_uint = is_uint_of(text.value("texels", "unorm"));
  map.dimension = dimension_of(text.at("dimension").get<std::string>());
  const Result<AddressMode> address = parse_address_mode(text.at("address").get<std::string>());
  if (!address) throw std::runtime_error(address.error().message);
  map.address = *address;
  file.values = text.at("values").get<std::map<std::string, double>>();
  return file;
}

Result<MapFile> read_description(const path& file) {
  const Result<std::vector<std::uint8_t>> bytes = read_file(description_of(file), "maps");
  if (!bytes) {
    return description_error(file, fmt::format("cannot be read; expected the description of '{}', which is written "
                                               "beside it, or the map's parameters",
                                               short_name(file)));
  }
  try {
    const json text = json::parse(bytes->begin(), bytes->end());
    if (whole_number(text, "schema") != schema)
      return description_error(file,
                               fmt::format("has the schema {}; expected {}", whole_number(text, "schema"), schema));
    MapFile result = parse_description(text);
    if (is_plausible(result.map)) return result;
    return description_error(file, fmt::format("describes {}, which no map has", shape_text(result.map)));
  } catch (const std::exception& error) {
    return description_error(file, fmt::format("is no description of a map: {}", error.what()));
  }
}

/// The description beside the file; with `shape`, that, and the two must agree where both are.
Result<MapFile> describe_file(const path& file, const MapData* shape) {
  std::error_code ignored;
  if (shape != nullptr && !std::filesystem::exists(description_of(file), ignored)) return MapFile{*shape, {}};
  Result<MapFile> described = read_description(file);
  if (!described || shape == nullptr || same_shape(described->map, *shape)) return described;
  return description_error(file, fmt::format("describes map '{}' of {}; expected '{}' of {}", described->map.name,
                                             shape_text(described->map), shape->name, shape_text(*shape)));
}

/// Brings a value back to the very multiple that was written: another format may have rounded it.
bool snap(float& value, int bits) {
  if (bits == 32) return std::isfinite(value);
  const double most = (1 << bits) - 1, scaled = static_cast<double>(value) * most;
  if (!(scaled > -0.25 && scaled < most + 0.25) || std::abs(scaled - std::round(scaled)) > 0.01) return false;
  value = static_cast<float>(std::round(scaled) / most);
  return true;
}

Status take_texels(const path& file, const Image& image, const MapLayout& layout, MapData& map) {
  const auto channels = static_cast<std::size_t>(map.channels);
  std::vector<float> values(texel_count(map) * channels);
  for_each_texel(layout, [&](std::size_t texel, std::size_t pixel) {
    std::copy_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(pixel * channels), channels,
                values.begin() + static_cast<std::ptrdiff_t>(texel * channels));
  });
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float given = values[i];
    if (snap(values[i], map.bits)) continue;
    if (!std::isfinite(given))
      return file_error(file, "maps.non-finite",
                        fmt::format("has the value {} at element {}; expected a finite number", given, i));
    return file_error(file, "maps.bits",
                      fmt::format("has the value {} at element {}; expected a multiple of 1/{} in [0,1]", given, i,
                                  (1 << map.bits) - 1));
  }
  map.texels = MapTexels(values, map.bits);
  return {};
}

}  // namespace

Status write_map(const path& file, const MapData& map, const std::map<std::string, double>& values) {
  if (Status status = write_image(file, map, map_layout(map)); !status) return status;
  json text = {{"schema", schema},
               {"map", map.name},
               {"width", map.width},
               {"height", map.height},
               {"layers", map.depth},
               {"levels", map.levels},
               {"channels", map.channels},
               {"bits", map.bits},
               {"dimension", to_string(map.dimension)},
               {"address", to_string(map.address)},
               {"values", values}};
  if (map.is_uint) text["texels"] = "uint";
  const std::string lines = text.dump(2) + "\n";
  return write_file(description_of(file), std::vector<std::uint8_t>(lines.begin(), lines.end()), "maps");
}

Result<MapFile> read_map(const path& file, const MapData* shape) {
  Result<Image> image = load_image(file);
  if (!image) return tl::unexpected(image.error());
  Result<MapFile> result = describe_file(file, shape);
  if (!result) return result;
  MapData& map = result->map;
  if (map.bits == 32 && file.extension() == ".png")
    return file_error(file, "maps.format",
                      fmt::format("is a picture; map '{}' of floats is expected in .exr or .pfm, "
                                  "or its parameter bits to be 8 or 16",
                                  map.name));
  const MapLayout layout = map_layout(map);
  if (image->width != layout.width || image->height != layout.height || image->channels != map.channels) {
    return file_error(file, "maps.size",
                      fmt::format("has {}x{} pixels of {} channels; expected {}x{} of {} for map '{}' of {}",
                                  image->width, image->height, image->channels, layout.width, layout.height,
                                  map.channels, map.name, shape_text(map)));
  }
  if (Status status = take_texels(file, *image, layout, map); !status) return tl::unexpected(status.error());
  return result;
}

}  // namespace relievo
