// Light that falls on a wall, as a picture on it in several sizes: what changes over a long way is
// drawn into a small one, which costs little, and all are put together at the end.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "picture.hpp"

namespace carom::raster {

class LightMap {
public:
    // Full light on a wall of these sides. finest: length over which the finest things drawn
    // change.
    void begin(float side_u, float side_v, float finest);

    // Takes light away around (u, v), places on the wall as lengths from its corner, as far as
    // `reach` along both sides. dark(du, dv): what is taken; it changes over a length `scale`. To
    // be part of whoever calls it, for his instruction set.
    template <class Dark>
    CAROM_INLINE void splat(float u, float v, float reach_u, float reach_v, float scale,
                            Dark dark) {
        Level& level = level_for(scale);
        const int n = level.n;
        const float step_u = level.step_u, step_v = level.step_v;
        const float at_u = u * level.per_u - 0.5f, half_u = reach_u * level.per_u;
        const float at_v = v * level.per_v - 0.5f, half_v = reach_v * level.per_v;
        const Span columns = span(at_u - half_u, at_u + half_u, n);
        const Span rows = span(at_v - half_v, at_v + half_v, n);
        const int first = columns.first, count = whole_steps(columns.last + 1 - first);
        for (int j = rows.first; j <= rows.last; ++j) {
            float* const light = level.row(j) + first;
            const float dv = (float(j) + 0.5f) * step_v - v;
            const float du = (float(first) + 0.5f) * step_u - u;
            for (int k = 0; k < count; ++k) light[k] *= 1 - dark(du + float(k) * step_u, dv);
        }
    }

    // Puts all sizes together; the finest has everything then.
    void merge();
    bool any() const { return levels_[count_ - 1].used; }  // has anything been drawn?
    const float* row(int j) const { return levels_[count_ - 1].row(j); }  // of the finest
    int places() const { return levels_[count_ - 1].n; }  // along a side of the finest

private:
    struct Level {
        int n = 0;
        float step_u, step_v, per_u, per_v;  // sides of a place, and what they divide by
        bool used = false;                   // else its light is not up to date
        std::vector<float> light;

        int stride() const { return n + kLanes; }
        float* row(int j) { return &light[size_t(j) * stride()]; }
        const float* row(int j) const { return &light[size_t(j) * stride()]; }
    };
    Level& level_for(float scale);
    static void begin(Level& level);

    float wanted_ = 0;           // scale times places along a side, at least
    int count_ = 0;              // levels in use
    std::vector<Level> levels_;  // from coarse to fine, each twice the size of the one before
};

// What two maps leave together, to be asked for often and at any place.
class WallLight {
public:
    // Both of one size. shade: how much of all light goes with that of the first.
    void set(const LightMap& lamp, const LightMap& spots, float shade);

    // 0 to 1, between the map's places; u, v: 0 to 1 along both sides.
    CAROM_INLINE float at(float u, float v) const {
        const float most = float(n_ - 1);
        const float x = clamp(u * float(n_) - 0.5f, 0, most);
        const float y = clamp(v * float(n_) - 0.5f, 0, most);
        const int i = std::min(int(x), n_ - 2), j = std::min(int(y), n_ - 2);
        const float right = x - float(i), far = y - float(j);
        const uint32_t* const pairs = pairs_.data();
        const uint32_t row = pairs[j * n_ + i], next = pairs[j * n_ + n_ + i];
        const float near_row = between(row, right);
        return (near_row + (between(next, right) - near_row) * far) * (1.0f / 65535);
    }

private:
    // A pair is a place's light, of 65535, and above it its neighbour's: one look for both.
    CAROM_INLINE static float between(uint32_t pair, float right) {
        const float here = float(int(pair & 65535)), there = float(int(pair >> 16));
        return here + (there - here) * right;
    }

    int n_ = 2;
    std::vector<uint32_t> pairs_;
};

}  // namespace carom::raster
