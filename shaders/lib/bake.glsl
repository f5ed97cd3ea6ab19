// Host of a map's bake module: runs relievo_bake once for every texel of the map.
// A module defines `void relievo_bake(ivec2 texel)`, reads its input maps and writes with relievo_bake_write.
#include "ray.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140, set = 0, binding = 1) uniform Bake {
  ivec4 relievo_bake_size;    // width, height, channels, level
  ivec4 relievo_bake_source;  // of the level below: width, height, offset; offset of this level, in texels
};
layout(std430, set = 0, binding = 2) buffer MapTexels { float relievo_map_texels[]; };

ivec2 relievo_bake_extent() { return relievo_bake_size.xy; }

void relievo_bake_write(ivec2 texel, int channel, float value) {
  int index = (relievo_bake_source.w + texel.y * relievo_bake_size.x + texel.x) * relievo_bake_size.z + channel;
  relievo_map_texels[index] = value;
}

int relievo_bake_level() { return relievo_bake_size.w; }

// A value of the level below, for levels from 1 on; texels outside it repeat its edge.
float relievo_bake_read_below(ivec2 texel, int channel) {
  ivec2 inside = clamp(texel, ivec2(0), relievo_bake_source.xy - 1);
  int index = (relievo_bake_source.z + inside.y * relievo_bake_source.x + inside.x) * relievo_bake_size.z + channel;
  return relievo_map_texels[index];
}

void relievo_bake(ivec2 texel);

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (all(lessThan(texel, relievo_bake_size.xy))) relievo_bake(texel);
}
