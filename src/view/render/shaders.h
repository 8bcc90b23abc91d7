// The GLSL sources. Lighting is linear; the last line of each fragment shader encodes sRGB.
#pragma once

namespace tutu::app::shaders {

extern const char* const k_preamble;          ///< version and shared uniforms, before every source
extern const char* const k_fragment_preamble; ///< shared functions, between that and every fragment source

extern const char* const k_surface_vertex;
extern const char* const k_surface_fragment;
extern const char* const k_wire_fragment; ///< with the surface's vertex shader

extern const char* const k_depth_vertex;
extern const char* const k_depth_fragment;

extern const char* const k_fullscreen_vertex;
extern const char* const k_ground_mask_fragment;
extern const char* const k_blur_fragment;
extern const char* const k_backdrop_fragment;

extern const char* const k_ground_vertex;
extern const char* const k_ground_fragment;

extern const char* const k_capsule_vertex;
extern const char* const k_capsule_fragment;

extern const char* const k_line_vertex;
extern const char* const k_line_fragment;

extern const char* const k_point_vertex;
extern const char* const k_point_fragment;

} // namespace tutu::app::shaders
