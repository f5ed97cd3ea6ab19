// Where the levels of a pyramid lie in a map of `extent` cells and two layers. Layer 0 is level 0. In layer 1, level 1 starts at
// (0, 0), and the coarser ones follow one another along the longer axis beyond it; in a map one cell wide they follow level 1
// itself. The C++ twin is in certify.cpp.

// Nodes of a level: the map is not padded.
ivec2 relievo_packed_size(ivec2 extent, int level) { return ((extent - 1) >> level) + 1; }

// First texel of a level from 1 on, in layer 1.
ivec2 relievo_packed_origin(ivec2 extent, int level) {
  bool wide = extent.x >= extent.y;
  ivec2 along = wide ? ivec2(1, 0) : ivec2(0, 1);
  if (level == 1) return ivec2(0);
  ivec2 first = relievo_packed_size(extent, 1);
  bool strip = min(extent.x, extent.y) == 1;
  ivec2 origin = strip ? first * along : first * (1 - along);
  for (int k = 2; k < level; ++k) origin += relievo_packed_size(extent, k) * along;
  return origin;
}

// The coarsest level that is stored: one node, unless the map is one cell wide and has no room for all.
int relievo_packed_top(ivec2 extent) {
  int top = 0;
  while (top < 15 && relievo_packed_size(extent, top) != ivec2(1)) {
    ivec2 end = relievo_packed_origin(extent, top + 1) + relievo_packed_size(extent, top + 1);
    if (any(greaterThan(end, extent))) break;
    ++top;
  }
  return top;
}
