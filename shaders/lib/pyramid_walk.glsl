// A search outward through the maximum pyramid, for maps that ask "what is nearest, measured against its height?".
//
// Starts at the node of one's own cell in level 0. Done with four siblings, it goes on with those of their parent; a node that
// may matter is descended into, any other is passed over whole. Children are numbered by exclusive or with one's own bits, so
// that those on one's own side come first: the bound is tight early, and no stack is needed.
#include "shaders/lib/bake.glsl"

struct PyramidWalk {
  ivec2 own;  // the cell that the search starts from
  ivec2 at;   // the node, exclusive or own >> level
  int level, top;
};

PyramidWalk relievo_pyramid_walk(ivec2 own) { return PyramidWalk(own, ivec2(0), 0, relievo_max_pyramid_top()); }

ivec2 relievo_walk_node(PyramidWalk walk) { return walk.at ^ (walk.own >> walk.level); }

void relievo_walk_descend(inout PyramidWalk walk) {
  walk.at <<= 1;
  --walk.level;
}

// Passes over the node. Every node comes at most once, so the walk ends: at its top level.
void relievo_walk_pass(inout PyramidWalk walk) {
  int done = findLSB(~(walk.at.x & walk.at.y));  // the last of four siblings, of their parent's four, and so on
  walk.level += done;
  walk.at >>= done;
  walk.at += (walk.at.x & 1) == 0 ? ivec2(1, 0) : ivec2(-1, 1);
}

// First and last texel of a node; padding beyond the map is left out. False when nothing is left.
bool relievo_walk_texels(PyramidWalk walk, ivec2 extent, out ivec2 first, out ivec2 last) {
  first = relievo_walk_node(walk) << walk.level;
  last = min(first + (1 << walk.level), extent) - 1;
  return all(lessThan(first, extent));
}

// Texels, per axis, from a texel to the nearest of [first, last]; through the border where the map repeats. A mirror image or
// an extended edge is never nearer than what it is an image of.
ivec2 relievo_walk_gap(ivec2 texel, ivec2 first, ivec2 last, ivec2 extent) {
  ivec2 gap = max(max(first - texel, texel - last), ivec2(0));
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  gap = min(gap, min(first + extent - texel, texel + extent - last));
#endif
  return gap;
}

// Texels, per axis, within which a node's greatest height certainly is found: its cells reach one texel beyond `last`.
ivec2 relievo_walk_span(ivec2 texel, ivec2 first, ivec2 last) { return max(abs(texel - first), abs(last + 1 - texel)); }

float relievo_walk_squared(ivec2 gap) {
  precise vec2 squares = vec2(gap) * vec2(gap);
  precise float sum = squares.x + squares.y;
  return sum;
}
