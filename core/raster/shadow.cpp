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

}  // namespace

// Balls are asked about cell by cell, so that what they need is at hand.
void Casters::find(const std::vector<Ball>& balls, const Look& look, F3 lamp) {
    const int n = int(balls.size());
    const F3 other = std::abs(lamp.y) < 0.9f ? F3{0, 1, 0} : F3{1, 0, 0};
    F3 a = other - lamp * dot(other, lamp);
    a = a * (1 / std::sqrt(dot(a, a)));
    const F3 b{a.y * lamp.z - a.z * lamp.y, a.z * lamp.x - a.x * lamp.z,
               a.x * lamp.y - a.y * lamp.x};
    axes_[0] = a, axes_[1] = b, axes_[2] = lamp;
    places_.resize(n);
    for (int i = 0; i < n; ++i) {
        const F3 c = balls[i].center;
        places_[i] = {dot(c, a), dot(c, b), dot(c, lamp), balls[i].radius};
    }
    sort_into_cells(look);
    casters_.clear();
    found_.resize(n);
    asked_.assign(n, -1);
    beside_.cell = -1;
    for (int cell = 0; cell < cells_ * cells_; ++cell) {
        load(cell, here_);
        for (size_t at = 0; at < here_.who.size(); ++at) {
            const int i = here_.who[at];
            if (own_[i] == cell && !balls[i].samples.y.empty()) ask(i, here_, look);
        }
    }
}

Casters::Range Casters::touched(float at, float reach, int axis) const {
    const auto cell = [&](float x) {
        return int(clamp((x - low_[axis]) * per_[axis], 0, float(cells_ - 1)));
    };
    return {cell(at - reach), cell(at + reach)};
}

int Casters::slab(float height) const {
    return int(clamp((height - lowest_) * per_slab_, 0, float(slabs_ - 1)));
}

void Casters::load(int cell, Column& column) const {
    column.cell = cell, column.first = start(cell, 0);
    const int n = start(cell + 1, 0) - column.first;
    column.who.assign(&inside_[column.first], &inside_[column.first] + n);
    for (std::vector<float>* const row : {&column.a, &column.b, &column.height, &column.radius})
        row->resize(size_t(n) + kLanes);
    for (int k = 0; k < n; ++k) {
        const Place& p = places_[column.who[k]];
        column.a[k] = p.a, column.b[k] = p.b;
        column.height[k] = p.height, column.radius[k] = p.radius;
    }
}

// What a column leaves of the lamp at a place, by those farther above it than `far`. first: the
// first that may be.
CAROM_WIDE float Casters::dimmed(const Column& column, int first, const Place& p, float far,
                                 const Look& look) const {
    float left[kLanes];
    for (float& lane : left) lane = 1;
    const int last = int(column.who.size());
    const float *const a = column.a.data(), *const b = column.b.data();
    const float *const height = column.height.data(), *const radius = column.radius.data();
    for (int k = first; k < last; k += kLanes) {
        for (int lane = 0; lane < kLanes; ++lane) {
            const int at = k + lane;
            const float da = a[at] - p.a, db = b[at] - p.b, r = radius[at];
            const float gap = height[at] - p.height, wide = half_shadow(look, gap);
            const float dark = hidden(std::sqrt(da * da + db * db), r, wide);
            const bool counts = (at < last) & (gap > far) & (r * r >= kFaintest * wide * wide);
            left[lane] *= counts ? 1 - dark : 1;
        }
    }
    return ((left[0] * left[1]) * (left[2] * left[3])) *
           ((left[4] * left[5]) * (left[6] * left[7]));
}

