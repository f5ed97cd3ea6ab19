/// From a Job of the SDK to a mesh and a material of OGRE.
#pragma once

#include "engine.hpp"
#include "relievo/job.hpp"
#include "relievo/render.hpp"

/// Writes the SDK's block `Scene` before each frame, from the camera that OGRE is about to draw with.
class SceneFeed : public Ogre::Camera::Listener {
 public:
  explicit SceneFeed(relievo::Scene scene) : scene_(std::move(scene)) {}
  void cameraPreRenderScene(Ogre::Camera* camera) override;

 private:
  relievo::Scene scene_;
};

/// Puts what the job draws into a scene of OGRE: its buffers become a mesh, its programs, textures and uniform blocks a
/// material. Takes jobs of one Draw with a vertex and a fragment shader in `language` ("glsl-430").
relievo::Status add_job(Ogre::SceneManager& scene, const relievo::Job& job, const std::string& language);
