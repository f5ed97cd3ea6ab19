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
float dilation_erosion_leap(Ray ray, DilationBox box) {
  if (!(ray.direction.z < 0.0)) return box.leave;
  precise float down = (box.high - ray.origin.z) / ray.direction.z;
  return min(down, box.leave);
}

// Leaps over empty space from `t` to where the surface may be, with the box there, or to `exit`. A loop of its own: on a GPU
// the neighbours that are there already wait, and then all read heights together.
void dilation_erosion_skip(Ray ray, ivec2 extent, float exit, inout float t, inout int steps, out DilationBox box) {
  box = DilationBox(0.0, 1.0, t);
  while (steps > 0 && t < exit) {
    --steps;
    RELIEVO_COUNT_STEP();
    box = dilation_erosion_box(ray, t, extent);
    if (relievo_point(ray, t).z <= box.high) return;
    float leap = dilation_erosion_leap(ray, box);
    if (!(leap > t)) return;  // rounding: too close to the box to leap
    t = min(leap, exit);
  }
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
  int steps = dilation_erosion_max_steps;
  bool found = false;
  Bracket bracket;
  DilationBox box;
  while (steps > 0 && !found) {
    dilation_erosion_skip(ray, extent, interval.exit, t, steps, box);
    if (t >= interval.exit) return relievo_end_of(ray, interval);
    float next = min(t + step_time, interval.exit);
    float clearance_at_next = dilation_erosion_clearance(relievo_point(ray, next), next, box);
    if (next >= interval.exit && interval.end_status == RELIEVO_HIT) clearance_at_next = min(clearance_at_next, 0.0);
    found = clearance_at_next <= 0.0;
    bracket = Bracket(t, next, 0.0, clearance_at_next);
    t = next;
  }
  if (!found) return relievo_hit_at(ray, RELIEVO_EXHAUSTED, t);
  relievo_bisect(ray, dilation_erosion_binary_steps, bracket);
  return relievo_hit_at(ray, RELIEVO_HIT, bracket.below);
}
