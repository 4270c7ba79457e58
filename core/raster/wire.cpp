#include "wire.hpp"

#include <algorithm>

namespace carom::raster {

namespace {

struct F2 {
    float x, y;
};

// z = (cos a, sin a) to the power n: (cos na, sin na), without a sine.
F2 power(F2 z, int n) {
    F2 result{1, 0};
    for (; n > 0; n >>= 1) {
        if (n & 1) result = {result.x * z.x - result.y * z.y, result.x * z.y + result.y * z.x};
        z = {z.x * z.x - z.y * z.y, 2 * z.x * z.y};
    }
    return result;
}

// Three functions of a place on the sphere that are 0 on the lines: few meridians, all of them,
// parallels.
struct Lines {
    float few, all, parallels;
    float round;  // distance from the poles' axis
};

// n: unit normal in the world, poles along z; 3 `third` lines to a half circle.
Lines lines_at(const Vec3& n, int third) {
    const float x = float(n.x), y = float(n.y), round = std::sqrt(x * x + y * y);
    const float per = 1 / std::max(round, 1e-6f);
    const F2 few = power({x * per, y * per}, third);
    return {few.y, power(few, 3).y, power({round, float(n.z)}, 3 * third).y, round};
}

// How much of a pixel is covered by lines where f = 0. Where they are too close to be told apart
// the average takes over. right, below: f in the next pixels.
float covered(float f, float right, float below, float width) {
    const float dx = right - f, dy = below - f, slope = std::sqrt(dx * dx + dy * dy);
    const float line = clamp(0.5f * width + 0.5f - std::abs(f) / std::max(slope, 1e-6f));
    const float average = std::min(1.0f, slope * width / 3.14159265f);
    return line + (average - line) * smoothstep(0.6f, 1.4f, slope);
}

// Two of three meridians end before the poles, where they would run together.
float wire(const Lines& at, const Lines& right, const Lines& below, float width) {
    const float meridians =
        covered(at.all, right.all, below.all, width) * smoothstep(0.34f, 0.42f, at.round);
    const float few = covered(at.few, right.few, below.few, width) * smoothstep(0, 0.12f, at.round);
    return std::max(std::max(meridians, few),
                    covered(at.parallels, right.parallels, below.parallels, width));
}

// Where a ray passes or meets a sphere.
struct Hit {
    float along, off, half;  // to the nearest point, from there to the centre, to the surface
    Lines front, back;
};

Hit meet(const View& view, F3 center, float radius, int third, int i, int j) {
    F3 ray{view.ray_x(float(i)), view.ray_y(float(j)), 1};
    ray = ray * (1 / std::sqrt(dot(ray, ray)));
    Hit hit;
    hit.along = dot(center, ray);
    const F3 off = ray * hit.along - center;
    hit.off = std::sqrt(dot(off, off));
    hit.half = std::sqrt(std::max(radius * radius - hit.off * hit.off, 0.0f));
    // Outside, the normal of the outline goes on, so that differences exist at the edge.
    const float per = 1 / std::max(hit.off, radius);
    const auto world = [&](F3 n) {
        return view.right * double(n.x * per) + view.up * double(n.y * per) +
               view.forward * double(n.z * per);
    };
    hit.front = lines_at(world(off - ray * hit.half), third);
    hit.back = lines_at(world(off + ray * hit.half), third);
    return hit;
}

// Calls paint(pixel, hit, front, back) around a sphere, with how much lines cover.
template <class Paint>
void trace(const View& view, F3 center, float radius, int third, float width, float back_width,
           Frame& frame, Paint paint) {
    Bounds bounds = around(view, center, radius, 2);
    bounds = {common(bounds.x, frame.columns), common(bounds.y, frame.rows)};
    const int columns = bounds.x.last - bounds.x.first + 2;
    if (columns < 2 || bounds.y.first > bounds.y.last) return;
    std::vector<Hit> row(columns), below(columns);
    const auto fill = [&](std::vector<Hit>& hits, int j) {
        for (int k = 0; k < columns; ++k)
            hits[k] = meet(view, center, radius, third, bounds.x.first + k, j);
    };
    fill(row, bounds.y.first);
    for (int j = bounds.y.first; j <= bounds.y.last; ++j, row.swap(below)) {
        fill(below, j + 1);
        for (int k = 0; k + 1 < columns; ++k) {
            const Hit &at = row[k], &right = row[k + 1], &under = below[k];
            paint(frame.row(j) + 3 * (bounds.x.first + k), at,
                  wire(at.front, right.front, under.front, width),
                  wire(at.back, right.back, under.back, back_width));
        }
    }
}

}  // namespace

void draw_wires(const View& view, const Look& look, const Ball& ball, F3 color, Frame& frame) {
    const F3 c = ball.center;
    const float r = ball.radius, width = look.line_width, pixel = float(view.pixel);
    if (c.z <= 0.02f * r || dot(c, c) <= 1.02f * r * r) return;
    const int third = r / (std::sqrt(dot(c, c)) * pixel) > 24 ? 4 : 2;  // every 15 or 30 degrees
    trace(view, c, r, third, width, 0.8f * width, frame,
          [&](float* at, const Hit& hit, float front, float back) {
              const float inside = (r - hit.off) / (hit.along * pixel);
              const float coverage = clamp(inside + 0.5f);
              if (coverage <= 0 || hit.along <= 0) return;
              const float outline = clamp(0.5f * width + 1 - std::abs(inside - 0.5f * width));
              const float turned = hit.half / r, edge = 1 - turned;
              const float fill = 0.06f + 0.20f * edge * edge;
              const float line = std::max(
                  std::max((0.62f + 0.38f * turned) * front, (0.22f - 0.1f * turned) * back),
                  0.8f * outline);
              const float fog =
                  look.fog_most * clamp((hit.along - look.fog_from) * look.fog_per_length);
              F3 glow = mix(color + look.tint * line, look.back, 0.8f * fog);
              glow = {clamp(glow.x), clamp(glow.y), clamp(glow.z)};
              blend(at, glow, coverage * (fill + (1 - fill) * line));
          });
}

void draw_shell(const View& view, const Look& look, double radius, Half half, Frame& frame) {
    const F3 c = view.place(Vec3{});
    const float r = float(radius), pixel = float(view.pixel), center = std::sqrt(dot(c, c));
    const float side = half == Half::far ? 1 : -1;
    trace(view, c, r, 6, look.line_width, look.line_width, frame,
          [&](float* at, const Hit& hit, float front, float back) {
              const float t = hit.along + side * hit.half;
              const float inside = (r - hit.off) / (std::max(hit.along, 1e-3f * r) * pixel);
              const bool there = hit.along > 0 || hit.off < r;
              const float coverage = there ? clamp(inside + 0.5f) : 0;
              if (coverage <= 0 || t <= 0) return;
              const float edge = 1 - hit.half / r;
              const float outline = hit.along > 0 ? clamp(1.5f - std::abs(inside - 0.5f)) : 0;
              // Nearer lines are brighter, from the far end of the ball to the near one.
              const float near = clamp(0.5f - 0.5f * (t - center) / r);
              const float strength = 0.20f + 0.42f * near;
              const float line = half == Half::far ? back : front;
              blend(at, look.shell,
                    coverage *
                        std::max(strength * std::max(line, 0.9f * outline), 0.07f * edge * edge));
          });
}

}  // namespace carom::raster
