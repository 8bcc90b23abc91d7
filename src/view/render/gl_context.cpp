#include "src/view/render/gl_context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <mutex>
#include <stdexcept>
#include <vector>

namespace tutu::app {

struct GlContext::Handles {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

namespace {

// EGL hands the same display to everybody who asks, so one owner closing it would pull it from under the others:
// displays stay open until the program ends, contexts come and go.
std::mutex g_display_mutex;

/// Null when the display cannot be opened or cannot give desktop OpenGL contexts without surface and configuration.
EGLDisplay usable(EGLDisplay display) {
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor)) return EGL_NO_DISPLAY;
  const bool works = epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context") &&
                     epoxy_has_egl_extension(display, "EGL_KHR_no_config_context");
  return works ? display : EGL_NO_DISPLAY;
}

EGLDisplay open_device_display() {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") ||
      !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration"))
    return EGL_NO_DISPLAY;
  EGLint count = 0;
  if (!eglQueryDevicesEXT(0, nullptr, &count) || count <= 0) return EGL_NO_DISPLAY;
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  if (!eglQueryDevicesEXT(count, devices.data(), &count)) return EGL_NO_DISPLAY;
  for (EGLDeviceEXT device : devices) {
    const EGLDisplay display = usable(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
    if (display != EGL_NO_DISPLAY) return display;
  }
  return EGL_NO_DISPLAY;
}

EGLDisplay open_display() {
  const std::lock_guard lock(g_display_mutex);
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base"))
    throw std::runtime_error("cannot draw without a display: this EGL library has no EGL_EXT_platform_base");
  EGLDisplay display = EGL_NO_DISPLAY;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    display = usable(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  if (display == EGL_NO_DISPLAY) display = open_device_display();
  if (display == EGL_NO_DISPLAY)
    throw std::runtime_error("cannot draw without a display: EGL offers neither a surfaceless nor a device display "
                             "(on Debian, install libegl-mesa0 and libgl1-mesa-dri)");
  return display;
}

} // namespace

GlContext::GlContext() : handles_(std::make_unique<Handles>()) {
  handles_->display = open_display();
  if (!eglBindAPI(EGL_OPENGL_API)) throw std::runtime_error("cannot draw: EGL has no desktop OpenGL");
  const EGLint attributes[] = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  handles_->context = eglCreateContext(handles_->display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (handles_->context == EGL_NO_CONTEXT)
    throw std::runtime_error(fmt::format("cannot draw: no OpenGL 3.3 core context (EGL error {:#x})", eglGetError()));
  make_current();
}

GlContext::~GlContext() {
  if (handles_->context == EGL_NO_CONTEXT) return;
  if (eglGetCurrentContext() == handles_->context)
    eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(handles_->display, handles_->context);
}

void GlContext::make_current() const {
  if (!eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, handles_->context))
    throw std::runtime_error(
        fmt::format("cannot draw: the OpenGL context is refused (EGL error {:#x})", eglGetError()));
}

std::string GlContext::description() const {
  make_current();
  const auto text = [](GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); };
  return fmt::format("{}, OpenGL {}", text(GL_RENDERER), text(GL_VERSION));
}

} // namespace tutu::app
