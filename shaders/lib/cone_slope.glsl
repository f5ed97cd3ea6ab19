// A cone's slope as maps hold it: of slopes up to 1 the square root is stored. Flat ones, which let rays through the furthest,
// are then told apart best.

// Greater than what the square root, its rounding and the square may lose in float.
const float RELIEVO_CONE_MARGIN = 1.0e-6;

float relievo_cone_encode(float slope) {
  return slope > 0.0 ? min(sqrt(slope) * (1.0 + RELIEVO_CONE_MARGIN), 1.0) : 0.0;
}

float relievo_cone_decode(float stored) {
  precise float slope = stored * stored * (1.0 + RELIEVO_CONE_MARGIN);
  return slope;
}