// Writes down those of a column whose shadows reach a ball, no farther above it than `far`.
CAROM_WIDE void Casters::collect(const Column& column, int first, int last, int ball, float far,
                                 const Look& look) {
    const Place p = places_[ball];
    const float *const a = column.a.data(), *const b = column.b.data();
    const float *const height = column.height.data(), *const radius = column.radius.data();
    for (int k = first; k < last; k += kLanes) {
        unsigned counts = 0;
        for (int lane = 0; lane < kLanes; ++lane) {
            const int at = k + lane;
            const float da = a[at] - p.a, db = b[at] - p.b, r = radius[at];
            const float gap = height[at] - p.height;
            const float wide = half_shadow(look, gap), reach = p.radius + r + wide;
            const int does = int(at < last) & int(gap > 0) & int(gap <= far) &
                             int(da * da + db * db < reach * reach) &
                             int(r * r >= kFaintest * wide * wide);
            counts |= unsigned(does) << lane;
        }
        for (; counts; counts &= counts - 1) {
            const int at = k + std::countr_zero(counts), who = column.who[at];
            if (asked_[who] == ball) continue;  // met in another cell
            asked_[who] = ball;
            const float high = height[at] - kCreeps * p.radius;
            casters_.push_back({axes_[0] * a[at] + axes_[1] * b[at] + axes_[2] * high, radius[at]});
        }
    }
}

// Half-shadows wider than the ball are the same all over it: those are asked at its middle. The
// others, close behind what casts them, are left to each place on the ball.
void Casters::ask(int i, const Column& column, const Look& look) {
    const Place& p = places_[i];
    const float far = far_above(p.radius, look);
    const int from = slab(p.height), to = slab(p.height + far);
    const auto near = [&](const Column& c) {
        collect(c, start(c.cell, from) - c.first, start(c.cell, to + 1) - c.first, i, far, look);
    };
    Found& found = found_[i];
    found.left = dimmed(column, start(column.cell, to) - column.first, p, far, look);
    found.first = int(casters_.size());
    // A usual ball's casters all reach its middle's cell, see `sort_into_cells`.
    near(column);
    if (2 * p.radius > usual_) {
        const float reach = 2 * p.radius - usual_;
        const Range x = touched(p.a, reach, 0), y = touched(p.b, reach, 1);
        for (int row = y.low; row <= y.high; ++row) {
            for (int cell = row * cells_ + x.low; cell <= row * cells_ + x.high; ++cell) {
                if (cell == column.cell) continue;
                if (cell != beside_.cell) load(cell, beside_);
                near(beside_);
            }
        }
    }
    found.last = int(casters_.size());
}

void Casters::sort_into_cells(const Look& look) {
    const int n = int(places_.size());
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
    for (const Place& p : places_) usual_ += 2.01f * p.radius / float(n);
    const auto reach = [&](const Place& p) {
        return p.radius + std::max(half_shadow(look, p.height - lowest_), usual_);
    };
    float reaches = 0, near = 0;
    for (const Place& p : places_) {
        reaches += reach(p);
        near += std::min(far_above(p.radius, look), highest - lowest_);
    }
    // Larger than what is put into them, by half: such cells cost least.
    const float size = std::max(high[0] - low_[0], high[1] - low_[1]);
    cells_ = int(clamp(0.7f * size * float(n) / std::max(reaches, 1e-30f), 1, kMostCells));
    for (int k = 0; k < 2; ++k) per_[k] = float(cells_) / std::max(high[k] - low_[k], 1e-30f);
    slabs_ = int(clamp((highest - lowest_) * float(n) / std::max(near, 1e-30f), 1, kMostSlabs));
    per_slab_ = float(slabs_) / std::max(highest - lowest_, 1e-30f);
    own_.resize(n);
    for (int i = 0; i < n; ++i)
        own_[i] = touched(places_[i].b, 0, 1).low * cells_ + touched(places_[i].a, 0, 0).low;
    starts_.assign(size_t(cells_) * cells_ * slabs_ + 1, 0);
    const auto each = [&](auto&& use) {
        for (int i = 0; i < n; ++i) {
            const Place& p = places_[i];
            const Range x = touched(p.a, reach(p), 0), y = touched(p.b, reach(p), 1);
            const int at = slab(p.height);
            for (int row = y.low; row <= y.high; ++row)
                for (int column = x.low; column <= x.high; ++column)
                    use((row * cells_ + column) * slabs_ + at, i);
        }
    };
    each([&](int bin, int) { ++starts_[bin + 1]; });
    for (size_t bin = 1; bin < starts_.size(); ++bin) starts_[bin] += starts_[bin - 1];
    inside_.resize(size_t(starts_.back()) + 1);
    next_.assign(starts_.begin(), starts_.end() - 1);
    each([&](int bin, int i) { inside_[next_[bin]++] = i; });
}

}  // namespace carom::raster
