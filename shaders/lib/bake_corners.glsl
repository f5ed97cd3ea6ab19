// The heights at the corners 00, 10, 01, 11 of a cell of the map.
vec4 relievo_bake_corners(ivec2 cell) {
  return relievo_height_gather(vec2(cell + 1) / vec2(textureSize(relievo_height_map, 0)));
}

// A bilinear patch is nowhere above its highest corner.
float relievo_bake_highest_corner(ivec2 cell) {
  vec4 corners = relievo_bake_corners(cell);
  return max(max(corners.x, corners.y), max(corners.z, corners.w));
}
