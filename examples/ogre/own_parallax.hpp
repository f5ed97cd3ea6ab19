/// OGRE's own way to the same scene: normal map lighting with parallax, from its RTShader System.
#pragma once

#include "engine.hpp"
#include "relievo/maps.hpp"
#include "relievo/mesh.hpp"

/// Adds the mesh, the lights and a material whose normal map has the heights in alpha. `maps` holds "height" and
/// "normal". The depth of OGRE 1.12's parallax cannot be set: always 0.04 texture widths, half above and half below.
void add_own_parallax(Ogre::SceneManager& scene, const relievo::Scene& source, const relievo::Mesh& mesh,
                      const relievo::MapSet& maps);
