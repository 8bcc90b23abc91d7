// OpenGL without a window or a display.
#pragma once

#include <memory>
#include <string>

namespace tutu::app {

/// An OpenGL 3.3 core context that owns no surface: what is drawn goes to framebuffer objects.
/// Works on a machine without a display or a graphics card (Mesa's software rasteriser).
class GlContext {
public:
  /// Makes itself current on this thread. Throws std::runtime_error that says what is missing.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Throws std::runtime_error when the driver refuses.
  void make_current() const;
  /// The driver's name and version, for reports.
  std::string description() const;

private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

} // namespace tutu::app
