float relievo_template_slope_at(vec2 uv) { return textureLod(relievo_template_slope_map, uv, 0.0).r; }
