#include "light_map.hpp"

namespace carom::raster {

namespace {
constexpr int kLeast = 32, kMost = 1024;  // places along a side
}

void LightMap::begin(float side_u, float side_v, float finest) {
    wanted_ = 1.25f * std::max(side_u, side_v) / 1.41f;
    count_ = 0;
    for (int n = kLeast; n <= kMost; n *= 2) {
        if (count_ == int(levels_.size())) levels_.emplace_back();
        Level& level = levels_[count_++];
        level.n = n, level.used = false;
        level.step_u = side_u / float(n), level.step_v = side_v / float(n);
        level.per_u = float(n) / side_u, level.per_v = float(n) / side_v;
        if (float(n) * finest >= wanted_) break;
    }
}

void LightMap::begin(Level& level) {
    if (level.used) return;
    level.light.assign(size_t(level.n) * level.stride(), 1.0f);
    level.used = true;
}

LightMap::Level& LightMap::level_for(float scale) {
    int k = 0;
    while (k + 1 < count_ && float(levels_[k].n) * scale < wanted_) ++k;
    begin(levels_[k]);
    return levels_[k];
}

namespace {

// Multiplies a row by what a coarser map says there. near_row, far_row: of that map, at a quarter
// and three quarters of its places from the row's middle.
CAROM_WIDE void refine(const float* __restrict near_row, const float* __restrict far_row, int n,
                       float* __restrict between, float* __restrict to) {
    for (int i = 0; i < n; ++i) between[i + 1] = 0.75f * near_row[i] + 0.25f * far_row[i];
    between[0] = between[1], between[n + 1] = between[n];
    for (int i = 0; i < n; ++i) {
        const float here = 0.75f * between[i + 1];
        to[2 * i] *= here + 0.25f * between[i];
        to[2 * i + 1] *= here + 0.25f * between[i + 2];
    }
}

// All spots and most of the lamp's light, as a row of pairs.
CAROM_WIDE void pair_up(const float* __restrict lamp, const float* __restrict spots, int n,
                        float shade, int* __restrict row, uint32_t* __restrict pairs) {
    for (int i = 0; i < n; ++i) row[i] = int(65535 * spots[i] * (1 - shade * (1 - lamp[i])) + 0.5f);
    row[n] = row[n - 1];
    for (int i = 0; i < n; ++i) pairs[i] = uint32_t(row[i]) | uint32_t(row[i + 1]) << 16;
}

}  // namespace

void LightMap::merge() {
    std::vector<float> between(size_t(kMost) + 2);
    for (int k = 0; k + 1 < count_; ++k) {
        const Level& coarse = levels_[k];
        Level& fine = levels_[k + 1];
        if (!coarse.used) continue;
        begin(fine);
        for (int j = 0; j < fine.n; ++j) {
            // The middle of a fine place lies at a quarter or three quarters between coarse ones.
            const auto row = [&](int at) { return coarse.row(std::clamp(at, 0, coarse.n - 1)); };
            refine(row(j / 2), row(j / 2 + (j % 2 ? 1 : -1)), coarse.n, between.data(),
                   fine.row(j));
        }
    }
}

void WallLight::set(const LightMap& lamp, const LightMap& spots, float shade) {
    n_ = lamp.places();
    pairs_.resize(size_t(n_) * n_);
    std::vector<int> row(size_t(n_) + 1);
    const std::vector<float> all(n_, 1.0f);
    const auto light = [&](const LightMap& map, int j) {
        return map.any() ? map.row(j) : all.data();
    };
    for (int j = 0; j < n_; ++j)
        pair_up(light(lamp, j), light(spots, j), n_, shade, row.data(), &pairs_[size_t(j) * n_]);
}

}  // namespace carom::raster
