// Empty space skipping by dilation and erosion maps (Kolb and Rezk-Salama 2005; survey §4.3.2). Around every cell the maps give
// a box: within `radius` cells of it the surface lies between the eroded and the dilated height. Above the box nothing is hit, so
// the ray goes to where it falls into the box or leaves it sideways. Within, it steps and compares heights; below, it has
// crossed the surface without a look at it.
#include "shaders/lib/search.glsl"
#include "shaders/lib/tile_ray.glsl"

struct DilationBox {
  float low, high;  // H
  float leave;      // t where the ray leaves it sideways
};

DilationBox dilation_erosion_box(Ray ray, float t, ivec2 extent) {
  TileRay tiled = relievo_tile_ray(ray, t, extent);
  vec2 heights = relievo_dilation_erosion_at(tiled.cell);
  vec2 first = vec2(tiled.cell - dilation_erosion_radius), last = vec2(tiled.cell + dilation_erosion_radius + 1);
  return DilationBox(heights.x, heights.y, relievo_tile_leave(tiled, first, last));
}

// t up to which nothing is hit, from a t above the box.
float dilation_erosion_skip(Ray ray, DilationBox box) {
  if (!(ray.direction.z < 0.0)) return box.leave;
  precise float down = (box.high - ray.origin.z) / ray.direction.z;
  return min(down, box.leave);
}

// Below the eroded height of a box that holds the point, no height needs to be read.
float dilation_erosion_clearance(vec3 point, float t, DilationBox box) {
  if (point.z < box.low && t <= box.leave) return point.z - box.low;
  return relievo_clearance(point);
}

Hit dilation_erosion_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  if (relievo_begin(ray, interval, clearance, hit)) return hit;
  ivec2 extent = textureSize(relievo_height_map, 0);
  float step_time = dilation_erosion_step * min(relievo_texel_time(ray, extent), RELIEVO_NEVER / 64.0);
  float t = interval.enter;
  for (int i = 0; i < dilation_erosion_max_steps; ++i) {
    RELIEVO_COUNT_STEP();
    DilationBox box = dilation_erosion_box(ray, t, extent);
    vec3 point = relievo_point(ray, t);
    float skip = point.z > box.high ? dilation_erosion_skip(ray, box) : t;
    if (skip > t) {
      t = skip;
      if (t >= interval.exit) return relievo_end_of(ray, interval);
      continue;
    }
    float next = min(t + step_time, interval.exit);
    float next_clearance = dilation_erosion_clearance(relievo_point(ray, next), next, box);
    if (next >= interval.exit && interval.end_status == RELIEVO_HIT) next_clearance = min(next_clearance, 0.0);
    if (next_clearance <= 0.0) {
      Bracket bracket = Bracket(t, next, point.z - box.low, next_clearance);
      relievo_bisect(ray, dilation_erosion_binary_steps, bracket);
      return relievo_hit_at(ray, RELIEVO_HIT, bracket.below);
    }
    t = next;
    if (t >= interval.exit) return relievo_end_of(ray, interval);
  }
  return relievo_hit_at(ray, RELIEVO_EXHAUSTED, t);
}
