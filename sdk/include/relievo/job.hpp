/// GPU work as data: the SDK makes Jobs, a backend or an engine's renderer executes them.
/// Every function here is thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "relievo/result.hpp"

namespace relievo {

enum class ShaderStage { vertex, tessellation_control, tessellation_evaluation, geometry, fragment, compute };
std::string_view to_string(ShaderStage stage);

/// Texel and vertex formats. `unorm` maps 0..max to [0,1]; `uint` are whole numbers, which no filter applies to.
enum class Format {
  r8_unorm,
  rg8_unorm,
  rgb8_unorm,
  rgba8_unorm,
  r16_unorm,
  rg16_unorm,
  rgb16_unorm,
  rgba16_unorm,
  r32_float,
  rg32_float,
  rgb32_float,
  rgba32_float,
  r32_uint,
  d32_float,
  rgba16_uint,
};
std::string_view to_string(Format format);
int channel_count(Format format);
bool is_integer(Format format);
int bytes_per_texel(Format format);

enum class TexelFilter { nearest, linear };
enum class TexelAddress { repeat, mirror, clamp };

struct SamplerState {
  TexelFilter min_mag = TexelFilter::linear;
  TexelFilter mip = TexelFilter::nearest;
  std::array<TexelAddress, 3> address = {TexelAddress::repeat, TexelAddress::repeat, TexelAddress::repeat};
};

/// A 2D or 3D texture with `levels` mips, or a 2D array of one level. Level k is max(1, extent >> k), rounded down,
/// tightly packed, row 0 first; `data` has one entry a level, or is empty for undefined contents (render targets,
/// storage).
struct Texture {
  std::string name;
  Format format = Format::rgba8_unorm;
  int width = 1, height = 1, depth = 1;  ///< texels; depth > 1 or is_3d: a 3D texture
  bool is_3d = false;
  bool is_array = false;  ///< `depth` is the number of layers
  int levels = 1;
  std::vector<std::vector<std::byte>> data;
  SamplerState sampler;
};

/// Unused buffer contents are zero.
struct Buffer {
  std::string name;
  std::size_t size = 0;         ///< bytes, ≥ 1
  std::vector<std::byte> data;  ///< empty, or `size` bytes
};

enum class ResourceKind { uniform_buffer, storage_buffer, sampled_texture, storage_texture };
std::string_view to_string(ResourceKind kind);

/// One entry of a program's binding contract: the author's (set, binding, name), and the flat slot that OpenGL uses in
/// the namespace of its kind (uniform block, storage block, texture unit, image unit).
struct BindingSlot {
  ResourceKind kind = ResourceKind::uniform_buffer;
  int set = 0, binding = 0;
  std::string name;  ///< the GLSL name: of the block for buffers, of the uniform for textures
  int gl_slot = 0;
  /// Some shader samples the texture. Else the sampler's filter does not matter, and devices that cannot filter the
  /// format will do.
  bool is_filtered = false;
  friend bool operator==(const BindingSlot&, const BindingSlot&) = default;
};

/// One shader of a program: SPIR-V for Vulkan, text for APIs that compile it themselves. Entry point "main".
struct ShaderCode {
  ShaderStage stage = ShaderStage::compute;
  std::vector<std::uint32_t> spirv;
  std::map<std::string, std::string> text;  ///< target name ("glsl-450") → source
  friend bool operator==(const ShaderCode&, const ShaderCode&) = default;
};

struct SpecializationValue {
  std::uint32_t id = 0;
  std::uint32_t bits = 0;  ///< int, uint, or the bits of a float
  friend bool operator==(const SpecializationValue&, const SpecializationValue&) = default;
};

struct ShaderProgram {
  std::string name;
  std::vector<ShaderCode> shaders;
  std::vector<BindingSlot> bindings;
  std::vector<SpecializationValue> constants;
  friend bool operator==(const ShaderProgram&, const ShaderProgram&) = default;
};

/// Connects one slot of the program's contract to a buffer or texture of the job (an index into its vector).
struct ResourceBinding {
  int set = 0, binding = 0;
  int resource = 0;
};

struct Dispatch {
  int program = 0;
  std::vector<ResourceBinding> resources;
  std::array<std::uint32_t, 3> groups = {1, 1, 1};
};

enum class CullMode { none, back, front };

struct VertexAttribute {
  int location = 0;
  Format format = Format::rgb32_float;  ///< a 32-bit format
  int offset = 0;                       ///< bytes
  friend bool operator==(const VertexAttribute&, const VertexAttribute&) = default;
};

/// One pass over its targets: optionally clears, then draws triangles. Depth is in [0,1], smaller is nearer; depth test
/// is less-or-equal with writes when `depth_target` is set. Clip space is Vulkan's; row 0 of a target is NDC y = −1.
/// A triangle is front-facing when its vertices run counter-clockwise as seen in the image (row 0 at the top).
struct Draw {
  int program = 0;
  std::vector<ResourceBinding> resources;
  int vertex_buffer = 0;
  int vertex_stride = 0;  ///< bytes
  std::vector<VertexAttribute> attributes;
  int index_buffer = -1;    ///< 32-bit indices; −1 = not indexed
  std::uint32_t count = 0;  ///< vertices, or indices
  std::uint32_t instances = 1;
  std::vector<int> color_targets;  ///< textures, location = position in the list
  int depth_target = -1;           ///< texture, or −1
  std::optional<std::array<float, 4>> clear_color;
  std::optional<float> clear_depth;
  CullMode cull = CullMode::none;
};

using Command = std::variant<Dispatch, Draw>;

/// Bytes that come back: a whole buffer, or one level of a texture, tightly packed, row 0 first.
struct ReadBack {
  enum class Source { buffer, texture };
  Source source = Source::buffer;
  int index = 0;
  int level = 0;
};

/// Everything a backend needs; commands run in order, each sees what earlier ones wrote.
struct Job {
  std::string name;
  std::vector<ShaderProgram> programs;
  std::vector<Buffer> buffers;
  std::vector<Texture> textures;
  std::vector<Command> commands;
  std::vector<ReadBack> read_backs;
};

struct JobResult {
  std::vector<std::vector<std::byte>> read_backs;  ///< one a ReadBack
  std::vector<double> command_seconds;             ///< one a command, by the GPU's own clock; empty without timestamps
  std::vector<std::string> messages;               ///< validation layer or debug output; empty when all is well
};

/// Checks what every backend relies on: indices in range, sizes consistent, every slot of a program bound once to a
/// resource of its kind. Errors: id "job.*", naming the job, the command and the given and expected value.
Status validate_job(const Job& job);

/// Bytes of one level of a texture.
std::size_t level_size(const Texture& texture, int level);

/// Bytes of the job's buffers and textures: what it takes on a device, besides copies on the way there and back.
std::size_t resource_bytes(const Job& job);

/// Frees what buffers and textures hold. Sizes and formats stay; a job that runs afterwards finds zeros.
void free_contents(Job& job);

/// A self-contained binary form (CBOR with a schema version), for a backend in another process. `parse_job` rejects
/// anything that is not a valid job; id "job.parse".
std::vector<std::uint8_t> serialize_job(const Job& job);
Result<Job> parse_job(const std::vector<std::uint8_t>& bytes);

}  // namespace relievo
