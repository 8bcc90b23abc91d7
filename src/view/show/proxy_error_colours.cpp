#include "src/view/show/proxy_error_colours.h"

#include "src/view/render/error_colours.h"

namespace tutu::app {

std::span<const Colour> ProxyErrorColours::update(std::span<const Vec3f> positions,
                                                  std::span<const proxies::Capsule> colliders,
                                                  const ErrorScale& scale) {
  union_.assign(colliders);
  colours_.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
    colours_[v] = error_colour(scale, union_.distance(positions[v].cast<double>()));
  return colours_;
}

} // namespace tutu::app
