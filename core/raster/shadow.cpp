#include "shadow.hpp"

#include <algorithm>

namespace carom::raster {

namespace {

constexpr int kMostCells = 256;  // along an axis

struct Cells {
    int low, high;
};
Cells touched(float at, float reach, float low, float per, int cells) {
    const auto cell = [&](float x) { return int(clamp((x - low) * per, 0, float(cells - 1))); };
    return {cell(at - reach), cell(at + reach)};
}

}  // namespace

void Casters::find(const std::vector<Ball>& balls, const Look& look, F3 lamp) {
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
    first_.assign(1, 0);
    all_.clear();
    seen_.assign(n, -1);
    for (int i = 0; i < n; ++i) {
        const Place& p = places_[i];
        const float radius = balls[i].radius;
        const Cells x = touched(p.a, radius, low_[0], per_[0], cells_);
        const Cells y = touched(p.b, radius, low_[1], per_[1], cells_);
        for (int row = y.low; row <= y.high; ++row) {
            for (int cell = row * cells_ + x.low; cell <= row * cells_ + x.high; ++cell) {
                for (int k = starts_[cell]; k < starts_[cell + 1]; ++k) {
                    const int j = inside_[k];
                    const float gap = places_[j].height - p.height;
                    if (gap <= 0 || seen_[j] == i) continue;
                    seen_[j] = i;
                    const float da = places_[j].a - p.a, db = places_[j].b - p.b;
                    const float r = balls[j].radius, wide = half_shadow(look, gap);
                    const float reach = radius + r + wide;
                    if (da * da + db * db < reach * reach && r * r > kFaintest * wide * wide)
                        all_.push_back(j);
                }
            }
        }
        first_.push_back(int(all_.size()));
    }
    all_.push_back(0);  // so that there is a place to point at
}

void Casters::sort_into_cells(const std::vector<Ball>& balls, const Look& look) {
    const int n = int(balls.size());
    float high[2];
    lowest_ = places_[0].height;
    low_[0] = high[0] = places_[0].a, low_[1] = high[1] = places_[0].b;
    for (const Place& p : places_) {
        low_[0] = std::min(low_[0], p.a), high[0] = std::max(high[0], p.a);
        low_[1] = std::min(low_[1], p.b), high[1] = std::max(high[1], p.b);
        lowest_ = std::min(lowest_, p.height);
    }
    cells_ = std::clamp(int(std::sqrt(float(n))), 1, kMostCells);
    for (int k = 0; k < 2; ++k) per_[k] = float(cells_) / std::max(high[k] - low_[k], 1e-30f);
    starts_.assign(size_t(cells_) * cells_ + 1, 0);
    const auto each = [&](auto&& use) {
        for (int i = 0; i < n; ++i) {
            const Place& p = places_[i];
            const float reach = balls[i].radius + half_shadow(look, p.height - lowest_);
            const Cells x = touched(p.a, reach, low_[0], per_[0], cells_);
            const Cells y = touched(p.b, reach, low_[1], per_[1], cells_);
            for (int row = y.low; row <= y.high; ++row)
                for (int column = x.low; column <= x.high; ++column) use(row * cells_ + column, i);
        }
    };
    each([&](int cell, int) { ++starts_[cell + 1]; });
    for (size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
    inside_.resize(starts_.back());
    std::vector<int> next(starts_.begin(), starts_.end() - 1);
    each([&](int cell, int i) { inside_[next[cell]++] = i; });
}

}  // namespace carom::raster
