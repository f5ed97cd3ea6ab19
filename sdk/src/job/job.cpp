#include "relievo/job.hpp"

#include <algorithm>
#include <cassert>

namespace relievo {

namespace {

struct FormatTraits {
  std::string_view name;
  int channels;
  int bytes_per_channel;
};

// In the order of the enum.
constexpr FormatTraits format_traits[] = {
    {"r8_unorm", 1, 1},    {"rg8_unorm", 2, 1},    {"rgb8_unorm", 3, 1},   {"rgba8_unorm", 4, 1}, {"r16_unorm", 1, 2},
    {"rg16_unorm", 2, 2},  {"rgb16_unorm", 3, 2},  {"rgba16_unorm", 4, 2}, {"r32_float", 1, 4},   {"rg32_float", 2, 4},
    {"rgb32_float", 3, 4}, {"rgba32_float", 4, 4}, {"r32_uint", 1, 4},     {"d32_float", 1, 4},   {"rgba16_uint", 4, 2},
};

const FormatTraits& traits(Format format) {
  assert(static_cast<std::size_t>(format) < std::size(format_traits));
  return format_traits[static_cast<std::size_t>(format)];
}

}  // namespace

std::string_view to_string(ShaderStage stage) {
  constexpr std::string_view names[] = {
      "vertex", "tessellation_control", "tessellation_evaluation", "geometry", "fragment", "compute"};
  return names[static_cast<std::size_t>(stage)];
}

std::string_view to_string(ResourceKind kind) {
  constexpr std::string_view names[] = {"uniform_buffer", "storage_buffer", "sampled_texture", "storage_texture"};
  return names[static_cast<std::size_t>(kind)];
}

std::string_view to_string(Format format) {
  return traits(format).name;
}

int channel_count(Format format) {
  return traits(format).channels;
}

bool is_integer(Format format) {
  return format == Format::r32_uint || format == Format::rgba16_uint;
}

int bytes_per_texel(Format format) {
  return traits(format).channels * traits(format).bytes_per_channel;
}

std::size_t resource_bytes(const Job& job) {
  std::size_t bytes = 0;
  for (const Buffer& buffer : job.buffers) bytes += buffer.size;
  for (const Texture& texture : job.textures) {
    for (int level = 0; level < texture.levels; ++level) bytes += level_size(texture, level);
  }
  return bytes;
}

std::size_t level_size(const Texture& texture, int level) {
  const auto extent = [level](int size) { return static_cast<std::size_t>(std::max(1, size >> level)); };
  return extent(texture.width) * extent(texture.height) * extent(texture.depth) *
         static_cast<std::size_t>(bytes_per_texel(texture.format));
}

void free_contents(Job& job) {
  for (Buffer& buffer : job.buffers) buffer.data = {};
  for (Texture& texture : job.textures) texture.data = {};
}

}  // namespace relievo
