// What every shader that draws the picture wants to know of it.
#pragma once

#include "src/view/render/gl_objects.h"

namespace tutu::app {

struct PictureFit {
  Mat4f clip_from_world = Mat4f::Identity();
  Vec3f eye = Vec3f::Zero();
  Eigen::Vector2f picture = {1, 1}; ///< pixels
  Eigen::Vector2f corner = {0, 0};  ///< of the picture in the framebuffer, pixels
  float pixel_scale = 1;            ///< pixels of this picture to one of the finished picture
};

/// Puts `program` in use and sets the shared uniforms of its preamble.
inline void use_for_picture(const Program& program, const PictureFit& fit) {
  program.use();
  program.set("clip_from_world", fit.clip_from_world);
  program.set("eye", fit.eye);
  program.set("picture", fit.picture);
  program.set("picture_corner", fit.corner);
  program.set("pixel_scale", fit.pixel_scale);
}

} // namespace tutu::app
