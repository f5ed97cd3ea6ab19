// Copies the nodes of max_pyramid to their places; what is left over in layer 1 is 0.
#include "packing.glsl"
#include "shaders/lib/bake.glsl"

float pyramid_3d_packed(ivec2 texel) {
  ivec2 extent = relievo_bake_extent();
  int top = relievo_packed_top(extent);
  for (int level = 1; level <= top; ++level) {
    ivec2 node = texel - relievo_packed_origin(extent, level);
    bool inside = all(greaterThanEqual(node, ivec2(0))) && all(lessThan(node, relievo_packed_size(extent, level)));
    if (inside) return relievo_max_pyramid_at(node, level);
  }
  return 0.0;
}

void relievo_bake(ivec2 texel) {
  float value = relievo_bake_layer() == 0 ? relievo_max_pyramid_at(texel, 0) : pyramid_3d_packed(texel);
  relievo_bake_write(texel, 0, value);
}
