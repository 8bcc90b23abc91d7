// What of a scene is drawn: every layer with its name, its key and what it is, in one table.
#pragma once

#include <array>

namespace tutu::app {

struct Layers {
  bool body = true, cloth = true, ground = true;
  bool wireframe = false, particles = false;
  bool skeleton = false, joints = false;
  bool proxies = false, boxes = false, sweeps = false;
  bool strain = false, attachments = false;
  bool tiles = false, contacts = false;
  bool proxy_error = false; ///< the skin in the colours of its distance from the proxies
  bool penetration = false; ///< the cloth in the colours of its depth in the true body
};

struct LayerInfo {
  char key;         ///< in the window, as it stands on the key without Shift
  const char* name; ///< on the command line
  const char* what;
  bool Layers::*member;
};

inline constexpr std::array<LayerInfo, 16> k_layers = {{
    {'b', "body", "the skinned body", &Layers::body},
    {'c', "cloth", "the garments", &Layers::cloth},
    {'g', "ground", "the floor", &Layers::ground},
    {'w', "wireframe", "triangles of body and cloth", &Layers::wireframe},
    {'p', "particles", "the cloth's particles", &Layers::particles},
    {'k', "skeleton", "segments between joints", &Layers::skeleton},
    {'f', "joints", "frames of the joints", &Layers::joints},
    {'x', "proxies", "spheres and capsules", &Layers::proxies},
    {'o', "boxes", "swept boxes of the proxies", &Layers::boxes},
    {'v', "sweeps", "what proxies pass through in the frame", &Layers::sweeps},
    {'s', "strain", "threads and diagonals by their strain", &Layers::strain},
    {'h', "attachments", "what is pinned and what is sewn", &Layers::attachments},
    {'t', "tiles", "broad phase: tiles and their candidates", &Layers::tiles},
    {'a', "contacts", "what touches a proxy, with depth", &Layers::contacts},
    {'e', "proxy-error", "the skin's distance from the proxies", &Layers::proxy_error},
    {'d', "penetration", "the cloth's depth in the true body", &Layers::penetration},
}};

} // namespace tutu::app
