#include "relievo/job.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace relievo {
namespace {

using testing::HasSubstr;

std::vector<std::byte> bytes(std::size_t count) {
  return std::vector<std::byte>(count, std::byte{7});
}

ShaderCode shader(ShaderStage stage) {
  return {stage, {0x07230203, 0x00010300, 0, 1, 0}, {{"glsl-450", "void main() {}"}}};
}

ShaderProgram compute_program() {
  return {"trace",
          {shader(ShaderStage::compute)},
          {{ResourceKind::storage_buffer, 0, 0, "Rays", 0},
           {ResourceKind::sampled_texture, 1, 2, "height", 0},
           {ResourceKind::storage_texture, 2, 0, "result", 0}},
          {{3, 0x3f800000}}};
}

ShaderProgram draw_program() {
  return {"surface", {shader(ShaderStage::vertex), shader(ShaderStage::fragment)}, {}, {}};
}

Texture texture(std::string name, Format format, int width, int height) {
  Texture result;
  result.name = std::move(name);
  result.format = format;
  result.width = width;
  result.height = height;
  return result;
}

Draw draw() {
  Draw result;
  result.program = 1;
  result.vertex_buffer = 1;
  result.vertex_stride = 16;
  result.attributes = {{0, Format::rgb32_float, 0}, {1, Format::r32_uint, 12}};
  result.count = 3;
  result.color_targets = {2};
  result.depth_target = 3;
  result.clear_color = {{0, 0.5f, 1, 1}};
  result.clear_depth = 1.0f;
  result.cull = CullMode::back;
  return result;
}

TEST(Job, ResourceBytesAreThoseOfAllBuffersAndLevels) {
  Job job;
  job.buffers = {{"a", 10, {}}, {"b", 3, bytes(3)}};
  job.textures = {texture("t", Format::rg8_unorm, 4, 2), texture("u", Format::r32_float, 1, 1)};
  job.textures[0].levels = 3;
  EXPECT_EQ(resource_bytes(job), 10U + 3U + 2 * (8 + 2 + 1) + 4);
  job.textures[1].depth = 5;
  EXPECT_EQ(resource_bytes(job), 10U + 3U + 2 * (8 + 2 + 1) + 20);
}

/// A valid job that uses every field.
Job sample_job() {
  Job job;
  job.name = "sample";
  job.programs = {compute_program(), draw_program()};
  job.buffers = {{"rays", 64, {}}, {"vertices", 48, bytes(48)}};
  Texture height = texture("height", Format::r16_unorm, 5, 3);
  height.levels = 2;
  height.data = {bytes(30), bytes(4)};
  height.sampler = {
      TexelFilter::nearest, TexelFilter::linear, {TexelAddress::mirror, TexelAddress::clamp, TexelAddress::repeat}};
  job.textures = {height, texture("result", Format::r32_float, 8, 8), texture("color", Format::rgba8_unorm, 9, 4),
                  texture("depth", Format::d32_float, 9, 4)};
  job.commands = {Dispatch{0, {{0, 0, 0}, {1, 2, 0}, {2, 0, 1}}, {4, 1, 1}}, draw()};
  job.read_backs = {{ReadBack::Source::buffer, 0, 0}, {ReadBack::Source::texture, 0, 1}};
  return job;
}

Draw& draw_of(Job& job) {
  return std::get<Draw>(job.commands[1]);
}
Dispatch& dispatch_of(Job& job) {
  return std::get<Dispatch>(job.commands[0]);
}

struct Fault {
  const char* id;
  const char* sentence;  ///< a part of it
  std::function<void(Job&)> seed;
};

const Fault faults[] = {
    {"job.program", "has no shaders", [](Job& j) { j.programs[0].shaders.clear(); }},
    {"job.program", "two compute", [](Job& j) { j.programs[0].shaders.push_back(shader(ShaderStage::compute)); }},
    {"job.program", "expected it alone",
     [](Job& j) { j.programs[0].shaders.push_back(shader(ShaderStage::fragment)); }},
    {"job.program", "no code", [](Job& j) { j.programs[0].shaders[0] = {}; }},
    {"job.program", "neither", [](Job& j) { j.programs[1].shaders.erase(j.programs[1].shaders.begin()); }},
    {"job.program", "both or none",
     [](Job& j) { j.programs[1].shaders.push_back(shader(ShaderStage::tessellation_control)); }},
    {"job.slot", "set -1", [](Job& j) { j.programs[0].bindings[0].set = -1; }},
    {"job.slot", "at set 0 binding 0",
     [](Job& j) {
       j.programs[0].bindings.push_back({ResourceKind::uniform_buffer, 0, 0, "Twin", 4});
     }},
    {"job.slot", "OpenGL slot 0",
     [](Job& j) {
       j.programs[0].bindings.push_back({ResourceKind::storage_buffer, 0, 5, "Twin", 0});
     }},
    {"job.constant", "constant 3 has two",
     [](Job& j) {
       j.programs[0].constants.push_back({3, 1});
     }},
    {"job.size", "has 0 bytes", [](Job& j) { j.buffers[0].size = 0; }},
    {"job.size", "expected 64 or none", [](Job& j) { j.buffers[0].data = bytes(63); }},
    {"job.size", "0x3x1 texels", [](Job& j) { j.textures[0].width = 0; }},
    {"job.size", "expected extents of 1..", [](Job& j) { j.textures[0].height = std::numeric_limits<int>::max(); }},
    {"job.size", "expected 1..4", [](Job& j) { j.textures[1].levels = 5; }},
    {"job.size", "is an array with 2 levels", [](Job& j) { j.textures[0].is_array = true; }},
    {"job.size", "is an array with 1 levels", [](Job& j) { j.textures[1].is_array = j.textures[1].is_3d = true; }},
    {"job.size", "data of 1 levels, expected 2", [](Job& j) { j.textures[0].data.pop_back(); }},
    {"job.size", "level 1 holds 3 bytes, expected 4", [](Job& j) { j.textures[0].data[1].pop_back(); }},
    {"job.format", "3D texture of d32_float", [](Job& j) { j.textures[3].is_3d = true; }},
    {"job.format", "3D texture of d32_float", [](Job& j) { j.textures[3].is_array = true; }},
    {"job.index", "runs program 2, the job has 2", [](Job& j) { dispatch_of(j).program = 2; }},
    {"job.program", "expected a compute program", [](Job& j) { dispatch_of(j).program = 1; }},
    {"job.program", "expected a graphics program", [](Job& j) { draw_of(j).program = 0; }},
    {"job.groups", "4x0x1 groups", [](Job& j) { dispatch_of(j).groups[1] = 0; }},
    {"job.groups", "65536x1x1", [](Job& j) { dispatch_of(j).groups[0] = 65536; }},
    {"job.binding", "bound twice",
     [](Job& j) {
       dispatch_of(j).resources.push_back({0, 0, 1});
     }},
    {"job.binding", "\"result\" (set 2 binding 0) is not bound", [](Job& j) { dispatch_of(j).resources.pop_back(); }},
    {"job.binding", "set 7 binding 0, which",
     [](Job& j) {
       dispatch_of(j).resources.push_back({7, 0, 0});
     }},
    {"job.index", "buffer 2, the job has 2", [](Job& j) { dispatch_of(j).resources[0].resource = 2; }},
    {"job.index", "texture -1", [](Job& j) { dispatch_of(j).resources[1].resource = -1; }},
    {"job.format", "no storage format", [](Job& j) { j.textures[1].format = Format::rgb32_float; }},
    {"job.format", "expected nearest",
     [](Job& j) {
       j.textures[1].format = Format::r32_uint;
       dispatch_of(j).resources[1].resource = 1;
     }},
    {"job.count", "draws 4 vertices", [](Job& j) { draw_of(j).count = 4; }},
    {"job.count", "0 instances", [](Job& j) { draw_of(j).instances = 0; }},
    {"job.vertex", "stride is 0", [](Job& j) { draw_of(j).vertex_stride = 0; }},
    {"job.vertex", "expected a 32-bit one", [](Job& j) { draw_of(j).attributes[0].format = Format::rgb8_unorm; }},
    {"job.vertex", "location 16", [](Job& j) { draw_of(j).attributes[0].location = 16; }},
    {"job.vertex", "two vertex attributes", [](Job& j) { draw_of(j).attributes[0].location = 1; }},
    {"job.vertex", "does not fit", [](Job& j) { draw_of(j).attributes[1].offset = 13; }},
    {"job.index", "vertex buffer 9", [](Job& j) { draw_of(j).vertex_buffer = 9; }},
    {"job.size", "reads 6 vertices, buffer \"vertices\" holds 3", [](Job& j) { draw_of(j).count = 6; }},
    {"job.index", "index buffer -2", [](Job& j) { draw_of(j).index_buffer = -2; }},
    {"job.size", "draws 18 indices, buffer \"rays\" holds 16",
     [](Job& j) {
       draw_of(j).index_buffer = 0;
       draw_of(j).count = 18;
     }},
    {"job.size", "reads 117901064 vertices", [](Job& j) { draw_of(j).index_buffer = 1; }},
    {"job.target", "has no target",
     [](Job& j) {
       draw_of(j).color_targets.clear();
       draw_of(j).depth_target = -1;
     }},
    {"job.index", "draws to texture 4", [](Job& j) { draw_of(j).color_targets[0] = 4; }},
    {"job.target", "one texture twice", [](Job& j) { draw_of(j).color_targets.push_back(2); }},
    {"job.target", "format d32_float", [](Job& j) { draw_of(j).color_targets[0] = 3; }},
    {"job.target", "expected d32_float", [](Job& j) { draw_of(j).depth_target = 2; }},
    {"job.target", "expected 9x4", [](Job& j) { j.textures[3].width = 8; }},
    {"job.target", "3D texture", [](Job& j) { j.textures[2].is_3d = true; }},
    {"job.target", "3D texture", [](Job& j) { j.textures[2].is_array = true; }},
    {"job.target", "read and drawn to",
     [](Job& j) {
       j.programs[1].bindings = {{ResourceKind::sampled_texture, 0, 0, "color", 0}};
       draw_of(j).resources = {{0, 0, 2}};
     }},
    {"job.clear", "clears depth to 1.5", [](Job& j) { draw_of(j).clear_depth = 1.5f; }},
    {"job.clear", "clears depth to nan",
     [](Job& j) { draw_of(j).clear_depth = std::numeric_limits<float>::quiet_NaN(); }},
    {"job.clear", "finite", [](Job& j) { (*draw_of(j).clear_color)[2] = std::numeric_limits<float>::infinity(); }},
    {"job.index", "reads buffer 2", [](Job& j) { j.read_backs[0].index = 2; }},
    {"job.index", "reads texture 4", [](Job& j) { j.read_backs[1].index = 4; }},
    {"job.index", "level 2 of texture \"height\", which has 2", [](Job& j) { j.read_backs[1].level = 2; }},
};

TEST(ValidateJob, AcceptsTheSample) {
  const Status status = validate_job(sample_job());
  EXPECT_TRUE(status) << status.error().message;
}

TEST(ValidateJob, AcceptsADrawWithoutVertexBuffer) {
  Job job = sample_job();
  draw_of(job).attributes.clear();
  draw_of(job).vertex_buffer = -1;
  EXPECT_TRUE(validate_job(job));
}

TEST(ValidateJob, NamesEveryFault) {
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.sentence);
    Job job = sample_job();
    fault.seed(job);
    const Status status = validate_job(job);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().id, fault.id) << status.error().message;
    EXPECT_THAT(status.error().message, HasSubstr(fault.sentence));
    EXPECT_THAT(status.error().message, HasSubstr("Job \"sample\""));
  }
}

