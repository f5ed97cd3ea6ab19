// Sectors of the directions in which a ray can head, in cells: four quadrants of equal slices. With 4 sectors a quadrant is
// one slice; with 8 k sectors it is 2 k slices, k where |x| >= |y| and k where |y| > |x|, cut at equal ratios of the lesser to
// the greater. A slice is the same in every quadrant but for the signs, so that where a map runs backwards only the quadrant
// changes.
#include "fold.glsl"

int relievo_sector_slices(int sectors) { return sectors < 8 ? 1 : sectors / 8 * 2; }

int relievo_sector_slice(vec2 direction, int sectors) {
  if (sectors < 8) return 0;
  int cuts = sectors / 8;
  vec2 size = abs(direction);
  float greater = max(size.x, size.y);
  float ratio = greater > 1.0e-30 ? min(size.x, size.y) / greater : 0.0;  // finite, for the integer's sake
  return (size.y > size.x ? cuts : 0) + min(int(ratio * float(cuts)), cuts - 1);
}

// The layer of a map that a sector is, and back.
int relievo_sector_layer(vec2 heading, int slice) { return relievo_quadrant(heading) + 4 * slice; }
ivec2 relievo_sector_heading(int layer) { return relievo_heading(layer & 3); }
int relievo_sector_slice_of(int layer, int sectors) { return (layer >> 2) % relievo_sector_slices(sectors); }
