// Stepping through empty cones: what classic and relaxed cones have in common.
#include "search.glsl"

// A ray's way over the map: lengths are in longer sides of the map, texels being square.
struct ConeMarch {
  float speed;          // sideways per t
  float minimum_step;   // in t
};

ConeMarch relievo_cone_march(Ray ray, float minimum_texels) {
  vec2 extent = vec2(textureSize(relievo_height_map, 0));
  vec2 way = ray.direction.xy * extent;
  float largest = max(abs(way.x), abs(way.y));
  precise vec2 scaled = largest > 0.0 ? way / largest : vec2(0.0);
  precise float texels = largest * sqrt(scaled.x * scaled.x + scaled.y * scaled.y);
  return ConeMarch(texels / max(extent.x, extent.y), texels > 0.0 ? minimum_texels / texels : 0.0);
}

// Survey §4.3.5: t from a point this high above a cone's tip to the cone's border; RELIEVO_NO_LIMIT where the ray stays within.
float relievo_cone_step(ConeMarch march, Ray ray, float ratio, float clearance) {
  precise float closing = march.speed - ratio * ray.direction.z;
  precise float reach = ratio * clearance;
  return closing > 0.0 && reach < closing * RELIEVO_NO_LIMIT ? max(reach / closing, march.minimum_step) : RELIEVO_NO_LIMIT;
}

// Moves on by `advance` and looks where the ray is then. Returns true when the bracket is closed: it has passed the surface.
bool relievo_march_by(Ray ray, Interval interval, float advance, inout Bracket bracket) {
  precise float t = min(bracket.above + advance, interval.exit);
  float clearance = relievo_clearance(relievo_point(ray, t));
  if (t >= interval.exit && interval.end_status == RELIEVO_HIT) clearance = min(clearance, 0.0);
  relievo_replace(bracket, t, clearance);
  return clearance <= 0.0;
}

// A vertical ray meets the height below it: there is nothing to search.
Hit relievo_vertical_hit(Ray ray, Interval interval, float clearance) {
  precise float t = interval.enter + (ray.direction.z < 0.0 ? clearance / -ray.direction.z : RELIEVO_NO_LIMIT);
  return t <= interval.exit ? relievo_hit_at(ray, RELIEVO_HIT, t) : relievo_end_of(ray, interval);
}