TEST(ValidateJob, NamesTheCommandAndItsProgram) {
  Job job = sample_job();
  draw_of(job).count = 4;
  EXPECT_THAT(validate_job(job).error().message, HasSubstr("command 1 (draw with \"surface\")"));
}

TEST(Format, SizesFollowChannels) {
  EXPECT_EQ(bytes_per_texel(Format::r8_unorm), 1);
  EXPECT_EQ(bytes_per_texel(Format::rgb8_unorm), 3);
  EXPECT_EQ(bytes_per_texel(Format::rgb16_unorm), 6);
  EXPECT_EQ(bytes_per_texel(Format::rgba16_unorm), 8);
  EXPECT_EQ(bytes_per_texel(Format::rgb32_float), 12);
  EXPECT_EQ(bytes_per_texel(Format::d32_float), 4);
  EXPECT_EQ(channel_count(Format::rg16_unorm), 2);
  EXPECT_EQ(channel_count(Format::r32_uint), 1);
}

TEST(Format, NamesAreThoseOfTheEnumerators) {
  EXPECT_EQ(to_string(Format::r8_unorm), "r8_unorm");
  EXPECT_EQ(to_string(Format::rgba32_float), "rgba32_float");
  EXPECT_EQ(to_string(Format::d32_float), "d32_float");
  EXPECT_EQ(to_string(ShaderStage::tessellation_evaluation), "tessellation_evaluation");
  EXPECT_EQ(to_string(ResourceKind::storage_texture), "storage_texture");
}

