// The one colour output of a fragment stage: the picture, or an arbitrary output variable instead.
#include "shade.glsl"

layout(location = 0) out vec4 out_color;

void relievo_write(Ray ray, Hit hit, vec3 position, vec3 normal) {
#if RELIEVO_AOV == RELIEVO_AOV_COLOR
  out_color = vec4(relievo_shade(position, normal), 1.0);
#elif RELIEVO_AOV == RELIEVO_AOV_DEPTH
  out_color = vec4(vec3(relievo_depth(position)), 1.0);
#elif RELIEVO_AOV == RELIEVO_AOV_NORMAL
  out_color = vec4(normal, 1.0);
#elif RELIEVO_AOV == RELIEVO_AOV_UV
  out_color = vec4(hit.point, 1.0);
#elif RELIEVO_AOV == RELIEVO_AOV_STEPS
  out_color = vec4(float(relievo_steps), float(relievo_fetches), 0.0, 1.0);
#elif RELIEVO_AOV == RELIEVO_AOV_STATUS
  out_color = vec4(float(hit.status), 0.0, 0.0, 1.0);
#elif RELIEVO_AOV == RELIEVO_AOV_RAY_ORIGIN
  out_color = vec4(ray.origin, 1.0);
#else
  out_color = vec4(ray.direction, ray.t_max);
#endif
}
