// Host of a map's bake module: runs relievo_bake once for every texel of the map.
// A module defines `void relievo_bake(ivec2 texel)`, reads its input maps and writes with relievo_bake_write.
#include "ray.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140, set = 0, binding = 1) uniform Bake {
  ivec4 relievo_bake_size;  // width, height, channels, level
};
layout(std430, set = 0, binding = 2) writeonly buffer MapTexels { float relievo_map_texels[]; };

ivec2 relievo_bake_extent() { return relievo_bake_size.xy; }

void relievo_bake_write(ivec2 texel, int channel, float value) {
  int index = (texel.y * relievo_bake_size.x + texel.x) * relievo_bake_size.z + channel;
  relievo_map_texels[index] = value;
}

void relievo_bake(ivec2 texel);

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (all(lessThan(texel, relievo_bake_size.xy))) relievo_bake(texel);
}
