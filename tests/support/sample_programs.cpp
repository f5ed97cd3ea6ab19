#include "support/sample_programs.hpp"

namespace relievo::testing {

namespace {

const std::string kHeader = "#version 450\n#extension GL_GOOGLE_cpp_style_line_directive : require\n";

const std::string kParameters = R"(
layout(set = 0, binding = 0, std140) uniform Parameters {
  mat4 relievo_clip_from_world;
  float relief_scale;
  int relief_binary_steps;
} relievo_parameters;
)";

ComposedShader shader(ShaderStage stage, const std::string& text) {
  return {stage, kHeader + text, {"sample.glsl"}};
}

const std::string kVertex = kParameters + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 0) out vec3 world_position;
layout(location = 1) out vec2 world_uv;
layout(location = 2) flat out int instance;
void main() {
  world_position = position * relievo_parameters.relief_scale + float(gl_VertexIndex);
  world_uv = uv;
  instance = gl_InstanceIndex;
  gl_Position = relievo_parameters.relievo_clip_from_world * vec4(position, 1.0);
}
)";

}  // namespace

ComposedProgram make_program(std::vector<ComposedShader> shaders) {
  ComposedProgram program;
  program.key = "sample/view=relief";
  program.stage = "sample";
  program.shaders = std::move(shaders);
  return program;
}

ComposedProgram compute_program(const std::string& text) {
  return make_program({shader(ShaderStage::compute, "layout(local_size_x = 64) in;\n" + text)});
}

ComposedProgram fragment_program(const std::string& text) {
  return make_program({shader(ShaderStage::vertex, kVertex), shader(ShaderStage::fragment, text)});
}

ComposedProgram ray_sample() {
  ComposedProgram program = compute_program(kParameters + R"(
layout(constant_id = 0) const int relief_linear_steps = 16;
layout(constant_id = 1) const float relief_step = 0.25;
struct Ray { vec4 origin; vec4 direction; };
struct Hit { vec4 place; ivec4 cost; };
layout(set = 2, binding = 0, std430) readonly buffer RelievoRays { Ray data[]; } rays;
layout(set = 2, binding = 1, std430) writeonly buffer RelievoHits { Hit data[]; } hits;
layout(set = 1, binding = 0) uniform sampler2D relievo_height_map;
float height(vec2 uv) { return texelFetch(relievo_height_map, ivec2(uv * textureSize(relievo_height_map, 0)), 0).x; }
void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= uint(rays.data.length())) return;
  vec3 place = rays.data[index].origin.xyz;
  int steps = 0;
  for (; steps < relief_linear_steps; ++steps) {
    if (place.z * relievo_parameters.relief_scale <= height(place.xy)) break;
    place += rays.data[index].direction.xyz * relief_step;
  }
  hits.data[index].place = vec4(place, 1.0);
  hits.data[index].cost = ivec4(steps, steps + 1, relievo_parameters.relief_binary_steps, 0);
}
)");
  program.parameters = {{"relief.linear_steps", true, BindingTime::specialization, 40, 0, -1},
                        {"relief.step", false, BindingTime::specialization, 0.125, 1, -1},
                        {"relief.scale", false, BindingTime::uniform, 0.5, -1, 64}};
  program.maps = {{"height", "relievo_height_map", 1, 0}};
  program.parameter_block_size = 80;
  program.features = {"compute", "dynamic_loops"};
  return program;
}

ComposedProgram surface_sample() {
  return fragment_program(kParameters + R"(
layout(location = 1) in vec2 world_uv;
layout(location = 2) flat in int instance;
layout(location = 0) out vec4 color;
layout(set = 1, binding = 0) uniform sampler2D relievo_height_map;
layout(set = 1, binding = 3) uniform sampler3D relievo_distance_map;
void main() {
  vec2 dx = dFdx(world_uv), dy = dFdy(world_uv);
  float sum = 0.0;
  for (int i = 0; i < relievo_parameters.relief_binary_steps; ++i) {
    sum += textureGrad(relievo_height_map, world_uv + float(i), dx, dy).x;
    if (sum > 4.0) break;
    sum += textureLod(relievo_distance_map, vec3(world_uv, sum), 0.0).x;
  }
  color = texture(relievo_height_map, world_uv) + vec4(sum, float(instance), gl_FragCoord.xy);
  gl_FragDepth = clamp(sum, 0.0, 1.0);
}
)");
}

ComposedProgram prism_sample() {
  return make_program({shader(ShaderStage::vertex, kVertex), shader(ShaderStage::geometry, R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 9) out;
layout(location = 0) in vec3 world_position[];
layout(location = 1) in vec2 world_uv[];
layout(location = 2) flat in int instance[];
layout(location = 0) out vec3 entry;
layout(location = 1) flat out ivec2 prism;
void main() {
  for (int face = 0; face < 3; ++face) {
    for (int i = 0; i < 3; ++i) {
      entry = world_position[i] + vec3(world_uv[i], 0.0);
      prism = ivec2(gl_PrimitiveIDIn, instance[i]);
      gl_Position = gl_in[i].gl_Position + vec4(0.0, 0.0, float(face), 0.0);
      EmitVertex();
    }
    EndPrimitive();
  }
}
)"),
                       shader(ShaderStage::fragment, R"(
layout(location = 0) in vec3 entry;
layout(location = 1) flat in ivec2 prism;
layout(location = 0) out vec4 color;
void main() { color = vec4(entry, float(prism.x + prism.y)); }
)")});
}

ComposedProgram tessellation_sample() {
  return make_program({shader(ShaderStage::vertex, kVertex), shader(ShaderStage::tessellation_control, R"(
layout(vertices = 3) out;
layout(location = 0) in vec3 world_position[];
layout(location = 0) out vec3 control_position[];
layout(location = 4) patch out float level;
void main() {
  control_position[gl_InvocationID] = world_position[gl_InvocationID];
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  level = 2.0;
  gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = gl_TessLevelInner[0] = 4.0;
}
)"),
                       shader(ShaderStage::tessellation_evaluation, R"(
layout(triangles, equal_spacing, ccw) in;
layout(location = 0) in vec3 control_position[];
layout(location = 4) patch in float level;
layout(location = 0) out vec3 fine_position;
void main() {
  fine_position = control_position[0] * gl_TessCoord.x + control_position[1] * gl_TessCoord.y + level;
  gl_Position = vec4(fine_position, 1.0);
}
)"),
                       shader(ShaderStage::fragment, R"(
layout(location = 0) in vec3 fine_position;
layout(location = 0) out vec4 color;
void main() { color = vec4(fine_position, 1.0); }
)")});
}

ComposedProgram bake_sample() {
  return compute_program(R"(
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D source_image;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D target_image;
layout(set = 1, binding = 1, std430) buffer Totals { float data[]; } totals;
void main() {
  uint index = gl_GlobalInvocationID.x + gl_NumWorkGroups.x;
  if (index >= uint(totals.data.length())) return;
  vec4 value = imageLoad(source_image, ivec2(index, 0));
  totals.data[index] += value.x;
  imageStore(target_image, ivec2(index, 0), value);
}
)");
}

}  // namespace relievo::testing
