#include "context.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <utility>
#include <vector>

#include "libraries.hpp"

namespace relievo::opengl {
namespace {

tl::unexpected<Error> unavailable(std::string reason) {
  return fail(ErrorCode::unsupported, "backend.unavailable", std::move(reason));
}

/// A context without a config where the driver can, otherwise with any config for OpenGL.
EGLConfig any_config(EGLDisplay display) {
  if (has_extension(display, "EGL_KHR_no_config_context")) return EGL_NO_CONFIG_KHR;
  const std::array<EGLint, 5> wanted = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                                        EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  eglChooseConfig(display, wanted.data(), &config, 1, &count);
  return config;
}

EGLContext create_context(EGLDisplay display, EGLBoolean debug, EGLBoolean robust) {
  const std::vector<EGLint> attributes = {
      EGL_CONTEXT_MAJOR_VERSION,
      4,
      EGL_CONTEXT_MINOR_VERSION,
      5,
      EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
      EGL_CONTEXT_OPENGL_DEBUG,
      static_cast<EGLint>(debug),
      EGL_CONTEXT_OPENGL_ROBUST_ACCESS,
      static_cast<EGLint>(robust),
      EGL_NONE,
  };
  return eglCreateContext(display, any_config(display), EGL_NO_CONTEXT, attributes.data());
}

}  // namespace

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text != nullptr ? text : "";
}

Result<std::unique_ptr<Context>> Context::open(const BackendOptions& options) {
  if (std::string missing = missing_driver_library(); !missing.empty()) return unavailable(std::move(missing));
  std::unique_ptr<Context> software;
  std::vector<std::string> seen, problems;
  for (const DisplayCandidate& candidate : display_candidates()) {
    auto context = create(candidate, options.validation);
    if (!context) {
      problems.push_back(context.error().message);
      continue;
    }
    seen.push_back(fmt::format("'{}'", (*context)->device()));
    if ((*context)->device().find(options.device) == std::string::npos) continue;
    if (!(*context)->is_software()) return context;
    if (software == nullptr) software = std::move(*context);
  }
  if (software != nullptr) return software;
  if (!seen.empty()) {
    return fail(
        ErrorCode::unsupported, "backend.unknown-device",
        fmt::format("no OpenGL device is named '{}'; expected a part of {}", options.device, fmt::join(seen, ", ")));
  }
  if (problems.empty()) {
    return unavailable(
        "EGL finds no driver: it offers neither a surfaceless nor a device platform; expected Mesa's or the GPU "
        "vendor's driver");
  }
  return unavailable(fmt::format("no driver offers OpenGL 4.5 core: {}", fmt::join(problems, "; ")));
}

Result<std::unique_ptr<Context>> Context::create(const DisplayCandidate& candidate, bool debug) {
  if (auto status = initialise(candidate); !status) return tl::unexpected(std::move(status.error()));
  std::unique_ptr<Context> context(new Context);
  context->display_ = candidate.handle;
  context->debug_ = debug;
  if (auto status = context->create_handle(candidate); !status) return tl::unexpected(std::move(status.error()));
  if (auto status = context->read_identity(candidate); !status) return tl::unexpected(std::move(status.error()));
  return context;
}

Status Context::create_handle(const DisplayCandidate& candidate) {
  if (!has_extension(display_, "EGL_KHR_surfaceless_context")) {
    return unavailable(fmt::format("on the {} display, EGL_KHR_surfaceless_context is missing", candidate.label));
  }
  const EGLenum previous_api = eglQueryAPI();
  eglBindAPI(EGL_OPENGL_API);
  // With bounds checks where the driver has them: a job's shaders and indices may reach outside of its buffers.
  handle_ = create_context(display_, debug_, EGL_TRUE);
  if (handle_ == EGL_NO_CONTEXT) handle_ = create_context(display_, debug_, EGL_FALSE);
  const EGLint error = eglGetError();
  eglBindAPI(previous_api);
  if (handle_ != EGL_NO_CONTEXT) return {};
  return unavailable(
      fmt::format("on the {} display, eglCreateContext gives {}", candidate.label, egl_error_name(error)));
}

Status Context::read_identity(const DisplayCandidate& candidate) {
  const CurrentContext current(*this);
  if (!current.status()) return current.status();
  if (debug_) debug_output_.attach();
  device_ = gl_string(GL_RENDERER);
  const int version = epoxy_gl_version();
  if (version >= 45) return {};
  return unavailable(
      fmt::format("on the {} display, the driver has OpenGL {}.{}", candidate.label, version / 10, version % 10));
}

Context::~Context() {
  if (handle_ != EGL_NO_CONTEXT) eglDestroyContext(display_, handle_);
}

bool Context::is_software() const {
  for (const char* renderer : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer"}) {
    if (device_.find(renderer) != std::string::npos) return true;
  }
  return false;
}

CurrentContext::CurrentContext(const Context& context)
    : display_(context.display_),
      previous_api_(eglQueryAPI()),
      previous_display_(eglGetCurrentDisplay()),
      previous_draw_(eglGetCurrentSurface(EGL_DRAW)),
      previous_read_(eglGetCurrentSurface(EGL_READ)),
      previous_context_(eglGetCurrentContext()) {
  eglBindAPI(EGL_OPENGL_API);
  if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.handle_)) return;
  status_ = fail(ErrorCode::backend, "backend.make-current",
                 fmt::format("the OpenGL context does not become current on this thread: eglMakeCurrent gives {}",
                             egl_error_name(eglGetError())));
}

CurrentContext::~CurrentContext() {
  if (status_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglBindAPI(previous_api_);
  if (previous_context_ == EGL_NO_CONTEXT) return;
  eglMakeCurrent(previous_display_, previous_draw_, previous_read_, previous_context_);
}

}  // namespace relievo::opengl
