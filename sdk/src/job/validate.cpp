#include "job/validate.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <utility>

namespace relievo {

namespace {

// Far above what drivers take, and low enough that no size computed from it overflows.
constexpr int max_extent = 1 << 16;
constexpr std::size_t max_bytes = std::size_t{1} << 32;
constexpr int max_set = 31, max_binding = 1 << 16;

void check_stages(Check& check, const ShaderProgram& program) {
  std::set<ShaderStage> stages;
  for (const ShaderCode& shader : program.shaders) {
    const std::string_view stage = to_string(shader.stage);
    check.require(stages.insert(shader.stage).second, "job.program", "has two {} shaders, expected one a stage", stage);
    check.require(!shader.spirv.empty() || !shader.text.empty(), "job.program", "its {} shader has no code", stage);
  }
  if (stages.contains(ShaderStage::compute)) {
    check.require(stages.size() == 1, "job.program", "has a compute shader beside others, expected it alone");
    return;
  }
  check.require(stages.contains(ShaderStage::vertex), "job.program", "has neither a compute nor a vertex shader");
  check.require(
      stages.contains(ShaderStage::tessellation_control) == stages.contains(ShaderStage::tessellation_evaluation),
      "job.program", "has one tessellation shader, expected both or none");
}

void check_slots(Check& check, const ShaderProgram& program) {
  std::set<std::pair<int, int>> places;
  std::set<std::pair<ResourceKind, int>> gl_slots;
  for (const BindingSlot& slot : program.bindings) {
    check.require(slot.set >= 0 && slot.set <= max_set && slot.binding >= 0 && slot.binding <= max_binding, "job.slot",
                  "slot \"{}\" is at set {} binding {}, expected a set of 0..{} and a binding of 0..{}", slot.name,
                  slot.set, slot.binding, max_set, max_binding);
    check.require(places.emplace(slot.set, slot.binding).second, "job.slot", "two slots are at set {} binding {}",
                  slot.set, slot.binding);
    check.require(slot.gl_slot >= 0, "job.slot", "slot \"{}\" has OpenGL slot {}, expected at least 0", slot.name,
                  slot.gl_slot);
    check.require(gl_slots.emplace(slot.kind, slot.gl_slot).second, "job.slot", "two {} slots have OpenGL slot {}",
                  to_string(slot.kind), slot.gl_slot);
  }
}

void check_constants(Check& check, const ShaderProgram& program) {
  std::set<std::uint32_t> ids;
  for (const SpecializationValue& constant : program.constants) {
    check.require(ids.insert(constant.id).second, "job.constant", "specialization constant {} has two values",
                  constant.id);
  }
}

void check_contents(Check& check, const Texture& texture) {
  if (texture.data.empty()) return;
  if (!check.require(texture.data.size() == static_cast<std::size_t>(texture.levels), "job.size",
                     "holds data of {} levels, expected {} or none", texture.data.size(), texture.levels)) {
    return;
  }
  for (int level = 0; level < texture.levels; ++level) {
    const std::size_t given = texture.data[static_cast<std::size_t>(level)].size();
    check.require(given == level_size(texture, level), "job.size", "level {} holds {} bytes, expected {}", level, given,
                  level_size(texture, level));
  }
}

void check_read_back(Check& check, const Job& job, const ReadBack& read_back) {
  if (read_back.source == ReadBack::Source::buffer) {
    check.require(in_range(read_back.index, job.buffers), "job.index", "reads buffer {}, the job has {}",
                  read_back.index, job.buffers.size());
    return;
  }
  if (!check.require(in_range(read_back.index, job.textures), "job.index", "reads texture {}, the job has {}",
                     read_back.index, job.textures.size())) {
    return;
  }
  const Texture& texture = job.textures[static_cast<std::size_t>(read_back.index)];
  check.require(read_back.level >= 0 && read_back.level < texture.levels, "job.index",
                "reads level {} of texture \"{}\", which has {}", read_back.level, texture.name, texture.levels);
}

std::string command_context(const Job& job, const Command& command, std::size_t index) {
  const char* verb = std::holds_alternative<Dispatch>(command) ? "dispatch" : "draw";
  const int program = std::visit([](const auto& c) { return c.program; }, command);
  if (!in_range(program, job.programs)) return fmt::format("command {} ({})", index, verb);
  return fmt::format("command {} ({} with \"{}\")", index, verb, job.programs[static_cast<std::size_t>(program)].name);
}

}  // namespace

void check_program(Check& check, const ShaderProgram& program) {
  if (!check.require(!program.shaders.empty(), "job.program", "has no shaders")) return;
  check_stages(check, program);
  check_slots(check, program);
  check_constants(check, program);
}

void check_buffer(Check& check, const Buffer& buffer) {
  check.require(buffer.size >= 1 && buffer.size <= max_bytes, "job.size", "has {} bytes, expected 1..{}", buffer.size,
                max_bytes);
  check.require(buffer.data.empty() || buffer.data.size() == buffer.size, "job.size",
                "holds {} bytes of data, expected {} or none", buffer.data.size(), buffer.size);
}

void check_texture(Check& check, const Texture& texture) {
  const int extents[] = {texture.width, texture.height, texture.depth};
  const auto [smallest, largest] = std::minmax_element(std::begin(extents), std::end(extents));
  if (!check.require(*smallest >= 1 && *largest <= max_extent, "job.size",
                     "is {}x{}x{} texels, expected extents of 1..{}", texture.width, texture.height, texture.depth,
                     max_extent)) {
    return;
  }
  const int full_chain = std::bit_width(static_cast<unsigned>(*largest));
  if (!check.require(texture.levels >= 1 && texture.levels <= full_chain, "job.size", "has {} levels, expected 1..{}",
                     texture.levels, full_chain)) {
    return;
  }
  check.require(!texture.is_array || (texture.levels == 1 && !texture.is_3d), "job.size",
                "is an array with {} levels, expected a 2D array of one level", texture.levels);
  check.require(level_size(texture, 0) <= max_bytes, "job.size", "has {} bytes, expected at most {}",
                level_size(texture, 0), max_bytes);
  check.require(texture.format != Format::d32_float || !(texture.is_3d || texture.is_array || texture.depth > 1),
                "job.format", "is a 3D texture of d32_float, expected a 2D one");
  check_contents(check, texture);
}

Status validate_job(const Job& job) {
  Check check(job.name);
  for (const ShaderProgram& program : job.programs) {
    check.enter(fmt::format("program \"{}\"", program.name));
    check_program(check, program);
  }
  for (const Buffer& buffer : job.buffers) {
    check.enter(fmt::format("buffer \"{}\"", buffer.name));
    check_buffer(check, buffer);
  }
  for (const Texture& texture : job.textures) {
    check.enter(fmt::format("texture \"{}\"", texture.name));
    check_texture(check, texture);
  }
  for (std::size_t i = 0; i < job.commands.size() && check.ok(); ++i) {
    check.enter(command_context(job, job.commands[i], i));
    std::visit([&](const auto& command) { check_command(check, job, command); }, job.commands[i]);
  }
  for (std::size_t i = 0; i < job.read_backs.size(); ++i) {
    check.enter(fmt::format("read-back {}", i));
    check_read_back(check, job, job.read_backs[i]);
  }
  return check.status();
}

}  // namespace relievo
