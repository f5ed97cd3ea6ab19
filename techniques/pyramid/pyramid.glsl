// Pyramidal displacement mapping on the mip chain of max_pyramid.
#include "shaders/lib/pyramid.glsl"

Hit pyramid_trace(Ray ray) {
  PyramidDescent descent;
  Hit hit;
  if (relievo_descent_begin(ray, relievo_max_pyramid_top(), pyramid_crossing_offset, descent, hit)) return hit;
  for (int i = 0; i < pyramid_max_steps; ++i) {
    RELIEVO_COUNT_STEP();
    PyramidNode node = relievo_descent_node(ray, descent);
    float highest = relievo_max_pyramid_at(node.index, descent.level);
    if (relievo_descent_step(ray, node, highest, descent, hit)) return hit;
  }
  return relievo_descent_exhausted(ray, descent);
}