TEST(LevelSize, HalvesRoundingDown) {
  Texture volume = texture("volume", Format::rg8_unorm, 5, 3);
  volume.depth = 7;
  EXPECT_EQ(level_size(volume, 0), 5u * 3 * 7 * 2);
  EXPECT_EQ(level_size(volume, 1), 2u * 1 * 3 * 2);
  EXPECT_EQ(level_size(volume, 2), 1u * 1 * 1 * 2);
}

/// One field, as "Struct.field", and a change of it alone; not all leave the job valid.
struct Setter {
  std::string field;
  std::function<void(Job&)> set;
};

const Setter setters[] = {
    {"Job.name", [](Job& j) { j.name = "other"; }},
    {"Job.programs", [](Job& j) { j.programs.push_back(draw_program()); }},
    {"Job.buffers",
     [](Job& j) {
       j.buffers.push_back({"more", 4, {}});
     }},
    {"Job.textures", [](Job& j) { j.textures.push_back(texture("more", Format::r32_uint, 1, 1)); }},
    {"Job.commands", [](Job& j) { j.commands.push_back(j.commands[0]); }},
    {"Job.read_backs", [](Job& j) { j.read_backs.pop_back(); }},
    {"ShaderProgram.name", [](Job& j) { j.programs[0].name = "other"; }},
    {"ShaderProgram.shaders", [](Job& j) { j.programs[1].shaders.pop_back(); }},
    {"ShaderProgram.bindings", [](Job& j) { j.programs[0].bindings.pop_back(); }},
    {"ShaderProgram.constants", [](Job& j) { j.programs[0].constants.clear(); }},
    {"ShaderCode.stage", [](Job& j) { j.programs[1].shaders[1].stage = ShaderStage::geometry; }},
    {"ShaderCode.spirv", [](Job& j) { j.programs[0].shaders[0].spirv[3] = 2; }},
    {"ShaderCode.text", [](Job& j) { j.programs[0].shaders[0].text["essl-310"] = "void main() {}"; }},
    {"BindingSlot.kind", [](Job& j) { j.programs[0].bindings[0].kind = ResourceKind::uniform_buffer; }},
    {"BindingSlot.set", [](Job& j) { j.programs[0].bindings[0].set = 4; }},
    {"BindingSlot.binding", [](Job& j) { j.programs[0].bindings[0].binding = 4; }},
    {"BindingSlot.name", [](Job& j) { j.programs[0].bindings[0].name = "Other"; }},
    {"BindingSlot.gl_slot", [](Job& j) { j.programs[0].bindings[0].gl_slot = 5; }},
    {"BindingSlot.is_filtered", [](Job& j) { j.programs[0].bindings[0].is_filtered = true; }},
    {"SpecializationValue.id", [](Job& j) { j.programs[0].constants[0].id = 4; }},
    {"SpecializationValue.bits", [](Job& j) { j.programs[0].constants[0].bits = 1; }},
    {"Buffer.name", [](Job& j) { j.buffers[0].name = "other"; }},
    {"Buffer.size", [](Job& j) { j.buffers[0].size = 68; }},
    {"Buffer.data", [](Job& j) { j.buffers[1].data[5] = std::byte{8}; }},
    {"Texture.name", [](Job& j) { j.textures[0].name = "other"; }},
    {"Texture.format", [](Job& j) { j.textures[0].format = Format::rg8_unorm; }},
    {"Texture.width", [](Job& j) { j.textures[1].width = 9; }},
    {"Texture.height", [](Job& j) { j.textures[1].height = 9; }},
    {"Texture.depth", [](Job& j) { j.textures[1].depth = 9; }},
    {"Texture.is_3d", [](Job& j) { j.textures[1].is_3d = true; }},
    {"Texture.is_array", [](Job& j) { j.textures[1].is_array = true; }},
    {"Texture.levels", [](Job& j) { j.textures[1].levels = 3; }},
    {"Texture.data", [](Job& j) { j.textures[0].data[1][2] = std::byte{8}; }},
    {"Texture.sampler", [](Job& j) { j.textures[0].sampler = {}; }},
    {"SamplerState.min_mag", [](Job& j) { j.textures[0].sampler.min_mag = TexelFilter::linear; }},
    {"SamplerState.mip", [](Job& j) { j.textures[0].sampler.mip = TexelFilter::nearest; }},
    {"SamplerState.address", [](Job& j) { j.textures[0].sampler.address[2] = TexelAddress::mirror; }},
    {"Dispatch.program", [](Job& j) { dispatch_of(j).program = 1; }},
    {"Dispatch.resources", [](Job& j) { std::swap(dispatch_of(j).resources[0], dispatch_of(j).resources[1]); }},
    {"Dispatch.groups", [](Job& j) { dispatch_of(j).groups[2] = 3; }},
    {"ResourceBinding.set", [](Job& j) { dispatch_of(j).resources[1].set = 6; }},
    {"ResourceBinding.binding", [](Job& j) { dispatch_of(j).resources[1].binding = 6; }},
    {"ResourceBinding.resource", [](Job& j) { dispatch_of(j).resources[0].resource = 1; }},
    {"Draw.program", [](Job& j) { draw_of(j).program = 0; }},
    {"Draw.resources",
     [](Job& j) {
       draw_of(j).resources = {{0, 0, 0}};
     }},
    {"Draw.vertex_buffer", [](Job& j) { draw_of(j).vertex_buffer = 0; }},
    {"Draw.vertex_stride", [](Job& j) { draw_of(j).vertex_stride = 20; }},
    {"Draw.attributes", [](Job& j) { draw_of(j).attributes.pop_back(); }},
    {"Draw.index_buffer", [](Job& j) { draw_of(j).index_buffer = 0; }},
    {"Draw.count", [](Job& j) { draw_of(j).count = 0; }},
    {"Draw.instances", [](Job& j) { draw_of(j).instances = 2; }},
    {"Draw.color_targets", [](Job& j) { draw_of(j).color_targets.clear(); }},
    {"Draw.depth_target", [](Job& j) { draw_of(j).depth_target = -1; }},
    {"Draw.clear_color", [](Job& j) { draw_of(j).clear_color.reset(); }},
    {"Draw.clear_depth", [](Job& j) { draw_of(j).clear_depth = 0.5f; }},
    {"Draw.cull", [](Job& j) { draw_of(j).cull = CullMode::front; }},
    {"VertexAttribute.location", [](Job& j) { draw_of(j).attributes[1].location = 7; }},
    {"VertexAttribute.format", [](Job& j) { draw_of(j).attributes[1].format = Format::r32_float; }},
    {"VertexAttribute.offset", [](Job& j) { draw_of(j).attributes[1].offset = 8; }},
    {"ReadBack.source", [](Job& j) { j.read_backs[1].source = ReadBack::Source::buffer; }},
    {"ReadBack.index", [](Job& j) { j.read_backs[0].index = 1; }},
    {"ReadBack.level", [](Job& j) { j.read_backs[1].level = 0; }},
};

