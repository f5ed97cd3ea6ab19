#include "job_material.hpp"

#include <cstring>
#include <regex>

using relievo::ErrorCode;
using relievo::Format;
using relievo::Status;

namespace {

relievo::Status refuse(std::string sentence) {
  return relievo::fail(ErrorCode::unsupported, "ogre.job", std::move(sentence));
}

// ---- mesh

/// OGRE knows vertex inputs by their meaning and finds them in a shader by its own names for it; the stages of the SDK
/// number them. The n-th entry is what the input at location n means (shaders/lib/vertex_input.glsl).
struct VertexInput {
  Ogre::VertexElementSemantic semantic;
  Ogre::VertexElementType type;
  const char* name;
};
constexpr VertexInput vertex_inputs[] = {{Ogre::VES_POSITION, Ogre::VET_FLOAT3, "vertex"},
                                         {Ogre::VES_NORMAL, Ogre::VET_FLOAT3, "normal"},
                                         {Ogre::VES_TEXTURE_COORDINATES, Ogre::VET_FLOAT2, "uv0"},
                                         {Ogre::VES_TANGENT, Ogre::VET_FLOAT3, "tangent"},
                                         {Ogre::VES_BINORMAL, Ogre::VET_FLOAT3, "binormal"}};

/// A vertex shader as GL3Plus 1.12 takes it: its inputs have OGRE's names instead of locations.
std::string for_ogre(std::string text) {
  for (std::size_t location = 0; location < std::size(vertex_inputs); ++location) {
    const std::regex input("layout\\(location = " + std::to_string(location) + "\\) in (\\w+) (\\w+);");
    const std::string name = vertex_inputs[location].name;
    text = std::regex_replace(text, input, "in $1 " + name + ";\n#define $2 " + name);
  }
  // OGRE reads every `layout` of a vertex shader as that of an input, uniform blocks too, and writes out of bounds where
  // it does not know the name. It stops at the first that names nothing: this one, which says what is so anyway.
  return std::regex_replace(text, std::regex("(#version [^\n]*\n)"), "$1layout(std140) uniform;\n");
}

Status add_vertices(const relievo::Job& job, const relievo::Draw& draw, Ogre::VertexData& data) {
  for (const relievo::VertexAttribute& attribute : draw.attributes) {
    const auto location = static_cast<std::size_t>(attribute.location);
    if (location >= std::size(vertex_inputs)) {
      return refuse("the job has a vertex input at location " + std::to_string(location) +
                    ", which has no meaning in OGRE; expected 0 to 4");
    }
    const VertexInput& input = vertex_inputs[location];
    data.vertexDeclaration->addElement(0, static_cast<std::size_t>(attribute.offset), input.type, input.semantic);
  }
  const relievo::Buffer& source = job.buffers.at(draw.vertex_buffer);
  const auto stride = static_cast<std::size_t>(draw.vertex_stride);
  data.vertexCount = source.size / stride;
  auto buffer = Ogre::HardwareBufferManager::getSingleton().createVertexBuffer(stride, data.vertexCount,
                                                                               Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
  buffer->writeData(0, source.size, source.data.data());
  data.vertexBufferBinding->setBinding(0, buffer);
  return {};
}

void add_indices(const relievo::Job& job, const relievo::Draw& draw, Ogre::IndexData& data) {
  data.indexCount = draw.count;
  data.indexBuffer = Ogre::HardwareBufferManager::getSingleton().createIndexBuffer(
      Ogre::HardwareIndexBuffer::IT_32BIT, draw.count, Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
  data.indexBuffer->writeData(0, draw.count * sizeof(std::uint32_t), job.buffers.at(draw.index_buffer).data.data());
}

/// The stages that OGRE can draw stay within the base mesh, whose positions are at offset 0.
Ogre::AxisAlignedBox bounds(const relievo::Job& job, const relievo::Draw& draw) {
  Ogre::AxisAlignedBox box;
  const relievo::Buffer& vertices = job.buffers.at(draw.vertex_buffer);
  for (std::size_t at = 0; at < vertices.size; at += static_cast<std::size_t>(draw.vertex_stride)) {
    float position[3];
    std::memcpy(position, vertices.data.data() + at, sizeof position);
    box.merge(Ogre::Vector3(position));
  }
  return box;
}

Status make_mesh(const relievo::Job& job, const relievo::Draw& draw) {
  Ogre::MeshPtr mesh = Ogre::MeshManager::getSingleton().createManual(job.name, Ogre::RGN_DEFAULT);
  Ogre::SubMesh* part = mesh->createSubMesh();
  part->useSharedVertices = false;
  part->vertexData = OGRE_NEW Ogre::VertexData();  // the SubMesh deletes it
  if (Status status = add_vertices(job, draw, *part->vertexData); !status) return status;
  add_indices(job, draw, *part->indexData);
  part->setMaterialName(job.name);
  mesh->_setBounds(bounds(job, draw));
  mesh->load();
  return {};
}

// ---- textures

Ogre::PixelFormat to_pixel_format(Format format) {
  switch (format) {
    case Format::r8_unorm:
      return Ogre::PF_R8;
    case Format::rg8_unorm:
      return Ogre::PF_RG8;
    case Format::rgba8_unorm:
      return Ogre::PF_BYTE_RGBA;
    case Format::r16_unorm:
      return Ogre::PF_L16;
    case Format::rg16_unorm:
      return Ogre::PF_SHORT_GR;
    case Format::rgba16_unorm:
      return Ogre::PF_SHORT_RGBA;
    case Format::r32_float:
      return Ogre::PF_FLOAT32_R;
    case Format::rg32_float:
      return Ogre::PF_FLOAT32_GR;
    case Format::rgba32_float:
      return Ogre::PF_FLOAT32_RGBA;
    default:
      return Ogre::PF_UNKNOWN;
  }
}

relievo::Result<Ogre::TexturePtr> make_texture(const relievo::Texture& source) {
  const Ogre::PixelFormat format = to_pixel_format(source.format);
  if (format == Ogre::PF_UNKNOWN) {
    return tl::unexpected(refuse("texture '" + source.name + "' has the format " +
                                 std::string(relievo::to_string(source.format)) + ", which OGRE does not have")
                              .error());
  }
  const Ogre::TextureType type = source.is_3d || source.depth > 1
                                     ? (source.is_array ? Ogre::TEX_TYPE_2D_ARRAY : Ogre::TEX_TYPE_3D)
                                     : (source.is_array ? Ogre::TEX_TYPE_2D_ARRAY : Ogre::TEX_TYPE_2D);
  Ogre::TexturePtr texture = Ogre::TextureManager::getSingleton().createManual(
      source.name, Ogre::RGN_DEFAULT, type, static_cast<Ogre::uint>(source.width),
      static_cast<Ogre::uint>(source.height), static_cast<Ogre::uint>(source.depth), source.levels - 1, format,
      Ogre::TU_STATIC_WRITE_ONLY);
  for (int level = 0; level < source.levels; ++level) {
    const Ogre::HardwarePixelBufferSharedPtr buffer = texture->getBuffer(0, static_cast<std::size_t>(level));
    const Ogre::PixelBox texels(buffer->getWidth(), buffer->getHeight(), buffer->getDepth(), format,
                                const_cast<std::byte*>(source.data.at(static_cast<std::size_t>(level)).data()));
    buffer->blitFromMemory(texels);
  }
  return texture;
}

Ogre::TextureAddressingMode to_addressing(relievo::TexelAddress address) {
  switch (address) {
    case relievo::TexelAddress::repeat:
      return Ogre::TAM_WRAP;
    case relievo::TexelAddress::mirror:
      return Ogre::TAM_MIRROR;
    default:
      return Ogre::TAM_CLAMP;
  }
}

Ogre::FilterOptions to_filter(relievo::TexelFilter filter) {
  return filter == relievo::TexelFilter::linear ? Ogre::FO_LINEAR : Ogre::FO_POINT;
}

Ogre::SamplerPtr make_sampler(const relievo::Texture& source) {
  const relievo::SamplerState& state = source.sampler;
  Ogre::SamplerPtr sampler = Ogre::TextureManager::getSingleton().createSampler();
  sampler->setAddressingMode(
      {to_addressing(state.address[0]), to_addressing(state.address[1]), to_addressing(state.address[2])});
  sampler->setFiltering(to_filter(state.min_mag), to_filter(state.min_mag),
                        source.levels > 1 ? to_filter(state.mip) : Ogre::FO_NONE);
  return sampler;
}

// ---- uniform blocks

/// OGRE has no raw uniform blocks, but shared parameters that GL3Plus binds to the block of the same name: one array of
/// integers stands for the block's bytes, whose std140 layout the SDK has made already.
void declare_block(const std::string& name, std::size_t size) {
  auto& programs = Ogre::GpuProgramManager::getSingleton();
  programs.createSharedParameters(name)->addConstantDefinition("bytes", Ogre::GCT_INT1, size / sizeof(int));
}

void write_block(const std::string& name, const std::vector<std::byte>& bytes) {
  Ogre::GpuSharedParametersPtr block = Ogre::GpuProgramManager::getSingleton().getSharedParameters(name);
  std::memcpy(block->getIntPointer(block->getConstantDefinition("bytes").physicalIndex), bytes.data(), bytes.size());
}

// ---- material

Ogre::GpuProgramType to_ogre(relievo::ShaderStage stage) {
  return stage == relievo::ShaderStage::vertex ? Ogre::GPT_VERTEX_PROGRAM : Ogre::GPT_FRAGMENT_PROGRAM;
}

Status make_program(const relievo::ShaderCode& shader, const std::string& name, const std::string& language) {
  if (shader.stage != relievo::ShaderStage::vertex && shader.stage != relievo::ShaderStage::fragment)
    return refuse("the job has a " + std::string(to_string(shader.stage)) + " shader; expected vertex and fragment");
  auto& programs = Ogre::HighLevelGpuProgramManager::getSingleton();
  Ogre::HighLevelGpuProgramPtr program = programs.createProgram(name, Ogre::RGN_DEFAULT, "glsl", to_ogre(shader.stage));
  const std::string& text = shader.text.at(language);
  program->setSource(shader.stage == relievo::ShaderStage::vertex ? for_ogre(text) : text);
  program->load();
  if (program->hasCompileError()) return refuse("OGRE does not compile '" + name + "'");
  return {};
}

const relievo::ResourceBinding& bound_to(const relievo::Draw& draw, const relievo::BindingSlot& slot) {
  for (const relievo::ResourceBinding& resource : draw.resources) {
    if (resource.set == slot.set && resource.binding == slot.binding) return resource;
  }
  throw Ogre::ItemIdentityException(0, "slot '" + slot.name + "' is not bound", "bound_to", __FILE__, __LINE__);
}

/// Both programs' parameters use every block; which of them reads it is the linker's affair.
void use_block(Ogre::Pass& pass, const std::string& name) {
  pass.getVertexProgramParameters()->addSharedParameters(name);
  pass.getFragmentProgramParameters()->addSharedParameters(name);
}

Status use_texture(Ogre::Pass& pass, const relievo::Texture& source, const std::string& uniform) {
  relievo::Result<Ogre::TexturePtr> texture = make_texture(source);
  if (!texture) return tl::unexpected(texture.error());
  const int unit = static_cast<int>(pass.getNumTextureUnitStates());
  Ogre::TextureUnitState* state = pass.createTextureUnitState();
  state->setTexture(*texture);
  state->setSampler(make_sampler(source));
  pass.getFragmentProgramParameters()->setNamedConstant(uniform, unit);
  return {};
}

Status make_material(const relievo::Job& job, const relievo::Draw& draw, const std::string& language) {
  const relievo::ShaderProgram& source = job.programs.at(draw.program);
  for (const relievo::BindingSlot& slot : source.bindings) {  // before the programs: OGRE looks for them when it links
    if (slot.kind == relievo::ResourceKind::uniform_buffer)
      declare_block(slot.name, job.buffers.at(bound_to(draw, slot).resource).size);
  }
  Ogre::MaterialPtr material = Ogre::MaterialManager::getSingleton().create(job.name, Ogre::RGN_DEFAULT);
  Ogre::Pass& pass = *material->getTechnique(0)->getPass(0);
  pass.setCullingMode(Ogre::CULL_NONE);
  for (const relievo::ShaderCode& shader : source.shaders) {
    const std::string name = job.name + " " + std::string(to_string(shader.stage));
    if (Status status = make_program(shader, name, language); !status) return status;
    pass.setGpuProgram(to_ogre(shader.stage), name);
  }
  for (const relievo::BindingSlot& slot : source.bindings) {
    const int resource = bound_to(draw, slot).resource;
    if (slot.kind == relievo::ResourceKind::uniform_buffer) {
      use_block(pass, slot.name);
      write_block(slot.name, job.buffers.at(resource).data);
    } else if (Status status = use_texture(pass, job.textures.at(resource), slot.name); !status) {
      return status;
    }
  }
  return {};
}

}  // namespace

void SceneFeed::cameraPreRenderScene(Ogre::Camera* camera) {
  const Ogre::Vector3 position = camera->getDerivedPosition();
  const Ogre::Vector3 target = position + camera->getDerivedDirection(), up = camera->getDerivedUp();
  scene_.camera.position = {position.x, position.y, position.z};
  scene_.camera.target = {target.x, target.y, target.z};
  scene_.camera.up = {up.x, up.y, up.z};
  if (const auto block = relievo::scene_block(scene_)) write_block("Scene", *block);
}

Status add_job(Ogre::SceneManager& scene, const relievo::Job& job, const std::string& language) {
  const relievo::Draw* draw = job.commands.size() == 1 ? std::get_if<relievo::Draw>(&job.commands[0]) : nullptr;
  if (!draw || draw->index_buffer < 0 || draw->instances != 1)
    return refuse("job '" + job.name + "' is more than one indexed Draw of one instance");
  if (Status status = make_material(job, *draw, language); !status) return status;
  if (Status status = make_mesh(job, *draw); !status) return status;
  scene.getRootSceneNode()->attachObject(scene.createEntity(job.name));
  return {};
}
