// The texels that a bake writes, in as many buffers as the backend's limit asks for (RELIEVO_BAKE_BUFFERS): all but the last
// hold relievo_bake_layers.z floats.
layout(std430, set = 0, binding = 2) buffer MapTexels { float relievo_map_texels[]; };
#if RELIEVO_BAKE_BUFFERS > 1
layout(std430, set = 0, binding = 3) buffer MapTexels1 { float relievo_map_texels_1[]; };
#endif
#if RELIEVO_BAKE_BUFFERS > 2
layout(std430, set = 0, binding = 4) buffer MapTexels2 { float relievo_map_texels_2[]; };
#endif
#if RELIEVO_BAKE_BUFFERS > 3
layout(std430, set = 0, binding = 5) buffer MapTexels3 { float relievo_map_texels_3[]; };
#endif
#if RELIEVO_BAKE_BUFFERS > 4
layout(std430, set = 0, binding = 6) buffer MapTexels4 { float relievo_map_texels_4[]; };
#endif
#if RELIEVO_BAKE_BUFFERS > 5
layout(std430, set = 0, binding = 7) buffer MapTexels5 { float relievo_map_texels_5[]; };
#endif
#if RELIEVO_BAKE_BUFFERS > 6
layout(std430, set = 0, binding = 8) buffer MapTexels6 { float relievo_map_texels_6[]; };
#endif
#if RELIEVO_BAKE_BUFFERS > 7
layout(std430, set = 0, binding = 9) buffer MapTexels7 { float relievo_map_texels_7[]; };
#endif

// The buffer that holds a value, and its index there. Without a division, which is slow where it is emulated.
int relievo_map_part(inout int index) {
  int part = 0;
  for (int k = 1; k < RELIEVO_BAKE_BUFFERS; ++k) {
    bool beyond = index >= relievo_bake_layers.z;
    index -= beyond ? relievo_bake_layers.z : 0;
    part += beyond ? 1 : 0;
  }
  return part;
}

float relievo_map_load(int index) {
#if RELIEVO_BAKE_BUFFERS > 1
  int part = relievo_map_part(index);
  if (part == 1) return relievo_map_texels_1[index];
#if RELIEVO_BAKE_BUFFERS > 2
  if (part == 2) return relievo_map_texels_2[index];
#endif
#if RELIEVO_BAKE_BUFFERS > 3
  if (part == 3) return relievo_map_texels_3[index];
#endif
#if RELIEVO_BAKE_BUFFERS > 4
  if (part == 4) return relievo_map_texels_4[index];
#endif
#if RELIEVO_BAKE_BUFFERS > 5
  if (part == 5) return relievo_map_texels_5[index];
#endif
#if RELIEVO_BAKE_BUFFERS > 6
  if (part == 6) return relievo_map_texels_6[index];
#endif
#if RELIEVO_BAKE_BUFFERS > 7
  if (part == 7) return relievo_map_texels_7[index];
#endif
#endif
  return relievo_map_texels[index];
}

void relievo_map_store(int index, float value) {
#if RELIEVO_BAKE_BUFFERS > 1
  int part = relievo_map_part(index);
  if (part == 1) {
    relievo_map_texels_1[index] = value;
    return;
  }
#if RELIEVO_BAKE_BUFFERS > 2
  if (part == 2) {
    relievo_map_texels_2[index] = value;
    return;
  }
#endif
#if RELIEVO_BAKE_BUFFERS > 3
  if (part == 3) {
    relievo_map_texels_3[index] = value;
    return;
  }
#endif
#if RELIEVO_BAKE_BUFFERS > 4
  if (part == 4) {
    relievo_map_texels_4[index] = value;
    return;
  }
#endif
#if RELIEVO_BAKE_BUFFERS > 5
  if (part == 5) {
    relievo_map_texels_5[index] = value;
    return;
  }
#endif
#if RELIEVO_BAKE_BUFFERS > 6
  if (part == 6) {
    relievo_map_texels_6[index] = value;
    return;
  }
#endif
#if RELIEVO_BAKE_BUFFERS > 7
  if (part == 7) {
    relievo_map_texels_7[index] = value;
    return;
  }
#endif
#endif
  relievo_map_texels[index] = value;
}
