#include "own_parallax.hpp"

#include <OgreRTShaderSystem.h>

#include <algorithm>
#include <cmath>

namespace {

constexpr const char* name = "own parallax";

Ogre::Vector3 to_ogre(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

Ogre::ColourValue to_colour(const std::array<float, 3>& c, float factor = 1) {
  return Ogre::ColourValue(c[0] * factor, c[1] * factor, c[2] * factor);
}

void make_mesh(const relievo::Mesh& mesh) {
  Ogre::ManualObject object(name);
  object.begin(name, Ogre::RenderOperation::OT_TRIANGLE_LIST);
  const std::vector<relievo::TriangleFrame> frames = relievo::triangle_frames(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t v : mesh.triangles[t]) {
      object.position(to_ogre(mesh.positions[v]));
      object.normal(to_ogre(mesh.normals[v]));
      object.textureCoord(mesh.uvs[v][0], mesh.uvs[v][1]);
      object.tangent(to_ogre(frames[t].tangent).normalisedCopy());
    }
  }
  object.end();
  object.convertToMesh(name);
}

/// Height in texture widths: the baked normals are those of `normal.scale`, 0.1.
float slope_factor(const relievo::Scene& scene, const relievo::Mesh& mesh) {
  constexpr float baked_scale = 0.1f;
  const float width = to_ogre(relievo::triangle_frames(mesh).at(0).tangent).length();
  return scene.displacement.scale / width / baked_scale;
}

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255));
}

Ogre::TexturePtr make_normal_height_map(const relievo::MapSet& maps, float factor) {
  const relievo::MapData &normals = maps.at("normal"), &heights = maps.at("height");
  const std::size_t count = heights.texels.size();
  std::vector<std::uint8_t> texels(count * 4);
  for (std::size_t i = 0; i < count; ++i) {
    const float x = normals.texels[3 * i], y = normals.texels[3 * i + 1], z = normals.texels[3 * i + 2];
    const Ogre::Vector3 normal = Ogre::Vector3(x * factor, y * factor, z).normalisedCopy();
    for (std::size_t c = 0; c < 3; ++c) texels[4 * i + c] = to_byte(0.5f + 0.5f * normal[c]);
    texels[4 * i + 3] = to_byte(heights.texels[i]);
  }
  const auto width = static_cast<Ogre::uint32>(heights.width), height = static_cast<Ogre::uint32>(heights.height);
  Ogre::TexturePtr texture = Ogre::TextureManager::getSingleton().createManual(
      "normals and heights", Ogre::RGN_DEFAULT, Ogre::TEX_TYPE_2D, width, height, 0, Ogre::PF_BYTE_RGBA);
  texture->getBuffer()->blitFromMemory(Ogre::PixelBox(width, height, 1, Ogre::PF_BYTE_RGBA, texels.data()));
  return texture;
}

void make_material(const relievo::SceneMaterial& look, const Ogre::TexturePtr& map) {
  using namespace Ogre::RTShader;
  Ogre::MaterialPtr material = Ogre::MaterialManager::getSingleton().create(name, Ogre::RGN_DEFAULT);
  Ogre::Pass* pass = material->getTechnique(0)->getPass(0);
  pass->setCullingMode(Ogre::CULL_NONE);
  pass->setAmbient(to_colour(look.albedo));
  pass->setDiffuse(to_colour(look.albedo));
  pass->setSpecular(look.specular, look.specular, look.specular, 1);
  pass->setShininess(look.shininess);
  ShaderGenerator& generator = ShaderGenerator::getSingleton();
  generator.createShaderBasedTechnique(*material, Ogre::MaterialManager::DEFAULT_SCHEME_NAME,
                                       ShaderGenerator::DEFAULT_SCHEME_NAME);
  auto* lighting = generator.createSubRenderState<NormalMapLighting>();
  lighting->setNormalMapSpace(NormalMapLighting::NMS_PARALLAX);
  lighting->setNormalMapTextureName(map->getName());
  lighting->getNormalMapSampler()->setFiltering(Ogre::TFO_BILINEAR);
  generator.getRenderState(ShaderGenerator::DEFAULT_SCHEME_NAME, name, Ogre::RGN_DEFAULT, 0)
      ->addTemplateSubRenderState(lighting);
}

void add_lights(Ogre::SceneManager& scene, const relievo::Scene& source) {
  scene.setAmbientLight(to_colour({1, 1, 1}, source.material.ambient));
  for (const relievo::SceneLight& light : source.lights) {
    Ogre::Light* lamp = scene.createLight();
    lamp->setType(Ogre::Light::LT_DIRECTIONAL);
    lamp->setDiffuseColour(to_colour(light.color));
    lamp->setSpecularColour(to_colour(light.color));
    Ogre::SceneNode* node = scene.getRootSceneNode()->createChildSceneNode();
    node->setDirection(-to_ogre(light.direction).normalisedCopy(), Ogre::Node::TS_WORLD);
    node->attachObject(lamp);
  }
}

}  // namespace

void add_own_parallax(Ogre::SceneManager& scene, const relievo::Scene& source, const relievo::Mesh& mesh,
                      const relievo::MapSet& maps) {
  make_material(source.material, make_normal_height_map(maps, slope_factor(source, mesh)));
  make_mesh(mesh);
  add_lights(scene, source);
  scene.getRootSceneNode()->attachObject(scene.createEntity(name));
}
