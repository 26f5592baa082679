#include "vhd_renderer/draw/gl_context.hpp"

#include <array>
#include <cstring>
#include <vector>

#define EGL_NO_X11
#include <epoxy/egl.h>
#include <epoxy/gl.h>

namespace counterpart {
namespace {

struct Way {
  std::string name;
  EGLDisplay display;
};

bool is_software(EGLDeviceEXT device) {
  const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
  return extensions != nullptr && std::strstr(extensions, "EGL_MESA_device_software") != nullptr;
}

std::vector<EGLDeviceEXT> devices() {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
      !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base")) {
    return {};
  }
  std::array<EGLDeviceEXT, 16> found{};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(static_cast<EGLint>(found.size()), found.data(), &count)) return {};
  return {found.begin(), found.begin() + count};
}

// In the order in which they are tried.
std::vector<Way> ways() {
  std::vector<Way> result;
  const std::vector<EGLDeviceEXT> all = devices();
  for (const bool software : {false, true}) {
    for (EGLDeviceEXT device : all) {
      if (is_software(device) != software) continue;
      result.push_back({software ? "software device" : "hardware device",
                        eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr)});
    }
  }
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    result.push_back(
        {"surfaceless", eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
  }
  return result;
}

EGLContext context_on(EGLDisplay display, std::string& complaint) {
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) {
    complaint = "cannot be initialised";
    return EGL_NO_CONTEXT;
  }
  if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context") ||
      !epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) {
    complaint = "cannot draw without a window";
    return EGL_NO_CONTEXT;
  }
  eglBindAPI(EGL_OPENGL_API);
  const std::array<EGLint, 7> wanted{
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted.data());
  if (context == EGL_NO_CONTEXT) {
    complaint = "has no OpenGL 3.3";
    return EGL_NO_CONTEXT;
  }
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    complaint = "refuses to make its context current";
    eglDestroyContext(display, context);
    return EGL_NO_CONTEXT;
  }
  return context;
}

}  // namespace

Result<std::unique_ptr<GlContext>> GlContext::create() {
  std::string complaints;
  for (const Way& way : ways()) {
    std::string complaint;
    EGLContext context = context_on(way.display, complaint);
    if (context == EGL_NO_CONTEXT) {
      complaints += (complaints.empty() ? "" : "; ") + way.name + " " + complaint;
      continue;
    }
    std::unique_ptr<GlContext> result(new GlContext(way.display, context));
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    result->description_ = way.name + ": " + (renderer != nullptr ? renderer : "unnamed");
    return result;
  }
  if (complaints.empty()) complaints = "no EGL device and no surfaceless platform found";
  return failure(ErrorCode::unavailable, "No OpenGL 3.3 context without a window: " + complaints +
                                             ". Install a driver (Debian: libegl1 and libgl1-mesa-dri; Mesa's "
                                             "llvmpipe draws without a GPU).");
}

GlContext::~GlContext() {
  // The display is shared by all contexts on it and stays initialised for the life of the process.
  if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

void GlContext::make_current() const {
  if (eglGetCurrentContext() != context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
}

}  // namespace counterpart
