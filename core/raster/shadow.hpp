// Shadows of spheres on one another, without a map: who stands between a sphere and the lamp is
// found once per sphere, and each place on it then asks those few.
#pragma once

#include <vector>

#include "picture.hpp"

namespace carom::raster {

constexpr float kLamp = 0.075f;     // the lamp's radius over its distance: half-shadows widen so
constexpr float kCreeps = 0.12f;    // radii that light creeps round an edge
constexpr float kFaintest = 0.03f;  // shadows that hide less of the lamp are left out

// Radius of the half-shadow at a distance behind what casts it.
inline float half_shadow(const Look& look, float gap) {
    return look.soft + kLamp * (gap < look.deepest ? gap : look.deepest);
}

// The part of the lamp that a disc of radius r hides from a place at a distance s from the line
// through its middle to the lamp; the lamp's disc is drawn there with radius `wide`.
inline float hidden(float s, float r, float wide) {
    const float per = 1 / (r * wide), larger = r > wide ? r : wide;
    const float ratio = clamp(r * r * per), inner = std::abs(r - wide);
    const float share = clamp((s - inner) * (0.5f * larger * per));
    return ratio * ratio * (1 - share * share * (3 - 2 * share));
}

// The same for many places behind one thing.
struct HalfShadow {
    float inner, per, most;
    HalfShadow(float r, float wide)
        : inner(std::abs(r - wide)),
          per(1 / (r + wide - inner)),
          most(r < wide ? r * r / (wide * wide) : 1.0f) {}
    float dark(float s) const {
        const float share = clamp((s - inner) * per);
        return most * (1 - share * share * (3 - 2 * share));
    }
};

class Casters {
public:
    // Who casts a shadow. The light creeps round a ball's edge, where its own shadow would be hard;
    // so casters are farther from the lamp, by a share of the radius of the ball that they darken.
    struct Caster {
        F3 center;
        float radius;
    };

    // Asks for all balls that may be in the picture. lamp: unit vector towards it.
    void find(const std::vector<Ball>& balls, const Look& look, F3 lamp);
    void clear() { begin_.clear(); }

    bool any() const { return !begin_.empty(); }
    // Those whose shadows change within a ball.
    const Caster* begin(int ball) const { return all_.data() + begin_[ball]; }
    const Caster* end(int ball) const { return all_.data() + end_[ball]; }
    // What the others leave of the lamp, for the whole ball.
    float left(int ball) const { return left_[ball]; }

private:
    struct Place {
        float a, b, height;  // across the light, and towards the lamp
    };
    struct Cells {
        int low, high;
    };
    Cells touched(float at, float reach, int axis) const;
    int slab(float height) const;
    void sort_into_cells(const std::vector<Ball>& balls, const Look& look);
    float dimmed(int first, int last, const Place& p, float far, const Look& look) const;
    void collect(int first, int last, int ball, float far, const std::vector<Ball>& balls,
                 const Look& look);
    void ask(int ball, int cell, const std::vector<Ball>& balls, const Look& look);
    int cell_of(const Place& p) const;

    F3 lamp_;
    std::vector<Place> places_;
    // Cells across the light, each cut into slabs by height.
    float low_[2] = {}, per_[2] = {}, lowest_ = 0, per_slab_ = 0;
    float usual_ = 0;  // diameter
    int cells_ = 1, slabs_ = 1;        // along each axis
    std::vector<int> starts_, next_;   // of the slabs' entries
    std::vector<int> inside_;          // spheres by slab: who, where
    std::vector<float> a_, b_, height_, radius_;
    std::vector<int> asked_;  // by whom last
    std::vector<int> begin_, end_;
    std::vector<Caster> all_;
    std::vector<float> left_;
};

}  // namespace carom::raster
