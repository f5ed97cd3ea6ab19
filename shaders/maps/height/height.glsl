// Height access. Filter `hardware` asks the texture unit (about 8 fractional bits); `exact` reads the four texels and
// interpolates in float. Texel (i,j) is centred at ((i + 1/2)/W, (j + 1/2)/H).
#include "shaders/lib/fold.glsl"

float relievo_height_of(vec4 texel) {
#if height_format == height_format_alpha
  return texel.a;
#elif height_format == height_format_red_green
  return (texel.r * 65280.0 + texel.g * 255.0) / 65535.0;
#else
  return texel.r;
#endif
}

float relievo_height_fetch(ivec2 texel) { return relievo_height_of(texelFetch(relievo_height_map, texel, 0)); }

float relievo_height_texel(ivec2 texel, ivec2 extent) {
  RELIEVO_COUNT_FETCHES(1);
  return relievo_height_fetch(relievo_fold_texel(vec2(texel), vec2(extent)));
}

// The heights at the corners 00, 10, 01, 11 of a cell.
vec4 relievo_height_corners(vec2 cell, vec2 extent) {
  RELIEVO_COUNT_FETCHES(4);
  ivec2 low = relievo_fold_texel(cell, extent), high = relievo_fold_texel(cell + 1.0, extent);
  return vec4(relievo_height_fetch(low), relievo_height_fetch(ivec2(high.x, low.y)),
              relievo_height_fetch(ivec2(low.x, high.y)), relievo_height_fetch(high));
}

float relievo_height_at(vec2 uv) {
#if RELIEVO_FILTER_EXACT
  ivec2 extent = textureSize(relievo_height_map, 0);
  precise vec2 position = clamp(uv * vec2(extent) - 0.5, vec2(-1.0e9), vec2(1.0e9));
  vec2 cell = floor(position);
  precise vec2 f = position - cell;
  vec4 corners = relievo_height_corners(cell, vec2(extent));
  precise vec2 rows = corners.xz + f.x * (corners.yw - corners.xz);
  precise float height = rows.x + f.y * (rows.y - rows.x);
  return height;
#else
  RELIEVO_COUNT_FETCHES(1);
  return relievo_height_of(textureLod(relievo_height_map, uv, 0.0));
#endif
}