/// Becomes whatever a field is.
struct AnyField {
  template <class T>
  operator T() const;
};

template <class Struct, std::size_t... I>
constexpr bool has_fields(std::index_sequence<I...>) {
  return requires {
    Struct{(static_cast<void>(I), AnyField{})...};
  };
}

template <class Struct, std::size_t Most = 20>
constexpr std::size_t field_count() {
  if constexpr (Most == 0 || has_fields<Struct>(std::make_index_sequence<Most>())) {
    return Most;
  } else {
    return field_count<Struct, Most - 1>();
  }
}

template <class Struct>
void expect_a_setter_for_each_field(const std::string& name) {
  const auto count = std::count_if(std::begin(setters), std::end(setters),
                                   [&](const Setter& setter) { return setter.field.starts_with(name + "."); });
  EXPECT_EQ(static_cast<std::size_t>(count), field_count<Struct>()) << name;
}

TEST(SerializeJob, TheTableOfSettersHasEveryField) {
  expect_a_setter_for_each_field<Job>("Job");
  expect_a_setter_for_each_field<ShaderProgram>("ShaderProgram");
  expect_a_setter_for_each_field<ShaderCode>("ShaderCode");
  expect_a_setter_for_each_field<BindingSlot>("BindingSlot");
  expect_a_setter_for_each_field<SpecializationValue>("SpecializationValue");
  expect_a_setter_for_each_field<Buffer>("Buffer");
  expect_a_setter_for_each_field<Texture>("Texture");
  expect_a_setter_for_each_field<SamplerState>("SamplerState");
  expect_a_setter_for_each_field<Dispatch>("Dispatch");
  expect_a_setter_for_each_field<ResourceBinding>("ResourceBinding");
  expect_a_setter_for_each_field<Draw>("Draw");
  expect_a_setter_for_each_field<VertexAttribute>("VertexAttribute");
  expect_a_setter_for_each_field<ReadBack>("ReadBack");
}

