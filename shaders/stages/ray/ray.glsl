// Traces a set of rays. Rays and hits are stored a component after the other, each for all rays: component k of ray i is
// word or vec4 k · stride + i of a buffer, or texel i of layer k of an image, row by row. The twin in C++ is job/trace_job.cpp.
#include "shaders/lib/ray.glsl"

layout(local_size_x = 64) in;

layout(std140, set = 0, binding = 1) uniform Batch {
  uvec4 ray_count;  // rays, stride
};

// Components of a ray: (u, v, H, t_max), (du, dv, dH, unused).
#if ray_storage == ray_storage_image
layout(set = 0, binding = 2, rgba32f) readonly uniform highp image2DArray Rays;
layout(set = 0, binding = 3, r32ui) writeonly uniform highp uimage2DArray Hits;
#else
layout(std430, set = 0, binding = 2) readonly buffer Rays { vec4 rays[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Hits { uint hits[]; };
#endif

// Components of a hit, floats as their bits. u and v may lack whole tiles: those are to be added that bring them nearest to
// the ray's point at t.
const int RAY_STATUS = 0, RAY_T = 1, RAY_U = 2, RAY_V = 3, RAY_H = 4;
const int RAY_STEPS = 5, RAY_FETCHES = 6, RAY_SANITIZED = 7;  // only where costs are counted

uint ray_index() { return gl_GlobalInvocationID.y * (gl_NumWorkGroups.x * gl_WorkGroupSize.x) + gl_GlobalInvocationID.x; }

vec4 ray_read(int component) {
#if ray_storage == ray_storage_image
  return imageLoad(Rays, ivec3(gl_GlobalInvocationID.xy, component));
#else
  return rays[uint(component) * ray_count.y + ray_index()];
#endif
}

void ray_write(int component, uint value) {
#if ray_storage == ray_storage_image
  imageStore(Hits, ivec3(gl_GlobalInvocationID.xy, component), uvec4(value));
#else
  hits[uint(component) * ray_count.y + ray_index()] = value;
#endif
}

float ray_n_dot_v(vec3 direction) {
  precise float rise = abs(direction.z) * ray_scale;
  float longest = max(max(abs(direction.x), abs(direction.y)), rise);
  if (!(longest > 0.0)) return 1.0;
  precise vec3 metric = vec3(direction.xy, rise) / longest;
  precise float size = sqrt(metric.x * metric.x + metric.y * metric.y + metric.z * metric.z);
  return metric.z / size;
}

// A driver may take a denormal for 0 in one operation and not in the next.
vec3 ray_without_denormals(vec3 direction) {
  return mix(direction, vec3(0.0), lessThan(floatBitsToUint(direction) & 0x7fffffffu, uvec3(0x00800000u)));
}

void main() {
  if (ray_index() >= ray_count.x) return;
  vec4 origin_limit = ray_read(0);
  vec3 direction = ray_without_denormals(ray_read(1).xyz);
  Ray ray = Ray(origin_limit.xyz, direction, origin_limit.w, ray_n_dot_v(direction));
  Hit hit = Hit(RELIEVO_MISS, 0.0, ray.origin);
  bool is_valid = relievo_is_valid(ray);
  if (is_valid) hit = relievo_view_trace(ray);
  bool is_sanitized = is_valid && relievo_is_nan(vec4(hit.point, hit.t));
  hit = relievo_sanitized(ray, hit);
  ray_write(RAY_STATUS, uint(hit.status));
  ray_write(RAY_T, floatBitsToUint(hit.t));
  ray_write(RAY_U, floatBitsToUint(hit.point.x));
  ray_write(RAY_V, floatBitsToUint(hit.point.y));
  ray_write(RAY_H, floatBitsToUint(hit.point.z));
#if RELIEVO_COUNT
  ray_write(RAY_STEPS, relievo_steps);
  ray_write(RAY_FETCHES, relievo_fetches);
  ray_write(RAY_SANITIZED, uint(is_sanitized));
#endif
}
