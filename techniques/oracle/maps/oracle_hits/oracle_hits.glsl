// (status, t, cell) of a pixel.
vec3 relievo_oracle_hits_at(ivec2 pixel) { return texelFetch(relievo_oracle_hits_map, pixel, 0).rgb; }
