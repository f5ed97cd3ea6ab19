/// Baking: what techniques read besides the height map is computed by compute modules on any backend that has compute.
/// Every function here is thread-safe; `quantise` changes its map, `bake_map` its maps and messages, with a backend
/// that no other thread uses meanwhile.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "relievo/backend.hpp"
#include "relievo/compose.hpp"
#include "relievo/height_map.hpp"
#include "relievo/map_texels.hpp"

namespace relievo {

/// A map in memory: `channels` values a texel, interleaved, row 0 first, the levels one after another.
struct MapData {
  std::string name;
  int width = 0, height = 0;  ///< texels of level 0; level k has max(1, extent >> k)
  int channels = 1;           ///< 1–4
  MapTexels texels;
  AddressMode address = AddressMode::repeat;
  int levels = 1;
  int depth = 1;  ///< layers of an array or a 3D map, one after another; then levels is 1
  MapDimension dimension = MapDimension::flat;
  /// 8, 16: every texel is k / (2^bits − 1) and the texture is unorm; 32: floats. Texels of more bits are rounded.
  int bits = 32;
  bool is_uint = false;  ///< the texture holds the whole numbers k; then bits is 16 and channels 4
};

/// Brings every value to the nearest, next higher or next lower multiple of 1 / (2^bits − 1), by channel.
/// Channels that are to be `exact` raise the bits of all until they are.
/// Values must lie in [0,1], else "maps.range"; bits 32 changes nothing.
Status quantise(MapData& map, int bits, std::span<const Rounding> rounding);

/// Texels of level k, and of all levels before it.
struct MapLevel {
  int width = 0, height = 0;
  std::size_t offset = 0;  ///< in texels
};
MapLevel map_level(const MapData& map, int level);

/// Texels of all levels and layers; and the bytes that they take as a texture.
std::size_t texel_count(const MapData& map);
std::size_t texture_bytes(const MapData& map);

/// All of a map but its texels, for a height map of that extent: `values` ("map.parameter", within their ranges) decide
/// layers and bits, else the descriptor's defaults.
MapData map_shape(const MapDescriptor& descriptor, int width, int height, AddressMode address,
                  const std::map<std::string, double>& values = {});

/// Maps by name; "height" is always there.
using MapSet = std::map<std::string, MapData, std::less<>>;

/// The set that holds the height map alone.
MapSet map_set(HeightMap height_map);

/// The maps that a stage and the technique in its roles read, with whatever values of their axes; `technique` is empty
/// for stages that trace nothing.
/// Errors: "describe.unknown-stage", "describe.unknown-technique".
Result<std::vector<std::string>> required_maps(const Registry& registry, std::string_view stage,
                                               std::string_view technique);

/// Bakes `map` and whatever it needs first into `maps`, which holds "height"; maps that are there already stay.
/// `values` are keyed "map.parameter"; those of other owners are ignored.
/// A map whose texels are more than a storage buffer of the backend holds is baked into several.
/// Errors: "describe.unknown-map", "compose.*", "compile.*", "backend.*"; "maps.too-large" for more than eight of
/// these; "maps.non-finite" if the result is not finite.
Status bake_map(Backend& backend, const Registry& registry, std::string_view map, MapSet& maps,
                const std::map<std::string, double>& values = {}, std::vector<std::string>* messages = nullptr);

/// The same for every map that a stage and a technique read (required_maps). Where all are there, `maps` is only read.
Status bake_required_maps(Backend& backend, const Registry& registry, std::string_view stage,
                          std::string_view technique, MapSet& maps, const std::map<std::string, double>& values = {},
                          std::vector<std::string>* messages = nullptr);

/// A map as its file has it.
struct MapFile {
  MapData map;
  std::map<std::string, double> values;  ///< parameters that it was baked with, "map.parameter"
};

/// Writes all levels and layers losslessly as one image, and its description beside it as `<path>.json`: docs/maps.md.
/// .exr takes any map, .pfm those of 1 or 3 channels, .png those of 8 and 16 bits. Errors: "maps.format" for another
/// extension or a map that does not fit it, "image.*".
Status write_map(const std::filesystem::path& path, const MapData& map,
                 const std::map<std::string, double>& values = {});

/// Reads what write_map wrote. With `shape`, a map without its texels (map_shape), the description is not needed, and
/// where there is one it must agree.
/// Errors: "maps.description" when it is missing, unreadable or differs from `shape`; "maps.size" when the image does
/// not have the extent and channels of that map; "maps.non-finite"; "maps.bits" for a value that the bits do not hold;
/// "maps.format" for floats in a .png; "image.*".
Result<MapFile> read_map(const std::filesystem::path& path, const MapData* shape = nullptr);

/// The texture of a map, of its bits: 1, 2 or 4 channels (3 become 4), with the address mode of the map; filtered
/// linearly unless it holds whole numbers. Where BindingSlot::is_filtered is false any filter will do.
Texture map_texture(const MapData& map);

/// A height map as a texture of the axis `height.format`: "red"; "alpha": RGBA floats, the first three 0;
/// "red_green": heights rounded to 16 bits, high byte first. Errors: "maps.height-format".
Result<Texture> height_texture(const MapData& height, std::string_view format);

}  // namespace relievo
