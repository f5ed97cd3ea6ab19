// Traces a buffer of rays. The twins in C++ are PackedRay and PackedHit (job/trace_job.cpp).
#include "shaders/lib/ray.glsl"

layout(local_size_x = 64) in;

struct PackedRay {
  vec4 origin_limit;  // u, v, H, t_max
  vec4 direction;     // du, dv, dH, unused
};

struct PackedHit {  // what is not written is zero
  int status;
  float t, u, v, h;
  uint steps, fetches, unused;
};

layout(std140, set = 0, binding = 1) uniform Batch {
  uvec4 ray_count;  // x
};
layout(std430, set = 0, binding = 2) readonly buffer Rays { PackedRay rays[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Hits { PackedHit hits[]; };

float ray_n_dot_v(vec3 direction) {
  precise float rise = abs(direction.z) * ray_scale;
  float longest = max(max(abs(direction.x), abs(direction.y)), rise);
  if (!(longest > 0.0)) return 1.0;
  precise vec3 metric = vec3(direction.xy, rise) / longest;
  precise float size = sqrt(metric.x * metric.x + metric.y * metric.y + metric.z * metric.z);
  return metric.z / size;
}

void main() {
  uint index = gl_GlobalInvocationID.y * (gl_NumWorkGroups.x * gl_WorkGroupSize.x) + gl_GlobalInvocationID.x;
  if (index >= ray_count.x) return;
  vec4 origin_limit = rays[index].origin_limit;
  vec3 direction = rays[index].direction.xyz;
  Ray ray = Ray(origin_limit.xyz, direction, origin_limit.w, ray_n_dot_v(direction));
  Hit hit = Hit(RELIEVO_MISS, 0.0, ray.origin);
  if (relievo_is_valid(ray)) hit = relievo_view_trace(ray);
  hit = relievo_sanitized(ray, hit);
  hits[index].status = hit.status;
  hits[index].t = hit.t;
  hits[index].u = hit.point.x;
  hits[index].v = hit.point.y;
  hits[index].h = hit.point.z;
#if RELIEVO_COUNT
  hits[index].steps = relievo_steps;
  hits[index].fetches = relievo_fetches;
#endif
}
