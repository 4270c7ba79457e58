#include "shadow.hpp"

#include <algorithm>

namespace carom::raster {

namespace {
constexpr int kMostCells = 256;  // along an axis
}

void Casters::begin(const std::vector<Ball>& balls, const Look& look, F3 lamp) {
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
    all_.assign(1, 0);  // so that there is a place to point at
    begin_.resize(n), end_.resize(n), left_.resize(n);
    asked_.assign(n, -1);
}

Casters::Cells Casters::touched(float at, float reach, int axis) const {
    const auto cell = [&](float x) {
        return int(clamp((x - low_[axis]) * per_[axis], 0, float(cells_ - 1)));
    };
    return {cell(at - reach), cell(at + reach)};
}

// What some entries of a cell leave of the lamp at a place.
CAROM_WIDE float Casters::dimmed(int first, int last, const Place& p, const Look& look) const {
    float left[kLanes];
    for (float& lane : left) lane = 1;
    const float *const a = a_.data(), *const b = b_.data();
    const float *const height = height_.data(), *const radius = radius_.data();
    for (int k = first; k < last; k += kLanes) {
        for (int lane = 0; lane < kLanes; ++lane) {
            const int at = k + lane;
            const float da = a[at] - p.a, db = b[at] - p.b, r = radius[at];
            const float wide = half_shadow(look, height[at] - p.height);
            const float dark = hidden(std::sqrt(da * da + db * db), r, wide);
            const bool counts = (at < last) & (r * r >= kFaintest * wide * wide);
            left[lane] *= counts ? 1 - dark : 1;
        }
    }
    return ((left[0] * left[1]) * (left[2] * left[3])) *
           ((left[4] * left[5]) * (left[6] * left[7]));
}

// Which entries' shadows reach a ball: counts them and writes them down.
CAROM_WIDE int Casters::reaching(int first, int last, const Place& p, float radius,
                                 const Look& look) {
    const int n = last - first;
    const float *const a = &a_[first], *const b = &b_[first];
    const float *const height = &height_[first], *const r = &radius_[first];
    uint8_t* __restrict const counts = counts_.data();
    for (int k = 0; k < n; ++k) {
        const float da = a[k] - p.a, db = b[k] - p.b;
        const float wide = half_shadow(look, height[k] - p.height), reach = radius + r[k] + wide;
        const bool faint = r[k] * r[k] < kFaintest * wide * wide;
        counts[k] = uint8_t(int(da * da + db * db < reach * reach) & int(!faint));
    }
    int many = 0;
    for (int k = 0; k < n; ++k) {
        reaching_[many] = inside_[first + k];
        many += counts[k];
    }
    return many;
}

// Half-shadows wider than the ball are the same all over it: those are asked at its middle. The
// others, close behind what casts them, are left to each place on the ball.
void Casters::ask(int i, const std::vector<Ball>& balls, const Look& look) {
    const Place& p = places_[i];
    const float radius = balls[i].radius;
    // Entries are sorted by height: first those far above, then those near, then those behind.
    const bool all_near = look.soft + kLamp * look.deepest <= radius;
    const float far = std::max(radius - look.soft, 0.0f) / kLamp;
    const auto above = [&](int cell, float height) {
        const float* const all = height_.data();
        return int(std::partition_point(all + starts_[cell], all + starts_[cell + 1],
                                        [&](float its) { return its > height; }) -
                   all);
    };
    const auto far_end = [&](int cell) {
        return all_near ? starts_[cell] : above(cell, p.height + far);
    };
    const int middle = touched(p.b, 0, 1).low * cells_ + touched(p.a, 0, 0).low;
    left_[i] = dimmed(starts_[middle], far_end(middle), p, look);
    begin_[i] = int(all_.size());
    const Cells x = touched(p.a, radius, 0), y = touched(p.b, radius, 1);
    for (int row = y.low; row <= y.high; ++row) {
        for (int cell = row * cells_ + x.low; cell <= row * cells_ + x.high; ++cell) {
            const int many = reaching(far_end(cell), above(cell, p.height), p, radius, look);
            for (int k = 0; k < many; ++k) {
                const int j = reaching_[k];
                if (asked_[j] == i) continue;  // met in another cell
                asked_[j] = i;
                all_.push_back(j);
            }
        }
    }
    end_[i] = int(all_.size());
}

void Casters::sort_into_cells(const std::vector<Ball>& balls, const Look& look) {
    const int n = int(balls.size());
    order_.resize(n);
    for (int i = 0; i < n; ++i) order_[i] = {-places_[i].height, i};
    std::sort(order_.begin(), order_.end());
    const float lowest = -order_.back().first;
    const auto reach = [&](int i) {
        return balls[i].radius + half_shadow(look, places_[i].height - lowest);
    };
    float high[2] = {places_[0].a, places_[0].b};
    low_[0] = high[0], low_[1] = high[1];
    float sum = 0;
    for (int i = 0; i < n; ++i) {
        const Place& p = places_[i];
        low_[0] = std::min(low_[0], p.a), high[0] = std::max(high[0], p.a);
        low_[1] = std::min(low_[1], p.b), high[1] = std::max(high[1], p.b);
        sum += reach(i);
    }
    // Larger than what is put into them, by half: such cells cost least.
    const float size = std::max(high[0] - low_[0], high[1] - low_[1]);
    cells_ = int(clamp(0.7f * size * float(n) / std::max(sum, 1e-30f), 1, kMostCells));
    for (int k = 0; k < 2; ++k) per_[k] = float(cells_) / std::max(high[k] - low_[k], 1e-30f);
    starts_.assign(size_t(cells_) * cells_ + 1, 0);
    const auto each = [&](auto&& use) {
        for (const auto& [height, i] : order_) {
            const Cells x = touched(places_[i].a, reach(i), 0);
            const Cells y = touched(places_[i].b, reach(i), 1);
            for (int row = y.low; row <= y.high; ++row)
                for (int column = x.low; column <= x.high; ++column) use(row * cells_ + column, i);
        }
    };
    each([&](int cell, int) { ++starts_[cell + 1]; });
    counts_.resize(*std::max_element(starts_.begin(), starts_.end()));
    reaching_.resize(counts_.size() + 1);
    for (size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
    const size_t all = starts_.back();
    inside_.resize(all);
    for (std::vector<float>* const row : {&a_, &b_, &height_, &radius_}) row->resize(all + kLanes);
    std::vector<int> next(starts_.begin(), starts_.end() - 1);
    each([&](int cell, int i) {
        const int at = next[cell]++;
        inside_[at] = i, radius_[at] = balls[i].radius;
        a_[at] = places_[i].a, b_[at] = places_[i].b, height_[at] = places_[i].height;
    });
}

}  // namespace carom::raster