// The writer and the reader share one list of fields: what it lacks is missing from both, and only a change shows it.
TEST(SerializeJob, ShowsAChangeOfAnyField) {
  const std::vector<std::uint8_t> original = serialize_job(sample_job());
  std::size_t valid = 0;
  for (const Setter& setter : setters) {
    SCOPED_TRACE(setter.field);
    Job job = sample_job();
    setter.set(job);
    const std::vector<std::uint8_t> changed = serialize_job(job);
    EXPECT_NE(changed, original);
    const Status status = validate_job(job);
    if (!status) continue;
    ++valid;
    const Result<Job> parsed = parse_job(changed);
    ASSERT_TRUE(parsed) << parsed.error().message;
    EXPECT_EQ(serialize_job(*parsed), changed);
  }
  EXPECT_GT(valid, std::size(setters) / 2) << "too few are read back";
}

// Two jobs are the same when their serialised forms are: the test above shows that those cover every field.
TEST(SerializeJob, RoundTripKeepsEveryField) {
  const Job job = sample_job();
  const Result<Job> parsed = parse_job(serialize_job(job));
  ASSERT_TRUE(parsed) << parsed.error().message;
  EXPECT_EQ(serialize_job(*parsed), serialize_job(job));
  EXPECT_EQ(parsed->programs[0].shaders[0].spirv, job.programs[0].shaders[0].spirv);
  EXPECT_EQ(parsed->programs[0].shaders[0].text, job.programs[0].shaders[0].text);
  EXPECT_EQ(parsed->textures[0].data, job.textures[0].data);
  EXPECT_EQ(parsed->textures[0].sampler.address, job.textures[0].sampler.address);
  EXPECT_EQ(std::get<Draw>(parsed->commands[1]).clear_color, std::get<Draw>(job.commands[1]).clear_color);
}

