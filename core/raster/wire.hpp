// Spheres of latitude and longitude lines: the paper's look, and spherical walls. The same as the
// page's shaders.
#pragma once

#include "picture.hpp"

namespace carom::raster {

// A sphere of wires, those in front brighter than those behind.
void draw_wires(const View& view, const Look& look, const Ball& ball, F3 color, Frame& frame);

enum class Half { far, near };
// Half of a spherical wall about the origin, so that spheres can lie between.
void draw_shell(const View& view, const Look& look, double radius, Half half, Frame& frame);

}  // namespace carom::raster
