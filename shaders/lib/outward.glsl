// The height of a texel next to one of the map, for maps that ask whether the surface rises or falls there. Beyond the edge of a
// mirrored map what rises falls again: it counts as a fall to the base.
float relievo_outward_height(ivec2 texel, ivec2 extent) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, extent))) return 0.0;
#endif
  return relievo_height_texel(texel, extent);
}