TEST(ParseJob, RejectsAnInvalidJob) {
  for (const Fault& fault : faults) {
    Job job = sample_job();
    fault.seed(job);
    const Result<Job> parsed = parse_job(serialize_job(job));
    ASSERT_FALSE(parsed) << fault.sentence;
    EXPECT_EQ(parsed.error().id, "job.parse");
  }
}

TEST(ParseJob, RejectsTruncationAtEveryLength) {
  const std::vector<std::uint8_t> whole = serialize_job(sample_job());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const Result<Job> parsed = parse_job({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)});
    ASSERT_FALSE(parsed) << length;
    EXPECT_EQ(parsed.error().id, "job.parse");
  }
}

TEST(ParseJob, RejectsBytesAfterTheEnd) {
  std::vector<std::uint8_t> longer = serialize_job(sample_job());
  longer.push_back(0);
  EXPECT_FALSE(parse_job(longer));
}

TEST(ParseJob, YieldsOnlyValidJobsFromFlippedBytes) {
  const std::vector<std::uint8_t> whole = serialize_job(sample_job());
  int rejected = 0;
  for (std::size_t position = 0; position < whole.size(); ++position) {
    for (const int flip : {0x01, 0x20, 0x80, 0xff}) {
      std::vector<std::uint8_t> flipped = whole;
      flipped[position] = static_cast<std::uint8_t>(flipped[position] ^ flip);
      const Result<Job> parsed = parse_job(flipped);
      rejected += !parsed;
      EXPECT_TRUE(!parsed || validate_job(*parsed));
    }
  }
  EXPECT_GT(rejected, static_cast<int>(whole.size()));
}

