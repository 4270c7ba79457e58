// The walls: flat ones with a fine grid and the shadows that fall on them, and lines.
#pragma once

#include "light_map.hpp"
#include "shadow.hpp"
#include "visibility.hpp"

namespace carom::raster {

// A flat wall as it is seen.
class Wall {
public:
    Wall(const View& view, const Look& look, const Face& face);

    // A breath of colour, lightest in the middle, and the grid.
    void paint(Frame& frame);
    // What spheres take away of its light, and where it is seen. Both maps are only for the moment.
    void light(const std::vector<Ball>& balls, LightMap& shadows, LightMap& spots);
    void darken(const Visibility& seen, Frame& frame) const;
    Bounds darkened() const { return dark_ ? bounds_ : Bounds{}; }  // pixels

private:
    // Where a ray meets it.
    struct Point {
        float u, v;              // 0 to 1 along the sides
        float cover, rim;        // is it there; how much of an endless plane has not faded
        float slope_u, slope_v;  // change of u and v over a pixel
    };
    Point at(float x, float y) const;

    void shadow(const std::vector<Ball>& balls, F3 lamp, LightMap& map) const;
    void spot(const std::vector<Ball>& balls, LightMap& map) const;
    template <bool fades>
    void darken(const int* first, int n, float y, float* pixels) const;
    void darken_row(const int* first, int n, float y, float* pixels) const;

    View view_;
    Look look_;
    Face face_;
    F3 corner_, u_, v_, normal_;
    F3 along_u_, along_v_;  // u = along_u·d / normal·d for a ray d
    float level_;           // normal · corner
    Bounds bounds_;
    std::vector<Span> columns_;  // of each row, where it is seen
    bool dark_ = false;          // does anything take light away?
    WallLight light_;
};

// A line, where no sphere is before it.
void draw(const View& view, const Look& look, const Edge& edge, const Visibility& seen,
          Frame& frame);

}  // namespace carom::raster
