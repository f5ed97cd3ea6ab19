// How far, in units of H, nothing is met around a point: less than or equal to the distance to the surface.
#include "shaders/lib/fold.glsl"

// Units of H per texel.
float relievo_distance_field_texel_size(ivec2 extent) {
  precise float longest = float(max(extent.x, extent.y)) * distance_field_scale;
  return 1.0 / longest;
}

// A distance changes by no more than the way between two points, so what is known at a voxel's centre holds, less the way from
// there. Moving up only leads away from a height field: a centre below the point needs nothing taken off for that, and one
// above it sees flat ground as it is. With clamp and clip, the height beyond the outer centres is theirs.
float relievo_distance_field_at(vec3 point) {
  ivec3 size = textureSize(relievo_distance_field_map, 0);
  precise vec2 position = clamp(point.xy * vec2(size.xy) - 0.5, vec2(-1.0e9), vec2(1.0e9));
  precise float layer = clamp(point.z * float(size.z) - 0.5, -1.0, float(size.z - 1));
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLAMP || RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLIP
  position = clamp(position, vec2(0.0), vec2(size.xy - 1));
#endif
  float texel_size = relievo_distance_field_texel_size(size.xy);
  RELIEVO_COUNT_FETCHES(1);
#if RELIEVO_FILTER_EXACT
  vec2 nearest = floor(position + 0.5);
  float above = max(ceil(layer), 0.0);
  ivec3 texel = ivec3(relievo_fold_texel(nearest, vec2(size.xy)), int(above));
  float known = texelFetch(relievo_distance_field_map, texel, 0).r;
  precise vec3 away = vec3((position - nearest) * texel_size, (above - layer) / float(size.z));
  precise float squared = away.x * away.x + away.y * away.y + away.z * away.z;
#else
  // A mean of eight, each less the way from its own centre. The mean way is at most the root of the mean squared one, which
  // along each axis is f (1 - f) of the spacing's square.
  float known = textureLod(relievo_distance_field_map, point, 0.0).r;
  precise vec3 f = vec3(fract(position), layer < 0.0 ? 0.0 : fract(layer));
  precise vec3 spread = f * (1.0 - f);
  precise float below = max(-layer, 0.0) / float(size.z);
  precise float squared = (spread.x + spread.y) * texel_size * texel_size + spread.z / float(size.z * size.z) + below * below;
#endif
  return max(known - sqrt(squared), 0.0);
}
