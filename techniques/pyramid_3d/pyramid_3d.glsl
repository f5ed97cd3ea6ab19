// Pyramidal displacement mapping on a 3D texture of two layers: no level of detail is chosen when it reads.
#include "shaders/lib/pyramid.glsl"

Hit pyramid_3d_trace(Ray ray) {
  PyramidDescent descent;
  Hit hit;
  if (relievo_descent_begin(ray, relievo_pyramid_3d_top(), pyramid_3d_crossing_offset, descent, hit)) return hit;
  for (int i = 0; i < pyramid_3d_max_steps; ++i) {
    RELIEVO_COUNT_STEP();
    PyramidNode node = relievo_descent_node(ray, descent);
    float highest = relievo_pyramid_3d_at(node.index, descent.level);
    if (relievo_descent_step(ray, node, highest, descent, hit)) return hit;
  }
  return relievo_descent_exhausted(ray, descent);
}
