#include "shading.hpp"

#include <algorithm>

namespace carom::raster {

namespace {
constexpr int kBatch = 64;
}

// Places on spheres that are lit together, as arrays, so that the compiler makes vectors of them.
struct Shading::Batch {
    int count = 0;
    int pixel[kBatch] = {}, ball[kBatch] = {};
    float weight[kBatch] = {};             // share of the pixel
    float x[kBatch] = {}, y[kBatch] = {};  // the ray is (x, y, 1)
    float cx[kBatch], cy[kBatch], cz[kBatch], r[kBatch];
    float px[kBatch], py[kBatch], pz[kBatch];        // the place
    float nx[kBatch], ny[kBatch], nz[kBatch];        // the normal
    float seen[kBatch], left[kBatch];                // of the lamp; of all light, in the crowd
    float red[kBatch], green[kBatch], blue[kBatch];  // first the skin, then the light

    void add(int at, int who, float share, float ray_x, float ray_y) {
        pixel[count] = at, ball[count] = who, weight[count] = share;
        x[count] = ray_x, y[count] = ray_y;
        ++count;
    }
};

Shading::Shading(const View& view, const Look& look)
    : view_(view), look_(look), lamp_(view.direction(look.lamp)), up_(view.direction(look.up)) {}

void Shading::paint(const Visibility& seen, const std::vector<Ball>& balls, const Casters& casters,
                    Frame& frame) const {
    for (int row = 0; row < frame.height; ++row) collect(seen, row, balls, casters, frame);
}

// Where all samples of a pixel see the same sphere, it is lit once, in the middle; elsewhere each
// sphere is lit in the middle of its samples.
void Shading::collect(const Visibility& seen, int row, const std::vector<Ball>& balls,
                      const Casters& casters, Frame& frame) const {
    Batch batch;
    float* const pixels = frame.row(row);
    const auto flush = [&] {
        if (batch.count > 0) light(batch, balls, casters, pixels);
        batch.count = 0;
    };
    const float y = view_.ray_y(float(row));
    if (view_.samples == 1) {
        const int* ids = seen.ids(row);
        for (int i = 0; i < view_.width; ++i) {
            if (ids[i] == Visibility::kNone) continue;
            std::fill_n(pixels + 3 * i, 3, 0.0f);
            batch.add(i, ids[i], 1, view_.ray_x(float(i)), y);
            if (batch.count == kBatch) flush();
        }
        return flush();
    }
    const int* rows[2] = {seen.ids(2 * row), seen.ids(2 * row + 1)};
    const float quarter = 0.25f * float(view_.pixel);
    for (int i = 0; i < view_.width; ++i) {
        const int ids[4] = {rows[0][2 * i], rows[0][2 * i + 1], rows[1][2 * i], rows[1][2 * i + 1]};
        const float x = view_.ray_x(float(i));
        int covered = 0;
        for (int k = 0; k < 4; ++k) {
            if (ids[k] == Visibility::kNone) continue;
            ++covered;
            int first = 0, same = 0;
            float aside = 0, above = 0;
            while (ids[first] != ids[k]) ++first;
            if (first < k) continue;
            for (int m = k; m < 4; ++m) {
                if (ids[m] != ids[k]) continue;
                ++same;
                aside += m & 1 ? quarter : -quarter;
                above += m & 2 ? -quarter : quarter;
            }
            batch.add(i, ids[k], 0.25f * float(same), x + aside / float(same),
                      y + above / float(same));
        }
        for (int c = 0; c < 3; ++c) pixels[3 * i + c] *= 1 - 0.25f * float(covered);
        if (batch.count > kBatch - 4) flush();
    }
    flush();
}

// Light creeps round the edge, where the sphere's own shadow would be hard; so places turned away
// from the lamp ask nobody.
CAROM_WIDE void Shading::shadow(Batch& b, const std::vector<Ball>& balls,
                                const Casters& casters) const {
    for (int first = 0, end; first < b.count; first = end) {
        const int who = b.ball[first];
        for (end = first + 1; end < b.count && b.ball[end] == who;) ++end;
        for (const int* j = casters.begin(who); j != casters.end(who); ++j) {
            const F3 c = balls[*j].center;
            const float r = balls[*j].radius;
            for (int k = first; k < end; ++k) {
                const float more = 0.12f * b.r[k];
                const float dx = c.x - b.px[k] - more * lamp_.x;
                const float dy = c.y - b.py[k] - more * lamp_.y;
                const float dz = c.z - b.pz[k] - more * lamp_.z;
                const float gap = dx * lamp_.x + dy * lamp_.y + dz * lamp_.z;
                const float s2 = dx * dx + dy * dy + dz * dz - gap * gap;
                const float dark = hidden(std::sqrt(positive(s2)), r, half_shadow(look_, gap));
                b.seen[k] *= gap > 0 ? 1 - dark : 1;
            }
        }
    }
}

CAROM_WIDE void Shading::light(Batch& b, const std::vector<Ball>& balls, const Casters& casters,
                               float* row) const {
    // The loops below always run over the whole batch, which compilers do best.
    for (int k = b.count; k < kBatch; ++k) {
        b.ball[k] = b.ball[0], b.x[k] = b.x[0], b.y[k] = b.y[0];
    }
    float slope_x[kBatch], slope_y[kBatch], slope_z[kBatch];
    for (int k = 0; k < kBatch; ++k) {
        const Ball& ball = balls[b.ball[k]];
        b.cx[k] = ball.center.x, b.cy[k] = ball.center.y, b.cz[k] = ball.center.z;
        b.r[k] = ball.radius;
        b.red[k] = ball.skin.x, b.green[k] = ball.skin.y, b.blue[k] = ball.skin.z;
        b.left[k] = ball.left;
        slope_x[k] = ball.left_slope.x, slope_y[k] = ball.left_slope.y;
        slope_z[k] = ball.left_slope.z;
        b.seen[k] = casters.any() ? casters.left(b.ball[k]) : 1;
    }
    for (int k = 0; k < kBatch; ++k) {
        const float x = b.x[k], y = b.y[k];
        const float ex = y * b.cz[k] - b.cy[k], ey = b.cx[k] - x * b.cz[k];
        const float ez = x * b.cy[k] - y * b.cx[k];
        const float d2 = 1 + x * x + y * y;
        const float square = d2 * b.r[k] * b.r[k] - (ex * ex + ey * ey + ez * ez);
        const float half = std::sqrt(positive(square));
        const float t = (x * b.cx[k] + y * b.cy[k] + b.cz[k] - half) / d2;
        b.px[k] = t * x, b.py[k] = t * y, b.pz[k] = t;
        const float dx = b.px[k] - b.cx[k], dy = b.py[k] - b.cy[k], dz = t - b.cz[k];
        const float per = 1 / std::sqrt(dx * dx + dy * dy + dz * dz);
        b.nx[k] = dx * per, b.ny[k] = dy * per, b.nz[k] = dz * per;
        b.left[k] =
            clamp(b.left[k] + slope_x[k] * b.nx[k] + slope_y[k] * b.ny[k] + slope_z[k] * b.nz[k]);
    }
    if (casters.any()) shadow(b, balls, casters);
    const F3 key = look_.key, sky = look_.sky, ground = look_.ground, fog = look_.back;
    for (int k = 0; k < kBatch; ++k) {
        const float x = b.x[k], y = b.y[k];
        const float away = 1 / std::sqrt(1 + x * x + y * y);
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
        const float hx = lamp_.x - x * away, hy = lamp_.y - y * away, hz = lamp_.z - away;
        const float half = (nx * hx + ny * hy + nz * hz) / std::sqrt(hx * hx + hy * hy + hz * hz);
        const float s1 = half > 0 ? half : 0, s2 = s1 * s1, s4 = s2 * s2, s8 = s4 * s4;
        const float s16 = s8 * s8, s64 = s16 * s16 * s16 * s16;
        const float shine = (0.10f * s16 + 0.16f * s64) * seen * left;
        const float to_eye = -(nx * x + ny * y + nz) * away;
        const float edge = 1 - (to_eye > 0 ? to_eye : 0);
        const float rim = edge * edge * edge * high * seen * left;
        const float distance = b.pz[k] / away;
        const float mist =
            look_.fog_most * clamp((distance - look_.fog_from) * look_.fog_per_length);
        const auto lit = [&](float skin, float k_, float s_, float g_, float f_) {
            float light = skin * ((g_ + (s_ - g_) * high) * around + lamp * k_);
            light += shine * k_ + s_ * rim * (0.10f + 0.25f * skin);
            const float shown = std::sqrt(light / (1 + 0.12f * light));
            return shown + (f_ - shown) * mist;
        };
        b.red[k] = lit(b.red[k], key.x, sky.x, ground.x, fog.x);
        b.green[k] = lit(b.green[k], key.y, sky.y, ground.y, fog.y);
        b.blue[k] = lit(b.blue[k], key.z, sky.z, ground.z, fog.z);
    }
    for (int k = 0; k < b.count; ++k) {
        float* const pixel = row + 3 * b.pixel[k];
        pixel[0] += b.weight[k] * b.red[k];
        pixel[1] += b.weight[k] * b.green[k];
        pixel[2] += b.weight[k] * b.blue[k];
    }
}

}  // namespace carom::raster
