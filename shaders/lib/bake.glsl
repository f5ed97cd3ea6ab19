// Host of a map's bake module: runs relievo_bake once for every texel of the map (of every layer, if it has several; or of every
// RELIEVO_BAKE_LAYERS_AT_ONCE layers, which one run then writes).
// A module defines `void relievo_bake(ivec2 texel)`, reads its input maps and writes with relievo_bake_write, or each of several
// layers with relievo_bake_write_layer. Each phase of its
// passes is a program of its own: drivers compile conditions on a uniform anew for every value that it has.
#include "ray.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140, set = 0, binding = 1) uniform Bake {
  ivec4 relievo_bake_size;    // width, height, channels, level
  ivec4 relievo_bake_source;  // of the level below: width, height, offset; offset of this level, in texels
  ivec4 relievo_bake_layers;  // how many, pass, floats in a buffer, the first of this dispatch
  ivec4 relievo_bake_slab;    // layers of this dispatch
};
#include "bake_buffers.glsl"

ivec2 relievo_bake_extent() { return relievo_bake_size.xy; }

// The layer of this run, or the first of several.
int relievo_bake_layer() {
  return relievo_bake_layers.w + int(gl_GlobalInvocationID.z) * RELIEVO_BAKE_LAYERS_AT_ONCE;
}
int relievo_bake_layer_count() { return relievo_bake_layers.x; }

// Whether a layer is among those of this dispatch: the last run may have fewer than the others.
bool relievo_bake_has_layer(int layer) { return layer < relievo_bake_layers.w + relievo_bake_slab.x; }

// Where a value of this level lies among the layers that are baked together.
int relievo_bake_index(ivec2 texel, int layer, int channel) {
  int row = (layer - relievo_bake_layers.w) * relievo_bake_size.y + texel.y;
  return (relievo_bake_source.w + row * relievo_bake_size.x + texel.x) * relievo_bake_size.z + channel;
}

void relievo_bake_write_layer(ivec2 texel, int layer, int channel, float value) {
  if (relievo_bake_has_layer(layer)) relievo_map_store(relievo_bake_index(texel, layer, channel), value);
}

#if RELIEVO_BAKE_LAYERS_AT_ONCE == 1
void relievo_bake_write(ivec2 texel, int channel, float value) {
  relievo_map_store(relievo_bake_index(texel, relievo_bake_layer(), channel), value);
}
#endif

int relievo_bake_pass() { return relievo_bake_layers.y; }

// What an earlier pass wrote at this level. Other layers than one's own are there unless the map has them apart (map.toml).
float relievo_bake_read(ivec2 texel, int layer, int channel) {
  return relievo_map_load(relievo_bake_index(texel, layer, channel));
}

int relievo_bake_level() { return relievo_bake_size.w; }

// A value of the level below, for levels from 1 on; texels outside it repeat its edge.
float relievo_bake_read_below(ivec2 texel, int channel) {
  ivec2 inside = clamp(texel, ivec2(0), relievo_bake_source.xy - 1);
  int index = (relievo_bake_source.z + inside.y * relievo_bake_source.x + inside.x) * relievo_bake_size.z + channel;
  return relievo_map_load(index);
}

void relievo_bake(ivec2 texel);

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (all(lessThan(texel, relievo_bake_size.xy))) relievo_bake(texel);
}
