#include "shading.hpp"

#include <algorithm>
#include <bit>

#include "../memory.hpp"

namespace carom::raster {

namespace {

constexpr int kBatch = 64;

// The samples of a pixel, as bits, that see a sphere: their share, and where their middle lies, in
// quarters of a pixel to the right and up.
struct Part {
    float weight = 0, aside = 0, above = 0;
};
struct Parts {
    Part of[16];
    explicit Parts(int samples) {
        if (samples == 1) {
            of[1].weight = 1;
            return;
        }
        for (int bits = 1; bits < 16; ++bits) {
            int many = 0, aside = 0, above = 0;
            for (int k = 0; k < 4; ++k) {
                if (!(bits >> k & 1)) continue;
                ++many;
                aside += k & 1 ? 1 : -1;
                above += k & 2 ? -1 : 1;
            }
            of[bits] = {0.25f * float(many), float(aside) / float(many),
                        float(above) / float(many)};
        }
    }
};

// Which of kLanes samples see a ball, as bits. On its own, or compilers unroll the loop before they
// can make a vector of it.
CAROM_APART CAROM_WIDE unsigned which(const int* id, int ball) {
    unsigned bits = 0;
    for (int k = 0; k < kLanes; ++k) bits |= unsigned(id[k] == ball) << k;
    return bits;
}

}  // namespace

// Places on a sphere that are lit together, as arrays, so that the compiler makes vectors of them.
struct Shading::Batch {
    int count = 0;
    float* pixel[kBatch] = {};
    float weight[kBatch] = {};                 // share of the pixel
    float x[kBatch] = {}, y[kBatch] = {};      // the ray is (x, y, 1)
    float away[kBatch];                        // 1 over its length
    float px[kBatch], py[kBatch], pz[kBatch];  // the place
    float nx[kBatch], ny[kBatch], nz[kBatch];  // the normal
    float seen[kBatch], left[kBatch];          // of the lamp; of all light, in the crowd
    float red[kBatch], green[kBatch], blue[kBatch];
};

Shading::Shading(const View& view, const Look& look)
    : view_(view), look_(look), lamp_(view.direction(look.lamp)), up_(view.direction(look.up)) {
    for (int i = 0; i < view.width; ++i) rays_.push_back(view.ray_x(float(i)));
}

// Where all samples of a pixel see the same sphere, it is lit once, in the middle; elsewhere each
// sphere is lit in the middle of its samples.
CAROM_WIDE void Shading::paint(const Visibility& seen, const std::vector<int>& visible,
                               const std::vector<Ball>& balls, const std::vector<Skin>& skins,
                               const Casters& casters, Frame& frame) const {
    const int samples = view_.samples;
    const Parts parts(samples);
    const float quarter = 0.25f * float(view_.pixel);
    Batch batch;
    for (size_t k = 0; k < visible.size(); ++k) {
        const int ball = visible[k];
        if (casters.any()) fetch(casters.begin(visible[std::min(k + 4, visible.size() - 1)]));
        const Bounds& bounds = balls[ball].samples;
        const Span rows = common({bounds.y.first / samples, bounds.y.last / samples}, frame.rows);
        for (int row = rows.first; row <= rows.last; ++row) {
            const float y = view_.ray_y(float(row));
            float* const pixels = frame.row(row);
            const auto add = [&](int i, unsigned bits) {
                const Part& part = parts.of[bits];
                const int at = batch.count++;
                batch.pixel[at] = pixels + 3 * i;
                batch.weight[at] = part.weight;
                batch.x[at] = rays_[i] + part.aside * quarter;
                batch.y[at] = y + part.above * quarter;
                if (batch.count == kBatch) light(batch, ball, balls[ball], skins[ball], casters);
            };
            const int *const upper = seen.ids(samples * row), *const lower = seen.ids(
                                                                  samples * row + samples - 1);
            for (int i = bounds.x.first / samples * samples; i <= bounds.x.last; i += kLanes) {
                unsigned one = which(upper + i, ball);
                if (samples == 1) {
                    for (; one; one &= one - 1) add(i + std::countr_zero(one), 1);
                    continue;
                }
                const unsigned two = which(lower + i, ball);
                unsigned either = one | two;
                either = (either | either >> 1) & 0x55;  // a bit for each pixel
                for (; either; either &= either - 1) {
                    const int at = std::countr_zero(either);
                    add((i + at) / 2, (one >> at & 3) | (two >> at & 3) << 2);
                }
            }
        }
        if (batch.count > 0) light(batch, ball, balls[ball], skins[ball], casters);
    }
}

// Places turned away from the lamp ask nobody.
CAROM_WIDE void Shading::shadow(Batch& b, int ball, const Casters& casters) const {
    const int n = b.count;
    for (const Casters::Caster* j = casters.begin(ball); j != casters.end(ball); ++j) {
        const F3 c = j->center;
        const float r = j->radius;
        for (int k = 0; k < n; ++k) {
            const float dx = c.x - b.px[k], dy = c.y - b.py[k], dz = c.z - b.pz[k];
            const float gap = dx * lamp_.x + dy * lamp_.y + dz * lamp_.z;
            const float s2 = dx * dx + dy * dy + dz * dz - gap * gap;
            const float dark = hidden(std::sqrt(positive(s2)), r, half_shadow(look_, gap));
            b.seen[k] *= gap > 0 ? 1 - dark : 1;
        }
    }
}

CAROM_WIDE void Shading::light(Batch& b, int who, const Ball& ball, const Skin& skin,
                               const Casters& casters) const {
    const F3 c = ball.center, slope = skin.slope;
    const float r2 = ball.radius * ball.radius;
    const float left_of_lamp = casters.any() ? casters.left(who) : 1;
    const int used = b.count;
    // Whole vectors: what lies behind the last place is not looked at.
    const int n = b.count = whole_steps(used);
    for (int k = used; k < n; ++k) b.x[k] = b.x[0], b.y[k] = b.y[0];
    for (int k = 0; k < n; ++k) {
        const float x = b.x[k], y = b.y[k];
        const float ex = y * c.z - c.y, ey = c.x - x * c.z, ez = x * c.y - y * c.x;
        const float d2 = 1 + x * x + y * y, away = 1 / std::sqrt(d2);
        const float square = d2 * r2 - (ex * ex + ey * ey + ez * ez);
        const float half = std::sqrt(positive(square));
        const float t = (x * c.x + y * c.y + c.z - half) * (away * away);
        b.away[k] = away;
        b.px[k] = t * x, b.py[k] = t * y, b.pz[k] = t;
        const float dx = b.px[k] - c.x, dy = b.py[k] - c.y, dz = t - c.z;
        const float per = 1 / std::sqrt(dx * dx + dy * dy + dz * dz);
        b.nx[k] = dx * per, b.ny[k] = dy * per, b.nz[k] = dz * per;
        b.left[k] = clamp(skin.left + slope.x * b.nx[k] + slope.y * b.ny[k] + slope.z * b.nz[k]);
        b.seen[k] = left_of_lamp;
    }
    if (casters.any()) shadow(b, who, casters);
    const F3 key = look_.key, sky = look_.sky, ground = look_.ground, fog = look_.back;
    const F3 own = skin.color * skin.color;  // the share of light that it gives back
    for (int k = 0; k < n; ++k) {
        const float x = b.x[k], y = b.y[k];
        const float away = b.away[k];
        const float nx = b.nx[k], ny = b.ny[k], nz = b.nz[k], left = b.left[k];
        const float facing = nx * lamp_.x + ny * lamp_.y + nz * lamp_.z;
        const float turned = clamp((facing + 0.05f) * 4),
                    creeps = turned * turned * (3 - 2 * turned);
        const float seen = 1 + (b.seen[k] - 1) * look_.shadowed * creeps;
        const float round = clamp((facing + 0.35f) * (1 / 1.35f));
        const float lamp = round * round * seen * (0.25f + 0.75f * left);
        const float high = 0.5f + 0.5f * (nx * up_.x + ny * up_.y + nz * up_.z);
        const float around = (0.6f + 0.4f * seen) * left;
        // The dull shine: halfway between lamp and eye.
        const float to_eye = -(nx * x + ny * y + nz) * away;
        const float between = 2 - 2 * (lamp_.x * x + lamp_.y * y + lamp_.z) * away;
        const float half = (facing + to_eye) / std::sqrt(positive(between) + 1e-12f);
        const float s1 = half > 0 ? half : 0, s2 = s1 * s1, s4 = s2 * s2, s8 = s4 * s4;
        const float s16 = s8 * s8, s64 = s16 * s16 * s16 * s16;
        const float shine = (0.10f * s16 + 0.16f * s64) * seen * left;
        const float edge = 1 - (to_eye > 0 ? to_eye : 0);
        const float rim = edge * edge * edge * high * seen * left;
        const float distance = b.pz[k] * (1 + x * x + y * y) * away;
        const float mist =
            look_.fog_most * clamp((distance - look_.fog_from) * look_.fog_per_length);
        const auto lit = [&](float share, float k_, float s_, float g_, float f_) {
            float glow = share * ((g_ + (s_ - g_) * high) * around + lamp * k_);
            glow += shine * k_ + s_ * rim * (0.10f + 0.25f * share);
            const float shown = std::sqrt(glow / (1 + 0.12f * glow));
            return shown + (f_ - shown) * mist;
        };
        b.red[k] = lit(own.x, key.x, sky.x, ground.x, fog.x);
        b.green[k] = lit(own.y, key.y, sky.y, ground.y, fog.y);
        b.blue[k] = lit(own.z, key.z, sky.z, ground.z, fog.z);
    }
    for (int k = 0; k < used; ++k) {
        float* const pixel = b.pixel[k];
        const float weight = b.weight[k];
        if (weight == 1) {
            pixel[0] = b.red[k], pixel[1] = b.green[k], pixel[2] = b.blue[k];
            continue;
        }
        pixel[0] += weight * b.red[k];
        pixel[1] += weight * b.green[k];
        pixel[2] += weight * b.blue[k];
    }
    b.count = 0;
}

}  // namespace carom::raster
