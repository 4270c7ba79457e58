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

void Casters::find(const std::vector<Ball>& balls, const std::vector<uint8_t>& seen,
                   const Look& look, F3 lamp) {
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
    asked_.assign(n, -1);
    left_.assign(n, 1.0f);
    for (int i = 0; i < n; ++i) {
        if (seen[i]) left_[i] = ask(i, balls, look);
        first_.push_back(int(all_.size()));
    }
    all_.push_back(0);  // so that there is a place to point at
}

float Casters::ask(int i, const std::vector<Ball>& balls, const Look& look) {
    const Place& p = places_[i];
    const float radius = balls[i].radius;
    const Cells x = touched(p.a, radius, low_[0], per_[0], cells_);
    const Cells y = touched(p.b, radius, low_[1], per_[1], cells_);
    float left = 1;
    for (int row = y.low; row <= y.high; ++row) {
        for (int cell = row * cells_ + x.low; cell <= row * cells_ + x.high; ++cell) {
            for (int k = starts_[cell]; k < starts_[cell + 1]; ++k) {
                const int j = inside_[k];
                const float gap = places_[j].height - p.height;
                if (gap <= 0) break;  // all others of this cell are behind, too
                if (asked_[j] == i) continue;
                asked_[j] = i;
                const float da = places_[j].a - p.a, db = places_[j].b - p.b;
                const float r = balls[j].radius, wide = half_shadow(look, gap);
                const float reach = radius + r + wide, s2 = da * da + db * db;
                if (s2 >= reach * reach || r * r < kFaintest * wide * wide) continue;
                if (wide > radius)
                    left *= 1 - hidden(std::sqrt(s2), r, wide);
                else
                    all_.push_back(j);
            }
        }
    }
    return left;
}

void Casters::sort_into_cells(const std::vector<Ball>& balls, const Look& look) {
    const int n = int(balls.size());
    order_.resize(n);
    for (int i = 0; i < n; ++i) order_[i] = i;
    std::sort(order_.begin(), order_.end(), [&](int i, int j) {
        return places_[i].height != places_[j].height ? places_[i].height > places_[j].height
                                                      : i < j;
    });
    const float lowest = places_[order_.back()].height;
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
    // As large as what is put into them, about.
    const float size = std::max(high[0] - low_[0], high[1] - low_[1]);
    cells_ = int(clamp(size * float(n) / std::max(sum, 1e-30f), 1, kMostCells));
    for (int k = 0; k < 2; ++k) per_[k] = float(cells_) / std::max(high[k] - low_[k], 1e-30f);
    starts_.assign(size_t(cells_) * cells_ + 1, 0);
    const auto each = [&](auto&& use) {
        for (const int i : order_) {
            const Cells x = touched(places_[i].a, reach(i), low_[0], per_[0], cells_);
            const Cells y = touched(places_[i].b, reach(i), low_[1], per_[1], cells_);
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
