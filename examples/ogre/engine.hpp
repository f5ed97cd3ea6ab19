/// OGRE 1.12 without a window to see: a hidden one for the OpenGL context, and pictures drawn to textures.
#pragma once

#include <Ogre.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "relievo/scene.hpp"

/// 8 bits a channel, RGBA, row 0 (the top) first.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

/// What OGRE says of its errors and warnings, on stderr.
class Complaints : public Ogre::LogListener {
 public:
  void messageLogged(const Ogre::String& message, Ogre::LogMessageLevel level, bool, const Ogre::String&,
                     bool& skip) override;
  int count = 0;
};

class Engine {
 public:
  /// Starts OGRE's GL3Plus render system on $DISPLAY. Throws Ogre::Exception.
  Engine();
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// An empty scene with the camera of ours.
  Ogre::SceneManager* add_scene(const std::string& name, const relievo::SceneCamera& camera);

  /// Draws a scene of add_scene. With `encode_srgb` the shaders' colours count as linear and OpenGL encodes them.
  Picture draw(Ogre::SceneManager* scene, const relievo::SceneImage& size, bool encode_srgb);

  /// Errors and warnings so far: shaders that do not compile, blocks that cannot be bound, …
  int complaints() const { return complaints_.count; }

 private:
  Complaints complaints_;
  std::unique_ptr<Ogre::LogManager> logs_;
  std::unique_ptr<Ogre::Root> root_;
};

/// Where add_scene puts its camera.
inline const char* const camera_name = "camera";
