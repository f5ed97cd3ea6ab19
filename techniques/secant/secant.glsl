// The true secant method (suggested in survey §4.2.3): the line through the last two guesses meets the ray, wherever they
// lie. It converges faster than false position, which holds on to one end, but nothing keeps it near the crossing. So the
// bracket is kept beside it, and halved when the line leads out of it or to a point farther from the surface than both guesses.
#include "shaders/lib/search.glsl"

struct SecantGuesses {
  float before, last;                      // t
  float before_clearance, last_clearance;  // H - h
};

SecantGuesses secant_ends(Bracket bracket) {
  return SecantGuesses(bracket.above, bracket.below, bracket.above_clearance, bracket.below_clearance);
}

// Where the line through both guesses meets the ray, as `t`. False if it does not, or outside the bracket.
bool secant_meets(SecantGuesses guesses, Bracket bracket, out float t) {
  precise float rise = guesses.last_clearance - guesses.before_clearance;
  t = guesses.last;
  if (guesses.last_clearance == 0.0) return true;
  if (rise == 0.0) return false;
  precise float next = guesses.last - guesses.last_clearance * ((guesses.last - guesses.before) / rise);
  t = next;
  return next >= bracket.above && next <= bracket.below;
}

bool secant_diverges(SecantGuesses guesses, float clearance) {
  return abs(clearance) > max(abs(guesses.before_clearance), abs(guesses.last_clearance));
}

// t of the crossing after `steps` guesses, of which the last is not looked at. False if it gives up.
bool secant_refine(Ray ray, Bracket bracket, int steps, out float t) {
  SecantGuesses guesses = secant_ends(bracket);
  bool diverged = false;
  for (int i = 1; i <= steps; ++i) {
    bool trusted = secant_meets(guesses, bracket, t) && !diverged;
    if (!trusted) {
      if (secant_fallback == 0) return false;
      t = i < steps ? 0.5 * (bracket.above + bracket.below) : relievo_false_position(bracket);
    }
    if (i == steps || guesses.last_clearance == 0.0) return true;
    RELIEVO_COUNT_STEP();
    float clearance = relievo_clearance(relievo_point(ray, t));
    diverged = trusted && secant_diverges(guesses, clearance);
    relievo_replace(bracket, t, clearance);
    guesses = trusted ? SecantGuesses(guesses.last, t, guesses.last_clearance, clearance) : secant_ends(bracket);
  }
  return true;
}

Hit secant_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  if (relievo_begin(ray, interval, clearance, hit)) return hit;
  Bracket bracket;
  if (!relievo_linear_search(ray, interval, clearance, secant_linear_steps, bracket)) return relievo_end_of(ray, interval);
  float t;
  bool found = secant_refine(ray, bracket, secant_steps, t);
  return relievo_hit_at(ray, found ? RELIEVO_HIT : RELIEVO_EXHAUSTED, t);
}
