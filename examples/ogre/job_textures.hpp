/// The textures of a Job in OGRE.
#pragma once

#include <Ogre.h>

#include "relievo/job.hpp"

/// All levels and layers, under the texture's own name.
relievo::Result<Ogre::TexturePtr> make_texture(const relievo::Texture& source);

Ogre::SamplerPtr make_sampler(const relievo::Texture& source);
