// Light that falls on a wall, as a picture on it in several sizes: what changes over a long way is
// drawn into a small one, which costs little, and all are put together at the end.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "picture.hpp"

namespace carom::raster {

class LightMap {
public:
    // finest: length over which the finest things drawn change; sides: of the wall.
    LightMap(float side_u, float side_v, float finest);

    void clear();

    // Takes light away around (u, v), places on the wall as lengths from its corner, as far as
    // `reach` along both sides. dark(du, dv): what is taken; it changes over a length `scale`.
    template <class Dark>
    void splat(float u, float v, float reach_u, float reach_v, float scale, Dark dark) {
        Level& level = level_for(scale);
        const int n = level.n;
        const float step_u = side_u_ / float(n), step_v = side_v_ / float(n);
        const Span columns =
            span(double(u - reach_u) / step_u - 0.5, double(u + reach_u) / step_u - 0.5, n);
        const Span rows =
            span(double(v - reach_v) / step_v - 0.5, double(v + reach_v) / step_v - 0.5, n);
        for (int j = rows.first; j <= rows.last; ++j) {
            float* const light = &level.light[size_t(j) * n];
            const float dv = (float(j) + 0.5f) * step_v - v;
            for (int i = columns.first; i <= columns.last; ++i)
                light[i] *= 1 - dark((float(i) + 0.5f) * step_u - u, dv);
        }
    }

    // Puts all sizes together; the finest has everything then.
    void merge();
    std::vector<float>& finest() {
        levels_.back().used = true;  // whoever writes into it
        return levels_.back().light;
    }

    // Light at a place, 0 to 1 along both sides; after `merge`.
    float at(float u, float v) const {
        const Level& level = levels_.back();
        const float most = float(level.n - 1);
        const float x = clamp(u * float(level.n) - 0.5f, 0, most);
        const float y = clamp(v * float(level.n) - 0.5f, 0, most);
        const int i = std::min(int(x), level.n - 2), j = std::min(int(y), level.n - 2);
        const float right = x - float(i), far = y - float(j);
        const float* const row = &level.light[size_t(j) * level.n + i];
        const float* const next = row + level.n;
        const float near_side = row[0] + (row[1] - row[0]) * right;
        return near_side + (next[0] + (next[1] - next[0]) * right - near_side) * far;
    }

private:
    struct Level {
        int n;
        bool used;
        std::vector<float> light;
    };
    Level& level_for(float scale);

    float side_u_, side_v_;
    std::vector<Level> levels_;  // from coarse to fine, each twice the size of the one before
};

}  // namespace carom::raster
