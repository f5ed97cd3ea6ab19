// (status, t) of a pixel.
vec2 relievo_oracle_hits_at(ivec2 pixel) { return texelFetch(relievo_oracle_hits_map, pixel, 0).rg; }
