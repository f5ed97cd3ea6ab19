// Root finding along a ray: what the iterative techniques are composed of.
// Survey: linear search §4.3.1, binary search §4.2.2, false position ("secant") §4.2.3.
#include "interval.glsl"

// Two points of the ray around a crossing: `above` has H > h, `below` has H <= h.
struct Bracket {
  float above, below;                      // t
  float above_clearance, below_clearance;  // H - h: > 0 and <= 0
};

float relievo_clearance(vec3 point) {
  precise float clearance = point.z - relievo_height_at(point.xy);
  return clearance;
}

// Starts a search. Returns true when `hit` is decided already: nothing to search, starts inside, or touches at the entry.
// Otherwise clearance > 0 is the clearance at interval.enter.
bool relievo_begin(Ray ray, out Interval interval, out float clearance, out Hit hit) {
  clearance = 0.0;
  if (!relievo_interval(ray, interval)) {
    hit = relievo_beside(ray, interval);
    return true;
  }
  vec3 entry = relievo_entry_point(ray, interval);
  clearance = relievo_clearance(entry);
  hit = Hit(RELIEVO_HIT, interval.enter, entry);
  if (clearance > 0.0) return false;
  if (interval.enter == 0.0 && clearance < 0.0) hit.status = RELIEVO_INSIDE;
  return true;
}

// Survey §4.3.1: equal steps from entry to exit until a point lies below the surface.
// Returns true with the bracket around the crossing found. The end of a ray on the base is below by definition.
bool relievo_linear_search(Ray ray, Interval interval, float clearance, int steps, out Bracket bracket) {
  bracket = Bracket(interval.enter, interval.enter, clearance, 0.0);
  precise float step_length = (interval.exit - interval.enter) / float(steps);
  for (int i = 1; i <= steps; ++i) {
    RELIEVO_COUNT_STEP();
    precise float t = i == steps ? interval.exit : interval.enter + float(i) * step_length;
    float c = relievo_clearance(relievo_point(ray, t));
    if (i == steps && interval.end_status == RELIEVO_HIT) c = min(c, 0.0);
    if (c <= 0.0) {
      bracket.below = t;
      bracket.below_clearance = c;
      return true;
    }
    bracket.above = t;
    bracket.above_clearance = c;
  }
  return false;
}

void relievo_replace(inout Bracket bracket, float t, float clearance) {
  if (clearance <= 0.0) {
    bracket.below = t;
    bracket.below_clearance = clearance;
  } else {
    bracket.above = t;
    bracket.above_clearance = clearance;
  }
}

// Survey §4.2.2: halves the bracket; the result stays a bracket.
void relievo_bisect(Ray ray, int steps, inout Bracket bracket) {
  for (int i = 0; i < steps; ++i) {
    RELIEVO_COUNT_STEP();
    precise float t = 0.5 * (bracket.above + bracket.below);
    relievo_replace(bracket, t, relievo_clearance(relievo_point(ray, t)));
  }
}

// Survey §4.2.3: where the chord between the bracket's ends meets the ray; within the bracket.
float relievo_false_position(Bracket bracket) {
  precise float span = bracket.above_clearance - bracket.below_clearance;
  precise float fraction = span > 0.0 ? bracket.above_clearance / span : 1.0;
  precise float t = bracket.above + (bracket.below - bracket.above) * clamp(fraction, 0.0, 1.0);
  return t;
}

// The whole interval as a bracket; false when the exit lies above the surface. The base is below by definition.
bool relievo_whole_bracket(Ray ray, Interval interval, float clearance, out Bracket bracket) {
  float end = relievo_clearance(relievo_point(ray, interval.exit));
  if (interval.end_status == RELIEVO_HIT) end = min(end, 0.0);
  bracket = Bracket(interval.enter, interval.exit, clearance, end);
  return end <= 0.0;
}

// Repeats the chord intersection `steps` times, each time replacing the end of its side; returns the last intersection.
float relievo_refine_by_chords(Ray ray, int steps, Bracket bracket) {
  float t = relievo_false_position(bracket);
  for (int i = 1; i < steps; ++i) {
    RELIEVO_COUNT_STEP();
    relievo_replace(bracket, t, relievo_clearance(relievo_point(ray, t)));
    t = relievo_false_position(bracket);
  }
  return t;
}
