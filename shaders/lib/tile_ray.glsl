// A ray in the cells of whatever tile it is over, found anew from t: for searches that keep no cell of their own.
#include "tile.glsl"

struct TileRay {
  TileAxis u, v;
  ivec2 extent;  // cells of a tile
  ivec2 cell;    // the one at t; the half cell before texel 0 counts as cell 0
};

TileAxis relievo_tile_axis_at(float origin, float direction, float at, int extent) {
  float size = float(extent);
  int tile = relievo_tile_of(at, direction, relievo_tile_shift(size));
  return relievo_tile_axis(origin, direction, size, tile);
}

TileRay relievo_tile_ray(Ray ray, float t, ivec2 extent) {
  vec3 point = relievo_point(ray, t);
  TileRay tiled;
  tiled.extent = extent;
  tiled.u = relievo_tile_axis_at(ray.origin.x, ray.direction.x, point.x, extent.x);
  tiled.v = relievo_tile_axis_at(ray.origin.y, ray.direction.y, point.y, extent.y);
  precise vec2 position = vec2(tiled.u.a + t * tiled.u.b, tiled.v.a + t * tiled.v.b);
  tiled.cell = ivec2(clamp(floor(position), vec2(0.0), vec2(extent - 1)));
  return tiled;
}

// t where an axis leaves [low, high], in cell coordinates; beyond the edge of a clamp map, where it comes back over it.
float relievo_axis_leave(TileAxis axis, float low, float high) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLAMP
  if (axis.b == 0.0) return axis.leave;
#else
  if (axis.b == 0.0) return RELIEVO_NEVER;
#endif
  precise float t = ((axis.b > 0.0 ? high : low) - axis.a) / axis.b;
  return t;
}

float relievo_tile_leave(TileRay tiled, vec2 low, vec2 high) {
  return min(relievo_axis_leave(tiled.u, low.x, high.x), relievo_axis_leave(tiled.v, low.y, high.y));
}

// The time in which a ray passes one texel of its way over the map.
float relievo_texel_time(Ray ray, ivec2 extent) {
  precise vec2 speed = ray.direction.xy * vec2(extent);
  float size = length(speed);
  return size > 0.0 ? min(1.0 / size, RELIEVO_NEVER) : RELIEVO_NEVER;
}
