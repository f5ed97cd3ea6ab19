// What the bakes of classic and relaxed cones share. The cone on a texel is as wide as the others allow, the least of
// |x_j - x_i| / (h_j - h_i) over those j that count. It is squared while it is looked for, in texels per unit of H; what is stored is in
// longer sides of the map per unit of H, at most 1, and as its square root, which keeps steep cones apart in 8 bits.
#include "pyramid_walk.glsl"

// The least does not depend on the order in which texels are met, for each is compared by the same quotient. A node that is no
// narrower than this times the least may be passed over: more than what rounding can do to either.
const float RELIEVO_CONE_TIE = 1.000001;

// Least square of a rise that is divided by: a smaller one may become a zero of either sign. Texels are 1 apart at least, so
// that the cone is wider than any even then.
const float RELIEVO_CONE_FLAT = 1.0e-30;

// The widest cone whose border is nowhere above a point this far away and so much higher.
float relievo_cone_to(float squared, float rise, float widest) {
  precise float ratio = squared / max(rise * rise, RELIEVO_CONE_FLAT);
  return rise > 0.0 ? min(ratio, widest) : widest;
}

// Whether something of a node may be narrower: it is no nearer than this and rises no more.
bool relievo_cone_may_narrow(float squared, float rise, float narrowest) {
  precise float reach = RELIEVO_CONE_TIE * narrowest * rise * rise;
  return rise > 0.0 && squared < reach;
}

float relievo_cone_widest(ivec2 extent) {
  float longest = float(max(extent.x, extent.y));
  return longest * longest;
}

// A cone may only be too narrow. In ulp, 2^-23, as Vulkan allows them: 2 of the ratio and 7 of its root, 3 of the quotient; then 7
// of the root.
float relievo_cone_stored(float narrowest, ivec2 extent) {
  precise float ratio = sqrt(narrowest) / float(max(extent.x, extent.y)) * 0.9999985;
  precise float stored = sqrt(ratio) * 0.999999;
  return stored;
}
