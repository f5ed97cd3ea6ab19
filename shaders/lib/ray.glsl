// Rays and hits in normalized tangent space (u, v, H): H = 0 is the base, H = 1 the lid.
// The C++ twins are relievo::Ray, relievo::Hit and relievo::HitStatus (oracle.hpp); a test compares the values.

const int RELIEVO_MISS = 0;       // left the slab or reached t_max
const int RELIEVO_HIT = 1;        // H(t) <= h(u(t), v(t)) first holds at t
const int RELIEVO_EXHAUSTED = 2;  // the step budget ran out
const int RELIEVO_INSIDE = 3;     // starts below the surface; t = 0
const int RELIEVO_OUTSIDE = 4;    // left the domain of a clip map

const float RELIEVO_NO_LIMIT = 3.402823466e+38;  // t_max of a ray without one

struct Ray {
  vec3 origin;     // (u, v, H) at t = 0
  vec3 direction;  // (du, dv, dH)
  float t_max;
  float n_dot_v;   // |cosine| of the angle between the ray and the base normal, in world space
};

// Which part of the mesh the current ray belongs to: the tetrahedron of a prism, 3 · triangle + index, or 0.
int relievo_cell = 0;

struct Hit {
  int status;
  float t;
  vec3 point;  // (u, v, H) at t; u and v may lack whole tiles where the stage lets them (RELIEVO_HITS_WITHIN_TILE)
};

// Cost of the current invocation: loop iterations and texel reads. Counted by instrumented permutations only.
#if RELIEVO_COUNT
uint relievo_steps = 0u;
uint relievo_fetches = 0u;
#define RELIEVO_COUNT_STEP() (relievo_steps += 1u)
#define RELIEVO_COUNT_FETCHES(n) (relievo_fetches += uint(n))
#else
#define RELIEVO_COUNT_STEP()
#define RELIEVO_COUNT_FETCHES(n)
#endif

// `precise` here and below: what decides between hit and miss must not be contracted or reordered by one compiler and
// not by another.
vec3 relievo_point(Ray ray, float t) {
  precise vec3 point = ray.origin + t * ray.direction;
  return point;
}

Hit relievo_hit_at(Ray ray, int status, float t) { return Hit(status, t, relievo_point(ray, t)); }

// Exponent bits all set: NaN or infinity. A bit test survives compilers that assume neither occurs.
bool relievo_is_finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }
bool relievo_is_finite(vec3 x) { return all(notEqual(floatBitsToUint(x) & 0x7f800000u, uvec3(0x7f800000u))); }
bool relievo_is_finite(vec4 x) { return all(notEqual(floatBitsToUint(x) & 0x7f800000u, uvec4(0x7f800000u))); }

bool relievo_is_nan(vec4 x) { return any(greaterThan(floatBitsToUint(x) & 0x7fffffffu, uvec4(0x7f800000u))); }

// The largest float for an infinite one.
vec4 relievo_within_floats(vec4 x) {
  uvec4 bits = floatBitsToUint(x);
  return uintBitsToFloat((bits & 0x80000000u) | min(bits & 0x7fffffffu, uvec4(0x7f7fffffu)));
}

bool relievo_is_valid(Ray ray) {
  return all(bvec4(relievo_is_finite(ray.origin), relievo_is_finite(vec4(ray.direction, ray.t_max)),
                   ray.direction != vec3(0.0), ray.t_max >= 0.0));
}

// Nothing that is not finite leaves a stage: what floats cannot reach is as far as they reach, and what is no number at all
// becomes a miss at the ray's origin.
Hit relievo_sanitized(Ray ray, Hit hit) {
  vec4 numbers = vec4(hit.point, hit.t);
  if (relievo_is_nan(numbers)) return Hit(RELIEVO_MISS, 0.0, relievo_is_finite(ray.origin) ? ray.origin : vec3(0.0));
  numbers = relievo_within_floats(numbers);
  return Hit(hit.status, numbers.w, numbers.xyz);
}
