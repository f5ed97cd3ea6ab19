#include "job_mesh.hpp"

#include <cstring>
#include <regex>

using relievo::Status;

namespace {

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

Status add_vertices(const relievo::Job& job, const relievo::Draw& draw, Ogre::VertexData& data) {
  for (const relievo::VertexAttribute& attribute : draw.attributes) {
    const auto location = static_cast<std::size_t>(attribute.location);
    if (location >= std::size(vertex_inputs)) {
      return relievo::fail(relievo::ErrorCode::unsupported, "ogre.vertex-input",
                           "the job has a vertex input at location " + std::to_string(location) +
                               ", which has no meaning in OGRE; expected 0 to 4");
    }
    const VertexInput& input = vertex_inputs[location];
    data.vertexDeclaration->addElement(0, static_cast<std::size_t>(attribute.offset), input.type, input.semantic);
  }
  const relievo::Buffer& source = job.buffers.at(draw.vertex_buffer);
  const auto stride = static_cast<std::size_t>(draw.vertex_stride);
  data.vertexCount = source.size / stride;
  auto buffer = Ogre::HardwareBufferManager::getSingleton().createVertexBuffer(
      stride, data.vertexCount, Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
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

}  // namespace

std::string vertex_shader_for_ogre(std::string text) {
  for (std::size_t location = 0; location < std::size(vertex_inputs); ++location) {
    const std::regex input("layout\\(location = " + std::to_string(location) + "\\) in (\\w+) (\\w+);");
    const std::string name = vertex_inputs[location].name;
    text = std::regex_replace(text, input, "in $1 " + name + ";\n#define $2 " + name);
  }
  // OGRE reads every `layout` of a vertex shader as that of an input, uniform blocks too, and writes out of bounds
  // where it does not know the name. It stops at the first that names nothing: this one, which says what is so anyway.
  return std::regex_replace(text, std::regex("(#version [^\n]*\n)"), "$1layout(std140) uniform;\n");
}

Status make_mesh(const std::string& name, const relievo::Job& job, const relievo::Draw& draw) {
  Ogre::MeshPtr mesh = Ogre::MeshManager::getSingleton().createManual(name, Ogre::RGN_DEFAULT);
  Ogre::SubMesh* part = mesh->createSubMesh();
  part->useSharedVertices = false;
  part->vertexData = OGRE_NEW Ogre::VertexData();  // the SubMesh deletes it
  if (Status status = add_vertices(job, draw, *part->vertexData); !status) return status;
  add_indices(job, draw, *part->indexData);
  part->setMaterialName(name);
  mesh->_setBounds(bounds(job, draw));
  mesh->load();
  return {};
}
