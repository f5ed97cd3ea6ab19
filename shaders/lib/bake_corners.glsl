// The heights at the corners 00, 10, 01, 11 of a cell of the map. The sampler continues the map as its address mode says; the
// four texels meet where it is asked, half a texel from the centre of each, so that no rounding picks others.
vec4 relievo_bake_corners(ivec2 cell) {
  ivec2 extent = textureSize(relievo_height_map, 0);
#if height_format == height_format_red
  return textureGather(relievo_height_map, vec2(cell + 1) / vec2(extent)).wzxy;
#else
  return relievo_height_corners(vec2(cell), vec2(extent));
#endif
}

// A bilinear patch is nowhere above its highest corner.
float relievo_bake_highest_corner(ivec2 cell) {
  vec4 corners = relievo_bake_corners(cell);
  return max(max(corners.x, corners.y), max(corners.z, corners.w));
}
