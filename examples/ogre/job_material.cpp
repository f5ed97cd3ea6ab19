#include "job_material.hpp"

#include <algorithm>
#include <cstring>

#include "job_mesh.hpp"
#include "job_textures.hpp"

using relievo::Status;

namespace {

Status refuse(std::string sentence) {
  return relievo::fail(relievo::ErrorCode::unsupported, "ogre.job", std::move(sentence));
}

void write_block(const std::string& name, const std::vector<std::byte>& bytes) {
  Ogre::GpuSharedParametersPtr block = Ogre::GpuProgramManager::getSingleton().getSharedParameters(name);
  std::memcpy(block->getIntPointer(block->getConstantDefinition("bytes").physicalIndex), bytes.data(), bytes.size());
}

Ogre::GpuProgramType to_ogre(relievo::ShaderStage stage) {
  return stage == relievo::ShaderStage::vertex ? Ogre::GPT_VERTEX_PROGRAM : Ogre::GPT_FRAGMENT_PROGRAM;
}

Status make_program(const relievo::ShaderCode& shader, const std::string& name, const std::string& language) {
  if (shader.stage != relievo::ShaderStage::vertex && shader.stage != relievo::ShaderStage::fragment)
    return refuse("the job has a " + std::string(to_string(shader.stage)) + " shader; expected vertex and fragment");
  auto& programs = Ogre::HighLevelGpuProgramManager::getSingleton();
  Ogre::HighLevelGpuProgramPtr program = programs.createProgram(name, Ogre::RGN_DEFAULT, "glsl", to_ogre(shader.stage));
  const std::string& text = shader.text.at(language);
  program->setSource(shader.stage == relievo::ShaderStage::vertex ? vertex_shader_for_ogre(text) : text);
  program->load();
  if (program->hasCompileError()) return refuse("OGRE does not compile '" + name + "'");
  return {};
}

/// Of a valid job, which binds every slot.
int resource_of(const relievo::Draw& draw, const relievo::BindingSlot& slot) {
  const auto bound =
      std::find_if(draw.resources.begin(), draw.resources.end(), [&](const relievo::ResourceBinding& binding) {
        return binding.set == slot.set && binding.binding == slot.binding;
      });
  return bound->resource;
}

/// OGRE has no raw uniform blocks, but shared parameters that GL3Plus binds to the block of the same name: one array of
/// integers stands for the block's bytes, whose std140 layout the SDK has made already.
void add_block(Ogre::Pass& pass, const std::string& name, const std::vector<std::byte>& bytes) {
  Ogre::GpuSharedParametersPtr block = Ogre::GpuProgramManager::getSingleton().createSharedParameters(name);
  block->addConstantDefinition("bytes", Ogre::GCT_INT1, bytes.size() / sizeof(int));
  write_block(name, bytes);
  // Which of the two programs reads it does not matter.
  pass.getVertexProgramParameters()->addSharedParameters(block);
  pass.getFragmentProgramParameters()->addSharedParameters(block);
}

Status add_texture(Ogre::Pass& pass, const relievo::Texture& source, const std::string& uniform) {
  relievo::Result<Ogre::TexturePtr> texture = make_texture(source);
  if (!texture) return tl::unexpected(texture.error());
  const int unit = static_cast<int>(pass.getNumTextureUnitStates());
  Ogre::TextureUnitState* state = pass.createTextureUnitState();
  state->setTexture(*texture);
  state->setSampler(make_sampler(source));
  pass.getFragmentProgramParameters()->setNamedConstant(uniform, unit);
  return {};
}

Status add_programs(Ogre::Pass& pass, const relievo::ShaderProgram& source, const std::string& language) {
  for (const relievo::ShaderCode& shader : source.shaders) {
    const std::string name = source.name + " " + std::string(to_string(shader.stage));
    if (Status status = make_program(shader, name, language); !status) return status;
    pass.setGpuProgram(to_ogre(shader.stage), name);
  }
  return {};
}

Status add_resources(Ogre::Pass& pass, const relievo::Job& job, const relievo::Draw& draw) {
  for (const relievo::BindingSlot& slot : job.programs[draw.program].bindings) {
    const int resource = resource_of(draw, slot);
    if (slot.kind == relievo::ResourceKind::uniform_buffer) {
      add_block(pass, slot.name, job.buffers[resource].data);
    } else if (slot.kind == relievo::ResourceKind::sampled_texture) {
      if (Status status = add_texture(pass, job.textures[resource], slot.name); !status) return status;
    } else {
      return refuse("slot '" + slot.name + "' is a " + std::string(to_string(slot.kind)) +
                    "; expected uniform buffers and sampled textures");
    }
  }
  return {};
}

Status make_material(const std::string& name, const relievo::Job& job, const relievo::Draw& draw,
                     const std::string& language) {
  Ogre::MaterialPtr material = Ogre::MaterialManager::getSingleton().create(name, Ogre::RGN_DEFAULT);
  Ogre::Pass& pass = *material->getTechnique(0)->getPass(0);
  pass.setCullingMode(Ogre::CULL_NONE);
  if (Status status = add_programs(pass, job.programs[draw.program], language); !status) return status;
  return add_resources(pass, job, draw);
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
  if (Status status = relievo::validate_job(job); !status) return status;
  const relievo::Draw* draw = job.commands.size() == 1 ? std::get_if<relievo::Draw>(&job.commands[0]) : nullptr;
  if (!draw || draw->index_buffer < 0 || draw->instances != 1)
    return refuse("job '" + job.name + "' is more than one indexed Draw of one instance");
  if (Status status = make_material(job.name, job, *draw, language); !status) return status;
  if (Status status = make_mesh(job.name, job, *draw); !status) return status;
  scene.getRootSceneNode()->attachObject(scene.createEntity(job.name));
  return {};
}
