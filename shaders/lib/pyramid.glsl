// Pyramidal displacement mapping (Oh, Ki and Lee 2006; section numbers of the authors' later article), all but where the maxima
// are read: the descent (§2.2), node crossing (§2.3) and linear filtering (§2.4), in t instead of their depth, so that rays may
// also rise. Their leaves are texels; here they are bilinear cells, whose maximum bounds the surface.
#include "search.glsl"
#include "tile_ray.glsl"

struct PyramidDescent {
  Interval interval;
  ivec2 extent;     // cells
  float offset;     // t beyond the border of a node that is crossed, their delta
  float reach;      // t that linear filtering looks ahead and back, half a texel in the paper
  int level, top;
  float t;
};

struct PyramidNode {
  ivec2 index;
  float leave;  // t
};

// Returns true when `hit` is decided already.
bool relievo_descent_begin(Ray ray, int top, float crossing_texels, float filter_texels, out PyramidDescent descent,
                           out Hit hit) {
  float clearance;
  descent.extent = textureSize(relievo_height_map, 0);
  float texel = relievo_texel_time(ray, descent.extent);
  descent.offset = crossing_texels * texel;
  descent.reach = filter_texels * texel;
  descent.level = top;
  descent.top = top;
  bool decided = relievo_begin(ray, descent.interval, clearance, hit);
  descent.t = descent.interval.enter;
  return decided;
}

// The node that the ray is over; a tile ends its nodes.
PyramidNode relievo_descent_node(Ray ray, PyramidDescent descent) {
  TileRay tiled = relievo_tile_ray(ray, descent.t, descent.extent);
  ivec2 node = tiled.cell >> descent.level;
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  vec2 first = vec2(0.0), last = vec2(descent.extent);
#else
  vec2 first = vec2(-0.5), last = vec2(descent.extent) - 0.5;
#endif
  vec2 low = vec2(node << descent.level);
  vec2 high = min(vec2((node + 1) << descent.level), last);
  if (node.x == 0) low.x = first.x;
  if (node.y == 0) low.y = first.y;
  return PyramidNode(node, relievo_tile_leave(tiled, low, high));
}

// §2.4: half a texel ahead of where a leaf may be hit, the interpolated height decides whether the cast goes on from there.
// If not, the surface is taken for a line between the points half a texel before and behind.
bool relievo_descent_filter(Ray ray, inout PyramidDescent descent, out Hit hit) {
  Interval interval = descent.interval;
  float ahead = min(descent.t + descent.reach, interval.exit);
  float above = relievo_clearance(relievo_point(ray, ahead));
  if (ahead >= interval.exit && interval.end_status == RELIEVO_HIT) above = min(above, 0.0);
  hit = relievo_end_of(ray, interval);
  if (above > 0.0) {
    descent.t = ahead;
    descent.level = 0;
    return ahead >= interval.exit;
  }
  float behind = max(descent.t - descent.reach, interval.enter);
  precise float a = abs(relievo_clearance(relievo_point(ray, behind)));
  precise float b = abs(above);
  precise float t = a + b > 0.0 ? behind + (ahead - behind) * (a / (a + b)) : descent.t;
  hit = relievo_hit_at(ray, RELIEVO_HIT, t);
  return true;
}

// One step with the node's maximum `highest`; level -1 is below the leaves: there linear filtering decides. Returns true when the
// ray has come to its end.
bool relievo_descent_step(Ray ray, PyramidNode node, float highest, inout PyramidDescent descent) {
  precise float height = ray.origin.z + descent.t * ray.direction.z;
  if (height > highest) {
    precise float down = (highest - ray.origin.z) / ray.direction.z;  // where the ray falls to the maximum
    float reach = ray.direction.z < 0.0 ? max(down, descent.t) : RELIEVO_NEVER;
    bool crosses = reach >= node.leave;
    descent.t = crosses ? max(node.leave, descent.t) + descent.offset : reach;
    if (descent.t >= descent.interval.exit) return true;
    if (crosses) {
      descent.level = min(descent.level + 1, descent.top);
      return false;
    }
  }
  descent.level -= 1;
  return false;
}
