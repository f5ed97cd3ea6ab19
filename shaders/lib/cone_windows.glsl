// The windows by which cones are baked: n cells wide (from the cell itself, along one axis) before a pass, and how much wider
// after it. 2, 3, and from 4 on four sizes an octave, so that no window is more than 5/4 as wide as the one before.
// Pass 0 makes the first windows, the passes 1 to 27 wider ones: 320 in the end.

int relievo_cone_window(int pass) { return pass < 3 ? pass + 1 : (4 + ((pass - 3) & 3)) << ((pass - 3) >> 2); }
int relievo_cone_growth(int pass) { return pass < 3 ? 1 : 1 << ((pass - 3) >> 2); }