TEST(ParseJob, RejectsDeepNesting) {
  EXPECT_FALSE(parse_job(std::vector<std::uint8_t>(10'000'000, 0x81)));
  EXPECT_FALSE(parse_job(std::vector<std::uint8_t>(10'000'000, 0x9f)));
  EXPECT_FALSE(parse_job(std::vector<std::uint8_t>(10'000'000, 0x5f)));
  EXPECT_FALSE(parse_job(std::vector<std::uint8_t>(10'000'000, 0x7f)));
  EXPECT_FALSE(parse_job(std::vector<std::uint8_t>(10'000'000, 0xc0)));
}

TEST(ParseJob, RejectsLengthsBeyondMemory) {
  for (const std::uint8_t kind : {0x9b, 0xbb, 0x5b, 0x7b}) {
    EXPECT_FALSE(parse_job({kind, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff}));
    EXPECT_FALSE(parse_job({kind, 0x00, 0x00, 0x00, 0xff, 0xff, 0xff, 0xff, 0xff}));
  }
}

TEST(ParseJob, RejectsAnotherSchemaVersion) {
  std::vector<std::uint8_t> bytes_of_job = serialize_job(sample_job());
  const std::string key = "relievo_job";
  auto version = std::search(bytes_of_job.begin(), bytes_of_job.end(), key.begin(), key.end()) +
                 static_cast<std::ptrdiff_t>(key.size());
  ASSERT_EQ(*version, 2);
  *version = 3;
  const Result<Job> parsed = parse_job(bytes_of_job);
  ASSERT_FALSE(parsed);
  EXPECT_THAT(parsed.error().message, HasSubstr("schema version"));
}

}  // namespace
}  // namespace relievo
