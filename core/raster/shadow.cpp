#include "shadow.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace carom::raster {

namespace {
constexpr int kMostCells = 256, kMostSlabs = 64;  // along an axis

// Half-shadows are wider than a ball of this radius from here on above it.
float far_above(float radius, const Look& look) {
    const bool none = look.soft + kLamp * look.deepest <= radius;
    return none ? std::numeric_limits<float>::infinity()
                : std::max(radius - look.soft, 0.0f) / kLamp;
}
}

// Balls are asked about cell by cell, so that what they need is at hand.
void Casters::find(const std::vector<Ball>& balls, const Look& look, F3 lamp) {
    lamp_ = lamp;
    const int n = int(balls.size());
    const F3 other = std::abs(lamp.y) < 0.9f ? F3{0, 1, 0} : F3{1, 0, 0};
    F3 a = other - lamp * dot(other, lamp);
    a = a * (1 / std::sqrt(dot(a, a)));
    const F3 b{a.y * lamp.z - a.z * lamp.y, a.z * lamp.x - a.x * lamp.z,
               a.x * lamp.y - a.y * lamp.x};
    places_.resize(n);
    for (int i = 0; i < n; ++i)
        places_[i] = {dot(balls[i].center, a), dot(balls[i].center, b), dot(balls[i].center, lamp)};
    sort_into_cells(balls, look);
    all_.clear();
    begin_.resize(n), end_.resize(n), left_.resize(n);
    asked_.assign(n, -1);
    for (int cell = 0; cell < cells_ * cells_; ++cell) {
        for (int at = starts_[cell * slabs_]; at < starts_[(cell + 1) * slabs_]; ++at) {
            const int i = inside_[at];
            if (cell_of(places_[i]) == cell && !balls[i].samples.y.empty()) ask(i, cell, balls, look);
        }
    }
}

Casters::Cells Casters::touched(float at, float reach, int axis) const {
    const auto cell = [&](float x) {
        return int(clamp((x - low_[axis]) * per_[axis], 0, float(cells_ - 1)));
    };
    return {cell(at - reach), cell(at + reach)};
}

int Casters::slab(float height) const {
    return int(clamp((height - lowest_) * per_slab_, 0, float(slabs_ - 1)));
}

// What some entries leave of the lamp at a place, those farther above it than `far`.
CAROM_WIDE float Casters::dimmed(int first, int last, const Place& p, float far,
                                 const Look& look) const {
    float left[kLanes];
    for (float& lane : left) lane = 1;
    const float *const a = a_.data(), *const b = b_.data();
    const float *const height = height_.data(), *const radius = radius_.data();
    for (int k = first; k < last; k += kLanes) {
        for (int lane = 0; lane < kLanes; ++lane) {
            const int at = k + lane;
            const float da = a[at] - p.a, db = b[at] - p.b, r = radius[at];
            const float gap = height[at] - p.height, wide = half_shadow(look, gap);
            const float dark = hidden(std::sqrt(da * da + db * db), r, wide);
            const bool counts =
                (at < last) & (gap > far) & (r * r >= kFaintest * wide * wide);
            left[lane] *= counts ? 1 - dark : 1;
        }
    }
    return ((left[0] * left[1]) * (left[2] * left[3])) *
           ((left[4] * left[5]) * (left[6] * left[7]));
}

// Writes down those entries whose shadows reach a ball, no farther above it than `far`.
CAROM_WIDE void Casters::collect(int first, int last, int ball, float far,
                                 const std::vector<Ball>& balls, const Look& look) {
    const Place p = places_[ball];
    const float radius = balls[ball].radius;
    const F3 creep = lamp_ * (kCreeps * radius);
    const float *const a = a_.data(), *const b = b_.data();
    const float *const height = height_.data(), *const r = radius_.data();
    for (int k = first; k < last; k += kLanes) {
        unsigned counts = 0;
        for (int lane = 0; lane < kLanes; ++lane) {
            const int at = k + lane;
            const float da = a[at] - p.a, db = b[at] - p.b, gap = height[at] - p.height;
            const float wide = half_shadow(look, gap), reach = radius + r[at] + wide;
            const int does = int(at < last) & int(gap > 0) & int(gap <= far) &
                             int(da * da + db * db < reach * reach) &
                             int(r[at] * r[at] >= kFaintest * wide * wide);
            counts |= unsigned(does) << lane;
        }
        for (; counts; counts &= counts - 1) {
            const int j = inside_[k + std::countr_zero(counts)];
            if (asked_[j] == ball) continue;  // met in another cell
            asked_[j] = ball;
            all_.push_back({balls[j].center - creep, balls[j].radius});
        }
    }
}

