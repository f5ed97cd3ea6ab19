// Level 0: cell (i, j) lies between the texels i, i+1 and j, j+1; a bilinear patch is nowhere below its lowest corner and
// nowhere above its highest. With mirror, clamp and clip, cell 0 also covers the half texel before texel 0.
// Level k: the extremes of four. Padding to a power of two is (1, 0), which changes no extreme: it lies outside every tile.
#include "shaders/lib/bake.glsl"

vec2 min_max_pyramid_joined(vec2 a, vec2 b) { return vec2(min(a.x, b.x), max(a.y, b.y)); }

vec2 min_max_pyramid_texel(ivec2 texel, ivec2 extent) { return vec2(relievo_height_texel(texel, extent)); }

vec2 min_max_pyramid_cell(ivec2 cell) {
  ivec2 extent = textureSize(relievo_height_map, 0);
  if (any(greaterThanEqual(cell, extent))) return vec2(1.0, 0.0);
  vec2 low = min_max_pyramid_joined(min_max_pyramid_texel(cell, extent), min_max_pyramid_texel(cell + ivec2(1, 0), extent));
  vec2 high =
      min_max_pyramid_joined(min_max_pyramid_texel(cell + ivec2(0, 1), extent), min_max_pyramid_texel(cell + 1, extent));
  return min_max_pyramid_joined(low, high);
}

vec2 min_max_pyramid_below(ivec2 texel) {
  return vec2(relievo_bake_read_below(texel, 0), relievo_bake_read_below(texel, 1));
}

void relievo_bake(ivec2 texel) {
  vec2 value;
  if (relievo_bake_level() == 0) {
    value = min_max_pyramid_cell(texel);
  } else {
    ivec2 child = 2 * texel;
    value = min_max_pyramid_joined(
        min_max_pyramid_joined(min_max_pyramid_below(child), min_max_pyramid_below(child + ivec2(1, 0))),
        min_max_pyramid_joined(min_max_pyramid_below(child + ivec2(0, 1)), min_max_pyramid_below(child + 1)));
  }
  relievo_bake_write(texel, 0, value.x);
  relievo_bake_write(texel, 1, value.y);
}
