#include "engine.hpp"

#include <OgreRTShaderSystem.h>

#include <cstdio>

namespace {

Ogre::Vector3 to_ogre(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

void start_render_system(Ogre::Root& root) {
  root.loadPlugin(RELIEVO_OGRE_PLUGIN_DIR "/RenderSystem_GL3Plus");
  root.setRenderSystem(root.getAvailableRenderers().at(0));
  root.initialise(false);
  // OGRE's OpenGL context comes with a window; nobody has to see it.
  const Ogre::NameValuePairList hidden = {{"hidden", "true"}};
  root.createRenderWindow("relievo", 1, 1, false, &hidden);
}

void start_shader_generator() {
  auto& groups = Ogre::ResourceGroupManager::getSingleton();
  for (const char* folder : {"/RTShaderLib/GLSL", "/ShadowVolume"}) {  // OGRE's shader libraries
    groups.addResourceLocation(std::string(RELIEVO_OGRE_MEDIA_DIR) + folder, "FileSystem", Ogre::RGN_INTERNAL);
  }
  groups.initialiseAllResourceGroups();
  Ogre::RTShader::ShaderGenerator::initialize();
}

/// Removed when the picture is read.
struct Target {
  Target(const relievo::SceneImage& size, bool encode_srgb)
      : texture(Ogre::TextureManager::getSingleton().createManual(
            "target", Ogre::RGN_DEFAULT, Ogre::TEX_TYPE_2D, static_cast<Ogre::uint>(size.width),
            static_cast<Ogre::uint>(size.height), 0, Ogre::PF_BYTE_RGBA, Ogre::TU_RENDERTARGET, nullptr, encode_srgb)) {
  }
  ~Target() { Ogre::TextureManager::getSingleton().remove(texture); }

  Ogre::TexturePtr texture;
};

}  // namespace

void Complaints::messageLogged(const Ogre::String& message, Ogre::LogMessageLevel level, bool, const Ogre::String&,
                               bool& skip) {
  skip = true;  // the rest of the log is nobody's business here
  if (level < Ogre::LML_WARNING) return;
  ++count;
  std::fprintf(stderr, "OGRE: %s\n", message.c_str());
}

Engine::Engine() : logs_(std::make_unique<Ogre::LogManager>()) {
  logs_->createLog("ogre", true, false, true)->addListener(&complaints_);
  root_ = std::make_unique<Ogre::Root>("", "", "");
  start_render_system(*root_);
  start_shader_generator();
}

Engine::~Engine() {
  Ogre::RTShader::ShaderGenerator::destroy();
}

Ogre::SceneManager* Engine::add_scene(const std::string& name, const relievo::SceneCamera& camera) {
  Ogre::SceneManager* scene = root_->createSceneManager(Ogre::DefaultSceneManagerFactory::FACTORY_TYPE_NAME, name);
  Ogre::RTShader::ShaderGenerator::getSingleton().addSceneManager(scene);
  Ogre::Camera* eye = scene->createCamera(camera_name);
  eye->setNearClipDistance(camera.near_plane);
  eye->setFarClipDistance(camera.far_plane);
  eye->setFOVy(Ogre::Degree(camera.vertical_fov));
  Ogre::SceneNode* node = scene->getRootSceneNode()->createChildSceneNode(to_ogre(camera.position));
  node->setFixedYawAxis(true, to_ogre(camera.up));
  node->lookAt(to_ogre(camera.target), Ogre::Node::TS_WORLD);
  node->attachObject(eye);
  return scene;
}

Picture Engine::draw(Ogre::SceneManager* scene, const relievo::SceneImage& size, bool encode_srgb) {
  const Target target(size, encode_srgb);
  Ogre::Camera* camera = scene->getCamera(camera_name);
  camera->setAspectRatio(static_cast<float>(size.width) / static_cast<float>(size.height));
  Ogre::HardwarePixelBufferSharedPtr pixels = target.texture->getBuffer();
  Ogre::RenderTarget* surface = pixels->getRenderTarget();
  Ogre::Viewport* viewport = surface->addViewport(camera);
  viewport->setBackgroundColour(Ogre::ColourValue(0, 0, 0, 0));
  viewport->setOverlaysEnabled(false);
  viewport->setMaterialScheme(Ogre::RTShader::ShaderGenerator::DEFAULT_SCHEME_NAME);
  surface->update();
  Picture picture{size.width, size.height, {}};
  picture.pixels.resize(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 4);
  pixels->blitToMemory(Ogre::PixelBox(target.texture->getWidth(), target.texture->getHeight(), 1, Ogre::PF_BYTE_RGBA,
                                      picture.pixels.data()));
  return picture;
}
