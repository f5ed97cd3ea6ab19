#include "display.hpp"

#include <fmt/format.h>

#include <array>
#include <map>

namespace relievo::opengl {
namespace {

// eglGetProcAddress instead of libepoxy's wrappers: those end the program when the entry point is missing.
template <class Function>
Function egl_function(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

void add_surfaceless(PFNEGLGETPLATFORMDISPLAYEXTPROC get_display, std::vector<DisplayCandidate>& candidates) {
  if (!has_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) return;
  const EGLDisplay handle = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (handle != EGL_NO_DISPLAY) candidates.push_back({handle, "surfaceless"});
}

void add_devices(PFNEGLGETPLATFORMDISPLAYEXTPROC get_display, std::vector<DisplayCandidate>& candidates) {
  const auto query_devices = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  if (!has_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") || query_devices == nullptr) return;
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  if (!query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count)) return;
  for (EGLint i = 0; i < count; ++i) {
    const EGLDisplay handle = get_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
    if (handle != EGL_NO_DISPLAY) candidates.push_back({handle, fmt::format("device {}", i)});
  }
}

}  // namespace

std::vector<DisplayCandidate> display_candidates() {
  std::vector<DisplayCandidate> candidates;
  const auto get_display = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (get_display == nullptr) return candidates;
  add_surfaceless(get_display, candidates);
  add_devices(get_display, candidates);
  return candidates;
}

Status initialise(const DisplayCandidate& candidate) {
  if (eglInitialize(candidate.handle, nullptr, nullptr)) return {};
  return fail(ErrorCode::unsupported, "backend.unavailable",
              fmt::format("on the {} display, eglInitialize gives {}", candidate.label, egl_error_name(eglGetError())));
}

bool has_extension(EGLDisplay display, const char* name) {
  return epoxy_has_egl_extension(display, name);
}

std::string egl_error_name(EGLint error) {
  static const std::map<EGLint, const char*> names = {
      {EGL_SUCCESS, "EGL_SUCCESS"},
      {EGL_NOT_INITIALIZED, "EGL_NOT_INITIALIZED"},
      {EGL_BAD_ACCESS, "EGL_BAD_ACCESS"},
      {EGL_BAD_ALLOC, "EGL_BAD_ALLOC"},
      {EGL_BAD_ATTRIBUTE, "EGL_BAD_ATTRIBUTE"},
      {EGL_BAD_CONFIG, "EGL_BAD_CONFIG"},
      {EGL_BAD_CONTEXT, "EGL_BAD_CONTEXT"},
      {EGL_BAD_DISPLAY, "EGL_BAD_DISPLAY"},
      {EGL_BAD_MATCH, "EGL_BAD_MATCH"},
      {EGL_BAD_PARAMETER, "EGL_BAD_PARAMETER"},
      {EGL_CONTEXT_LOST, "EGL_CONTEXT_LOST"},
  };
  const auto it = names.find(error);
  return it != names.end() ? it->second : fmt::format("EGL error 0x{:x}", error);
}

}  // namespace relievo::opengl
