#include "maps/bake_plan.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstdint>
#include <limits>

namespace relievo {

namespace {

constexpr std::size_t least_job_bytes = std::size_t{8} << 20;  // below it Jobs cost more than memory that they save
constexpr std::size_t shader_floats = std::numeric_limits<std::int32_t>::max();  // shaders count in int

bool layers_are_apart(const MapDescriptor& map, AddressMode address) {
  return map.passes == std::vector<int>{1} ||
         std::find(map.layers_apart.begin(), map.layers_apart.end(), to_string(address)) != map.layers_apart.end();
}

/// Floats that a storage buffer of the backend has room for.
std::size_t buffer_room(const BackendInfo& backend) {
  if (backend.max_storage_buffer < sizeof(float)) return shader_floats;
  return std::min(backend.max_storage_buffer / sizeof(float), shader_floats);
}

}  // namespace

std::size_t BakePlan::buffers(int layer_count) const {
  return (static_cast<std::size_t>(layer_count) * layer_floats + buffer_floats - 1) / buffer_floats;
}

std::size_t BakePlan::in_buffer(std::size_t buffer, int layer_count) const {
  return std::min(buffer_floats, static_cast<std::size_t>(layer_count) * layer_floats - buffer * buffer_floats);
}

Result<BakePlan> plan_bake(const MapData& output, const MapDescriptor& descriptor, const MapData& height,
                           const BackendInfo& backend) {
  const std::size_t floats = texel_count(output) * static_cast<std::size_t>(output.channels);
  const std::size_t room = buffer_room(backend);
  BakePlan plan;
  plan.layers = output.depth;
  plan.layer_floats = floats / static_cast<std::size_t>(output.depth);
  if (layers_are_apart(descriptor, output.address)) {
    const std::size_t job_bytes = std::max(least_job_bytes, 4 * texture_bytes(height));
    const std::size_t fitting = std::min(room, job_bytes / sizeof(float)) / plan.layer_floats;
    plan.layers = static_cast<int>(std::clamp<std::size_t>(fitting, 1, static_cast<std::size_t>(output.depth)));
    if (plan.layers < output.depth && plan.layers > descriptor.layers_at_once)
      plan.layers -= plan.layers % descriptor.layers_at_once;
  }
  const std::size_t job_floats = static_cast<std::size_t>(plan.layers) * plan.layer_floats;
  plan.buffer_floats = std::min(job_floats, room);
  if (plan.buffers(plan.layers) <= most_bake_buffers && job_floats <= shader_floats) return plan;
  return fail(ErrorCode::unsupported, "maps.too-large",
              fmt::format("map '{}' of {}x{} texels takes {} bytes at once; expected at most {} on backend '{}', which "
                          "has storage buffers of {} bytes",
                          output.name, output.width, output.height, job_floats * sizeof(float),
                          std::min(shader_floats, room * most_bake_buffers) * sizeof(float), backend.name,
                          backend.max_storage_buffer));
}

}  // namespace relievo