// Half-shadows wider than the ball are the same all over it: those are asked at its middle. The
// others, close behind what casts them, are left to each place on the ball.
void Casters::ask(int i, int cell, const std::vector<Ball>& balls, const Look& look) {
    const Place& p = places_[i];
    const float radius = balls[i].radius, far = far_above(radius, look);
    const int from = slab(p.height), to = slab(p.height + far);
    left_[i] = dimmed(starts_[cell * slabs_ + to], starts_[(cell + 1) * slabs_], p, far, look);
    begin_[i] = int(all_.size());
    // A usual ball's casters all reach its middle's cell, see `sort_into_cells`.
    const float reach = std::max(2 * radius - usual_, 0.0f);
    const Cells x = touched(p.a, reach, 0), y = touched(p.b, reach, 1);
    for (int row = y.low; row <= y.high; ++row) {
        for (int at = row * cells_ + x.low; at <= row * cells_ + x.high; ++at)
            collect(starts_[at * slabs_ + from], starts_[at * slabs_ + to + 1], i, far, balls,
                    look);
    }
    end_[i] = int(all_.size());
}

int Casters::cell_of(const Place& p) const {
    return touched(p.b, 0, 1).low * cells_ + touched(p.a, 0, 0).low;
}

void Casters::sort_into_cells(const std::vector<Ball>& balls, const Look& look) {
    const int n = int(balls.size());
    float high[2] = {places_[0].a, places_[0].b}, highest = places_[0].height;
    low_[0] = high[0], low_[1] = high[1], lowest_ = highest;
    for (const Place& p : places_) {
        low_[0] = std::min(low_[0], p.a), high[0] = std::max(high[0], p.a);
        low_[1] = std::min(low_[1], p.b), high[1] = std::max(high[1], p.b);
        lowest_ = std::min(lowest_, p.height), highest = std::max(highest, p.height);
    }
    // Half-shadows that change within a ball are no wider than that, so they reach its middle from
    // two of its radii beside who casts them.
    usual_ = 0;
    for (const Ball& ball : balls) usual_ += 2 * ball.radius / float(n);
    const auto reach = [&](int i) {
        const float wide = half_shadow(look, places_[i].height - lowest_);
        return balls[i].radius + std::max(wide, usual_);
    };
    float reaches = 0, near = 0;
    for (int i = 0; i < n; ++i) {
        reaches += reach(i);
        near += std::min(far_above(balls[i].radius, look), highest - lowest_);
    }
    // Larger than what is put into them, by half: such cells cost least.
    const float size = std::max(high[0] - low_[0], high[1] - low_[1]);
    cells_ = int(clamp(0.7f * size * float(n) / std::max(reaches, 1e-30f), 1, kMostCells));
    for (int k = 0; k < 2; ++k) per_[k] = float(cells_) / std::max(high[k] - low_[k], 1e-30f);
    slabs_ = int(clamp((highest - lowest_) * float(n) / std::max(near, 1e-30f), 1, kMostSlabs));
    per_slab_ = float(slabs_) / std::max(highest - lowest_, 1e-30f);
    starts_.assign(size_t(cells_) * cells_ * slabs_ + 1, 0);
    const auto each = [&](auto&& use) {
        for (int i = 0; i < n; ++i) {
            const Place& p = places_[i];
            const Cells x = touched(p.a, reach(i), 0), y = touched(p.b, reach(i), 1);
            const int at = slab(p.height);
            for (int row = y.low; row <= y.high; ++row)
                for (int column = x.low; column <= x.high; ++column)
                    use((row * cells_ + column) * slabs_ + at, i);
        }
    };
    each([&](int bin, int) { ++starts_[bin + 1]; });
    for (size_t bin = 1; bin < starts_.size(); ++bin) starts_[bin] += starts_[bin - 1];
    const size_t all = starts_.back();
    inside_.resize(all);
    for (std::vector<float>* const row : {&a_, &b_, &height_, &radius_}) row->resize(all + kLanes);
    next_.assign(starts_.begin(), starts_.end() - 1);
    each([&](int bin, int i) {
        const int at = next_[bin]++;
        inside_[at] = i, radius_[at] = balls[i].radius;
        a_[at] = places_[i].a, b_[at] = places_[i].b, height_[at] = places_[i].height;
    });
}

}  // namespace carom::raster
