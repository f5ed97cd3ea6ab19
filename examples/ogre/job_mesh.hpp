/// The vertices of a Job in OGRE: a mesh, and a vertex shader that finds its inputs in it.
#pragma once

#include <Ogre.h>

#include <string>

#include "relievo/job.hpp"

/// Makes a mesh of what `draw` draws, with the material of the same name.
relievo::Status make_mesh(const std::string& name, const relievo::Job& job, const relievo::Draw& draw);

/// A vertex shader as GL3Plus 1.12 takes it: its inputs have OGRE's names instead of locations.
std::string vertex_shader_for_ogre(std::string text);
