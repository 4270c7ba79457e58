// Shadows of spheres on one another, without a map: who stands between a sphere and the lamp is
// found once per sphere, and each place on it then asks those few.
#pragma once

#include <utility>
#include <vector>

#include "picture.hpp"

namespace carom::raster {

constexpr float kLamp = 0.075f;     // the lamp's radius over its distance: half-shadows widen so
constexpr float kFaintest = 0.03f;  // shadows that hide less of the lamp are left out

// Radius of the half-shadow at a distance behind what casts it.
inline float half_shadow(const Look& look, float gap) {
    return look.soft + kLamp * (gap < look.deepest ? gap : look.deepest);
}

// The part of the lamp that a disc of radius r hides from a place at a distance s from the line
// through its middle to the lamp; the lamp's disc is drawn there with radius `wide`.
inline float hidden(float s, float r, float wide) {
    const float inner = r > wide ? r - wide : wide - r;
    const float most = r < wide ? r * r / (wide * wide) : 1.0f;
    const float share = clamp((s - inner) / (r + wide - inner));
    return most * (1 - share * share * (3 - 2 * share));
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
    // lamp: unit vector towards it. Both know only balls about which `ask` has asked.
    void begin(const std::vector<Ball>& balls, const Look& look, F3 lamp);
    void ask(int ball, const std::vector<Ball>& balls, const Look& look);
    void clear() { begin_.clear(); }

    bool any() const { return !begin_.empty(); }
    // Those whose shadows change within a visible ball.
    const int* begin(int ball) const { return &all_[0] + begin_[ball]; }
    const int* end(int ball) const { return &all_[0] + end_[ball]; }
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
    void sort_into_cells(const std::vector<Ball>& balls, const Look& look);
    float dimmed(int first, int last, const Place& p, const Look& look) const;
    int reaching(int first, int last, const Place& p, float radius, const Look& look);

    static constexpr int kLanes = 8;  // entries to a step of the loop

    std::vector<Place> places_;
    std::vector<std::pair<float, int>> order_;  // heights, upside down: from the lamp on
    float low_[2] = {}, per_[2] = {};
    int cells_ = 1;            // along each axis
    std::vector<int> starts_;  // of the cells' entries
    // Spheres by cell, from the lamp on.
    std::vector<int> inside_;
    std::vector<float> a_, b_, height_, radius_;
    std::vector<uint8_t> counts_;  // those of a cell whose shadows reach a ball: which, and who
    std::vector<int> reaching_;
    std::vector<int> asked_;  // by whom last
    std::vector<int> begin_, end_, all_;
    std::vector<float> left_;
};

}  // namespace carom::raster
