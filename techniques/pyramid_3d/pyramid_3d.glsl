// Pyramidal displacement mapping on a 3D texture of two layers: no level of detail is chosen when it reads.
#include "shaders/lib/pyramid.glsl"

Hit pyramid_3d_trace(Ray ray) {
  PyramidDescent descent;
  Hit hit;
  int top = relievo_pyramid_3d_top();
  if (relievo_descent_begin(ray, top, pyramid_3d_crossing_offset, pyramid_3d_filter_reach, descent, hit)) return hit;
  // Two loops, so that on a GPU the neighbours wait for each other before they filter.
  int steps = pyramid_3d_max_steps;
  while (steps > 0) {
    while (steps > 0 && descent.level >= 0) {
      --steps;
      RELIEVO_COUNT_STEP();
      PyramidNode node = relievo_descent_node(ray, descent);
      float highest = relievo_pyramid_3d_at(node.index, descent.level);
      if (relievo_descent_step(ray, node, highest, descent)) return relievo_end_of(ray, descent.interval);
    }
    if (descent.level < 0 && relievo_descent_filter(ray, descent, hit)) return hit;
  }
  return relievo_hit_at(ray, RELIEVO_EXHAUSTED, descent.t);
}
