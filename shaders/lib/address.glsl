// Address modes of the height map; RELIEVO_ADDRESS is an axis of the permutation.

// The whole tiles that a texture coordinate can shed without changing what it reads: keeps rays near 0, where float is dense.
vec2 relievo_tile(vec2 uv) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  return floor(uv);
#elif RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  return 2.0 * floor(0.5 * uv);
#else
  return vec2(0.0);
#endif
}
