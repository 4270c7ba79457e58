#include "light_map.hpp"

namespace carom::raster {

namespace {
constexpr int kLeast = 32, kMost = 1024;  // places along a side
}

LightMap::LightMap(float side_u, float side_v, float finest) : side_u_(side_u), side_v_(side_v) {
    const float wanted = 1.25f * std::max(side_u, side_v) / std::max(finest, 1e-30f);
    for (int n = kLeast; n <= kMost; n *= 2) {
        levels_.push_back({n, true, std::vector<float>(size_t(n) * n)});
        if (1.41f * float(n) >= wanted) break;
    }
    clear();
}

void LightMap::clear() {
    for (Level& level : levels_) {
        if (level.used) std::fill(level.light.begin(), level.light.end(), 1.0f);
        level.used = false;
    }
}

LightMap::Level& LightMap::level_for(float scale) {
    size_t k = 0;
    while (k + 1 < levels_.size() &&
           1.41f * float(levels_[k].n) * scale < 1.25f * std::max(side_u_, side_v_))
        ++k;
    levels_[k].used = true;
    return levels_[k];
}

void LightMap::merge() {
    for (size_t k = 0; k + 1 < levels_.size(); ++k) {
        const Level& coarse = levels_[k];
        Level& fine = levels_[k + 1];
        if (!coarse.used) continue;
        fine.used = true;
        std::vector<float> between(coarse.n);
        for (int j = 0; j < fine.n; ++j) {
            // The middle of a fine place lies at a quarter or three quarters between coarse ones.
            const auto row = [&](int at) {
                return &coarse.light[size_t(std::clamp(at, 0, coarse.n - 1)) * coarse.n];
            };
            const float* const near_row = row(j / 2);
            const float* const far_row = row(j / 2 + (j % 2 ? 1 : -1));
            for (int i = 0; i < coarse.n; ++i)
                between[i] = 0.75f * near_row[i] + 0.25f * far_row[i];
            float* const to = &fine.light[size_t(j) * fine.n];
            for (int i = 0; i < coarse.n; ++i) {
                const float left = between[i > 0 ? i - 1 : 0];
                const float right = between[i + 1 < coarse.n ? i + 1 : i];
                to[2 * i] *= 0.75f * between[i] + 0.25f * left;
                to[2 * i + 1] *= 0.75f * between[i] + 0.25f * right;
            }
        }
    }
}

}  // namespace carom::raster
