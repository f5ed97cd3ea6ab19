#include "job_textures.hpp"

using relievo::Format;

namespace {

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
    case Format::rgba16_uint:
      return Ogre::PF_R16G16B16A16_UINT;
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

Ogre::TextureType to_type(const relievo::Texture& source) {
  if (source.is_array) return Ogre::TEX_TYPE_2D_ARRAY;
  return source.is_3d || source.depth > 1 ? Ogre::TEX_TYPE_3D : Ogre::TEX_TYPE_2D;
}

}  // namespace

relievo::Result<Ogre::TexturePtr> make_texture(const relievo::Texture& source) {
  const Ogre::PixelFormat format = to_pixel_format(source.format);
  if (format == Ogre::PF_UNKNOWN) {
    return relievo::fail(relievo::ErrorCode::unsupported, "ogre.texture-format",
                         "texture '" + source.name + "' has the format " +
                             std::string(relievo::to_string(source.format)) + ", which OGRE does not have");
  }
  Ogre::TexturePtr texture = Ogre::TextureManager::getSingleton().createManual(
      source.name, Ogre::RGN_DEFAULT, to_type(source), static_cast<Ogre::uint>(source.width),
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

Ogre::SamplerPtr make_sampler(const relievo::Texture& source) {
  const relievo::SamplerState& state = source.sampler;
  Ogre::SamplerPtr sampler = Ogre::TextureManager::getSingleton().createSampler();
  sampler->setAddressingMode(
      {to_addressing(state.address[0]), to_addressing(state.address[1]), to_addressing(state.address[2])});
  sampler->setFiltering(to_filter(state.min_mag), to_filter(state.min_mag),
                        source.levels > 1 ? to_filter(state.mip) : Ogre::FO_NONE);
  return sampler;
}
