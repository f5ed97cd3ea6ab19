/// The surface that everything here is about: a height map read as a bilinear patchwork.
/// Every function here is thread-safe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "relievo/result.hpp"

namespace relievo {

/// What lies beyond [0,1]²: the map again, its mirror image, its edge extended, or nothing.
enum class AddressMode { repeat, mirror, clamp, clip };

std::string_view to_string(AddressMode mode);
Result<AddressMode> parse_address_mode(std::string_view name);

/// One channel t in [0,1], `width`×`height` texels, row-major; row 0 is v = 0; texel (i,j) is centred at
/// ((i+½)/width, (j+½)/height). The surface is the bilinear interpolation of the centres.
struct HeightMap {
  int width = 0;   ///< texels, ≥ 1
  int height = 0;  ///< texels, ≥ 1
  std::vector<float> texels;
  AddressMode address = AddressMode::repeat;

  float at(int i, int j) const {
    return texels[static_cast<size_t>(j) * static_cast<size_t>(width) + static_cast<size_t>(i)];
  }
};

/// Largest accepted width or height, texels.
inline constexpr int max_height_map_extent = 16384;

/// Reads a height map: PNG (8/16 bit, grey or colour, palette), BMP (also gzipped), TGA, JPEG, EXR, PFM, HDR, or a 2D
/// array of an .npy or .npz file. Integer files map 0..max to [0,1]; floats are taken as they are when they lie in
/// [0,1] and otherwise, like arrays of integers, are normalised from [min,max] to [0,1]. Colour becomes its first
/// channel when all are equal, else Rec. 709 luminance. Errors: missing, unreadable, truncated, larger than
/// max_height_map_extent, NaN or Inf (named by texel); id "image.*".
Result<HeightMap> load_height_map(const std::filesystem::path& path);

/// Texel coordinate `i` (any integer) brought into [0, extent) by `mode`; clip behaves as clamp (the domain test is
/// apart).
int wrap_texel(std::int64_t i, int extent, AddressMode mode);

/// Bilinear height at (u,v), double precision, with the map's address mode.
double sample_height(const HeightMap& map, double u, double v);

}  // namespace relievo
