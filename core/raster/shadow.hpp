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
    void clear() { found_.clear(); }

    bool any() const { return !found_.empty(); }
    // Those whose shadows change within a ball.
    const Caster* begin(int ball) const { return casters_.data() + found_[ball].first; }
    const Caster* end(int ball) const { return casters_.data() + found_[ball].last; }
    // What the others leave of the lamp, for the whole ball.
    float left(int ball) const { return found_[ball].left; }

private:
    // A ball across the light, and towards the lamp.
    struct alignas(16) Place {
        float a, b, height, radius;
    };
    // Who may cast shadows into a cell across the light, by height, as rows for the loops.
    struct Column {
        int cell = -1, first = 0;  // of all entries
        std::vector<int> who;
        std::vector<float> a, b, height, radius;
    };
    struct Range {
        int low, high;
    };
    struct Found {
        int first = 0, last = 0;
        float left = 1;
    };
    Range touched(float at, float reach, int axis) const;
    int slab(float height) const;
    int start(int cell, int slab_) const { return starts_[size_t(cell) * slabs_ + slab_]; }
    void sort_into_cells(const Look& look);
    void load(int cell, Column& column) const;
    void ask(int ball, const Column& column, const Look& look);
    float dimmed(const Column& column, int first, const Place& p, float far,
                 const Look& look) const;
    void collect(const Column& column, int first, int last, int ball, float far, const Look& look);

    F3 axes_[3];  // of places, in the eye's space
    std::vector<Place> places_;
    float low_[2] = {}, per_[2] = {}, lowest_ = 0, per_slab_ = 0;  // of cells and their slabs
    float usual_ = 0;                                              // diameter
    int cells_ = 1, slabs_ = 1;                                    // along each axis
    std::vector<int> own_;                                         // cells of the balls' middles
    std::vector<int> starts_, next_, inside_;                      // balls by cell and slab
    Column here_, beside_;
    std::vector<int> asked_;  // by whom last
    std::vector<Found> found_;
    std::vector<Caster> casters_;
};

}  // namespace carom::raster
