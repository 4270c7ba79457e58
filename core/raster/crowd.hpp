// How much light is left inside a crowd of spheres: a coarse grid of what they hide, swept from
// six sides. It makes the middle of a dense fluid darker, smoothly, as no single shadow could.
// The same as the page's crowd.js.
#pragma once

#include <vector>

#include "picture.hpp"

namespace carom::raster {

class Crowd {
public:
    // low, high: corners of the room; cell: wanted length of a cell's side; up: where the sky is.
    Crowd(const Vec3& low, const Vec3& high, double cell, const Vec3& up);

    // With the first n spheres.
    void fill(const std::vector<Vec3>& position, const std::vector<double>& radius, size_t n);

    // How much is left at a place, 0 to 1, between the cells in proportion; and half of what it
    // changes from `far` before to `far` behind it, along each axis. Both in the eye's space.
    struct Light {
        float left;
        F3 slope;
    };
    Light about(F3 center, float far, const View& view) const;

private:
    void spread(const std::vector<Vec3>& position, const std::vector<double>& radius, size_t n);
    void sweep(int axis, bool forward, float share);

    double low_[3], size_[3], per_[3];
    int cells_[3];
    int axis_;
    bool upwards_;
    std::vector<float> hidden_, light_, passed_;
};

}  // namespace carom::raster
