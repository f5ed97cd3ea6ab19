// Height access. Filter `hardware` asks the texture unit (about 8 fractional bits); `exact` reads the four texels and
// interpolates in float. Texel (i,j) is centred at ((i + 1/2)/W, (j + 1/2)/H).
#include "shaders/lib/fold.glsl"

float relievo_height_of(vec4 texel) {
#if height_format == height_format_alpha
  return texel.a;
#elif height_format == height_format_red_green
  return min((texel.r * 65280.0 + texel.g * 255.0) / 65535.0, 1.0);  // a quotient may be above 1
#else
  return texel.r;
#endif
}

float relievo_height_fetch(ivec2 texel) { return relievo_height_of(texelFetch(relievo_height_map, texel, 0)); }

float relievo_height_texel(ivec2 texel, ivec2 extent) {
  RELIEVO_COUNT_FETCHES(1);
  return relievo_height_fetch(relievo_fold_texel(vec2(texel), vec2(extent)));
}

// The heights of the four texels that meet at uv, in the order 00, 10, 01, 11, by one fetch. The sampler continues the map as its
// address mode says; asked where texels meet, half a texel from the centre of each, no rounding picks others.
vec4 relievo_height_gather(vec2 uv) {
#if height_format == height_format_alpha
  return textureGather(relievo_height_map, uv, 3).wzxy;
#elif height_format == height_format_red_green
  vec4 high = textureGather(relievo_height_map, uv, 0), low = textureGather(relievo_height_map, uv, 1);
  return min((high * 65280.0 + low * 255.0) / 65535.0, vec4(1.0)).wzxy;
#else
  return textureGather(relievo_height_map, uv).wzxy;
#endif
}

// The heights at the corners 00, 10, 01, 11 of a cell.
#if height_fetch == height_fetch_gather
vec4 relievo_height_corners(vec2 cell, vec2 extent) {
  RELIEVO_COUNT_FETCHES(1);
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT || RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  vec2 near = relievo_fold_to_first_period(cell, extent);
#else
  vec2 near = clamp(cell, vec2(-1.0), extent - 1.0);  // beyond the edge all cells are flat
#endif
  return relievo_height_gather((near + 1.0) / extent);
}
#else
vec4 relievo_height_corners(vec2 cell, vec2 extent) {
  RELIEVO_COUNT_FETCHES(4);
  ivec2 low = relievo_fold_texel(cell, extent), high = relievo_fold_texel(cell + 1.0, extent);
  return vec4(relievo_height_fetch(low), relievo_height_fetch(ivec2(high.x, low.y)),
              relievo_height_fetch(ivec2(low.x, high.y)), relievo_height_fetch(high));
}
#endif

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
