// Light that falls on a wall, as a picture on it in several sizes: what changes over a long way is
// drawn into a small one, which costs little, and all are put together at the end.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "picture.hpp"

namespace carom::raster {

// What a map of n × n places says at one between them, 0 to 1 along both sides.
template <class Number>
CAROM_INLINE float between(const Number* light, int n, float u, float v) {
    const float most = float(n - 1);
    const float x = clamp(u * float(n) - 0.5f, 0, most);
    const float y = clamp(v * float(n) - 0.5f, 0, most);
    const int i = std::min(int(x), n - 2), j = std::min(int(y), n - 2);
    const float right = x - float(i), far = y - float(j);
    const Number* const row = light + (j * n + i);
    const Number* const next = row + n;
    const float near_row = float(row[0]) + float(row[1] - row[0]) * right;
    return near_row + (float(next[0]) + float(next[1] - next[0]) * right - near_row) * far;
}

class LightMap {
public:
    // finest: length over which the finest things drawn change; sides: of the wall.
    LightMap(float side_u, float side_v, float finest);

    void clear();

    // Takes light away around (u, v), places on the wall as lengths from its corner, as far as
    // `reach` along both sides. dark(du, dv): what is taken; it changes over a length `scale`. To
    // be part of whoever calls it, for his instruction set.
    template <class Dark>
    CAROM_INLINE void splat(float u, float v, float reach_u, float reach_v, float scale,
                            Dark dark) {
        Level& level = level_for(scale);
        const int n = level.n;
        const float step_u = side_u_ / float(n), step_v = side_v_ / float(n);
        const Span columns =
            span(double(u - reach_u) / step_u - 0.5, double(u + reach_u) / step_u - 0.5, n);
        const Span rows =
            span(double(v - reach_v) / step_v - 0.5, double(v + reach_v) / step_v - 0.5, n);
        // Whole vectors: beyond its reach a thing must take nothing.
        const int first = columns.first / kLanes * kLanes;
        const int count = (columns.last - first + kLanes) / kLanes * kLanes;
        for (int j = rows.first; j <= rows.last; ++j) {
            float* const light = &level.light[size_t(j) * n + first];
            const float dv = (float(j) + 0.5f) * step_v - v;
            const float du = (float(first) + 0.5f) * step_u - u;
            for (int k = 0; k < count; ++k) light[k] *= 1 - dark(du + float(k) * step_u, dv);
        }
    }

    // Puts all sizes together; the finest has everything then.
    void merge();
    const std::vector<float>& finest() const { return levels_.back().light; }
    int places() const { return levels_.back().n; }  // along a side of the finest

private:
    static constexpr int kLanes = 8;  // places to a step of the loop
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
