// A ray within one tile of the height map, in cell coordinates: the point at t is a + t b, cell (i, j) is [i, i+1] × [j, j+1]
// between texel centres, and (0, 0) is the centre of texel 0.
//
// repeat: tiles are cut at the centres of texel 0, so that a tile has W × H whole cells.
// mirror: tiles are cut at the map's edges; every other one runs backwards.
// clamp:  one tile, and beyond it half-infinite ones where the height does not change along the axis.
// clip:   one tile; relievo_interval has cut the ray to it.
#include "address.glsl"
#include "interval.glsl"

struct TileAxis {
  float a, b;   // cell coordinate at t is a + t b
  int tile;
  float leave;  // t where the ray crosses into the next tile
};

const float RELIEVO_NEVER = 3.402823466e+38;

int relievo_tile_of(float coordinate, float direction, float shift) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLIP
  return 0;
#else
  float position = coordinate - shift;
  int tile = int(clamp(floor(position), -1.0e6, 1.0e6));
  if (direction < 0.0 && position == float(tile)) tile -= 1;  // on the border, the tile that is entered
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLAMP
  tile = clamp(tile, -1, 1);
#endif
  return tile;
#endif
}

float relievo_tile_shift(float extent) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  return 0.5 / extent;
#else
  return 0.0;
#endif
}

// The axis of the tile `tile`, for a ray with this coordinate and direction.
TileAxis relievo_tile_axis(float origin, float direction, float extent, int tile) {
  TileAxis axis;
  axis.tile = tile;
  axis.leave = RELIEVO_NEVER;
  float shift = relievo_tile_shift(extent);
  precise float local = origin - float(tile);
  axis.b = direction * extent;
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  if ((tile & 1) != 0) {
    local = 1.0 - local;
    axis.b = -axis.b;
  }
#endif
  precise float a = local * extent - 0.5;
  axis.a = a;
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLAMP
  if (tile != 0) {
    axis.a = tile < 0 ? -0.5 : extent - 0.5;
    axis.b = 0.0;
    bool returns = tile < 0 ? direction > 0.0 : direction < 0.0;
    if (returns) axis.leave = ((tile < 0 ? 0.0 : 1.0) - origin) / direction;
    return axis;
  }
#endif
#if RELIEVO_ADDRESS != RELIEVO_ADDRESS_CLIP
  if (direction != 0.0) {
    precise float border = (float(tile) + shift + (direction > 0.0 ? 1.0 : 0.0) - origin) / direction;
    axis.leave = border;
  }
#endif
  return axis;
}
