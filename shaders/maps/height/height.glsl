// Height access. Filter `hardware` asks the texture unit (about 8 fractional bits); `exact` reads the four texels and
// interpolates in float. Texel (i,j) is centred at ((i + 1/2)/W, (j + 1/2)/H).
#include "shaders/lib/fold.glsl"

int relievo_wrap_texel(int i, int extent) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  return relievo_modulo(i, extent);
#elif RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  int r = relievo_modulo(i, 2 * extent);
  return r < extent ? r : 2 * extent - 1 - r;
#else
  return clamp(i, 0, extent - 1);
#endif
}

float relievo_height_texel(ivec2 texel, ivec2 extent) {
  RELIEVO_COUNT_FETCHES(1);
  ivec2 wrapped = ivec2(relievo_wrap_texel(texel.x, extent.x), relievo_wrap_texel(texel.y, extent.y));
  return texelFetch(relievo_height_map, wrapped, 0).r;
}

float relievo_height_at(vec2 uv) {
#if RELIEVO_FILTER_EXACT
  ivec2 extent = textureSize(relievo_height_map, 0);
  precise vec2 position = clamp(uv * vec2(extent) - 0.5, vec2(-1.0e9), vec2(1.0e9));
  vec2 cell = floor(position);
  precise vec2 f = position - cell;
  ivec2 texel = ivec2(cell);
  vec4 corners = vec4(relievo_height_texel(texel, extent), relievo_height_texel(texel + ivec2(1, 0), extent),
                      relievo_height_texel(texel + ivec2(0, 1), extent), relievo_height_texel(texel + ivec2(1, 1), extent));
  precise vec2 rows = corners.xz + f.x * (corners.yw - corners.xz);
  precise float height = rows.x + f.y * (rows.y - rows.x);
  return height;
#else
  RELIEVO_COUNT_FETCHES(1);
  return textureLod(relievo_height_map, uv, 0.0).r;
#endif
}
