// A glance may say too early, never too late; with every instruction set.
#include <cmath>

#include "probe.hpp"

using namespace carom;

namespace {

struct Draw {
    std::mt19937_64 bits;
    double uniform(double lo, double hi) {
        return lo + (hi - lo) * std::uniform_real_distribution<double>()(bits);
    }
    double small(double least = -16) { return std::pow(10.0, uniform(least, 0)); }
    double sign() { return one_of({1.0, -1.0}); }
    double one_of(std::initializer_list<double> these) {
        return these.begin()[std::uniform_int_distribution<size_t>(0, these.size() - 1)(bits)];
    }
    int whole(int most) { return std::uniform_int_distribution<int>(0, most)(bits); }
    Vec3 inside(double half) {
        return {uniform(-half, half), uniform(-half, half), uniform(-half, half)};
    }
    Vec3 unit() {
        for (;;) {
            const Vec3 v = inside(1);
            const double n = norm(v);
            if (n > 0.1 && n < 1) return v * (1 / n);
        }
    }
};

Vec3 across(Draw& draw, const Vec3& n) {
    const Vec3 a = cross(n, draw.unit());
    return a * (1 / norm(a));
}

// The second of a pair, placed as meanly as one can think of. `far`: how far apart neighbours can
// be, surface to surface.
void make_mean(Draw& draw, const StartSphere& p, StartSphere& q, double far, double speed) {
    const double sigma = p.radius + q.radius;
    const Vec3 n = draw.unit();
    Vec3 v = draw.unit() * (speed * draw.uniform(0.1, 3));  // of q as p sees it
    double gap = far * draw.small(-4);
    switch (draw.whole(9)) {
        case 0:  // anything
            break;
        case 1:  // touching, approaching or parting ever so little
            gap = sigma * draw.sign() * draw.small() * 1e-10;
            v = across(draw, n) * speed + n * (draw.sign() * speed * draw.small());
            break;
        case 2: {  // grazing
            const double beside = sigma * (1 + draw.sign() * draw.small()), d = sigma + gap;
            const double along = std::sqrt(std::max(0.0, d * d - beside * beside));
            v = (n * -along + across(draw, n) * std::min(beside, d)) * (speed / d);
            break;
        }
        case 3:  // side by side
            v = draw.unit() * (speed * draw.small());
            break;
        case 4:  // side by side and about to touch
            gap = sigma * draw.small();
            v = n * (-speed * draw.small()) + across(draw, n) * (speed * draw.small());
            break;
        case 5:  // overlapping by rounding
            gap = -sigma * draw.small() * 1e-11;
            v = n * (-speed * draw.small());
            break;
        case 6:  // almost touching, head on
            gap = sigma * draw.small();
            v = n * -speed;
            break;
        case 7:  // far and barely grazing
            gap = far;
            v = n * -(sigma + gap) + across(draw, n) * (sigma * (1 - draw.small() * 1e-3));
            v = v * (speed / norm(v));
            break;
        case 8:  // much faster than any other
            v = v * std::pow(10.0, draw.uniform(0, 12));
            break;
        default:  // both much slower than any other
            v = v * draw.small(-30);
    }
    q.position = p.position + n * (sigma + gap);
    q.velocity = p.velocity + v;
}

struct Setting {
    double length, speed;  // units: a gas may be in metres or in nanometres
    double period;         // 0: open
    double around;         // open: how far from the origin
    double ratio;          // of sizes
    int grid;
    double gap;       // between spheres
    double fall = 0;  // gravity, in speed^2 / length
};

// Many mean pairs in one engine, looked at from both sides, at once and some time later.
int compare_pairs(const Setting& s, uint64_t seed, int pairs, int times) {
    Draw draw{std::mt19937_64(seed)};
    World world;
    const double l = s.length;
    if (s.period > 0) world.period = Vec3{1, 1, s.grid ? 1 : 1.3} * (s.period * l);
    const double half =
        s.period > 0 ? 0.5 * s.period * l : 0.5 * (1 + s.gap) * l * std::cbrt(2.0 * pairs);
    const Vec3 middle = draw.unit() * (s.around * l);
    world.gravity = draw.unit() * (s.fall * s.speed * s.speed / l);
    Tuning tuning;
    tuning.grid = s.grid;
    std::vector<StartSphere> spheres(size_t(2 * pairs));
    for (StartSphere& p : spheres) {
        p.position = middle + draw.inside(half);
        if (draw.whole(3) == 0) p.position.x = (1 - draw.small()) * half;  // at the period's edge
        p.velocity = draw.unit() * (s.speed * draw.uniform(0, 3));
        p.radius = 0.5 * l;
        if (draw.whole(5) == 0) p.velocity = {};
        if (draw.whole(3) == 0) p.radius *= std::pow(s.ratio, draw.uniform(-1, 0.2));
        if (draw.whole(9) == 0) p.velocity = p.velocity * draw.small(-30);
        p.fixed = s.fall > 0 && draw.whole(9) == 0;
        if (p.fixed) p.velocity = {};
    }
    // Once to learn what the engine will choose, then again with the pairs.
    int met = 0;
    const Engine first(spheres, 0, world, tuning);
    if (!EngineProbe::glancing(first)) return 0;
    const bool gridded = EngineProbe::gridded(first);
    std::vector<int> widening;
    for (int k = 0; k < pairs; ++k) {
        StartSphere &p = spheres[size_t(2 * k)], &q = spheres[size_t(2 * k + 1)];
        widening.push_back(std::min(draw.whole(5), EngineProbe::most_widening(first)));
        double far = gridded ? 3 * EngineProbe::width(first)
                             : 2 * EngineProbe::margin(first, widening.back());
        if (s.period > 0) far = std::min(far, half - p.radius - q.radius);
        if (far > 0) make_mean(draw, p, q, far, s.speed);
        if (q.fixed) q.velocity = {};
    }
    Engine engine(spheres, 0, world, tuning);
    const double epoch = EngineProbe::epoch(engine);
    for (int n = 0; n < times; ++n) {
        const double start = n == 0 ? 0 : epoch * draw.uniform(0, 2);
        EngineProbe::focus(engine, start);
        for (int k = 0; k < pairs; ++k) {
            for (const int i : {2 * k, 2 * k + 1}) {
                const int j = i ^ 1, wide = widening[size_t(k)];
                EngineProbe::place(engine, i, start, wide);
                EngineProbe::place(engine, j, start, wide);
                EngineProbe::refresh(engine, j, start);
                const double until =
                    std::min({EngineProbe::leaves(engine, i, start),
                              EngineProbe::leaves(engine, j, start), start + 1.5 * epoch});
                if (!EngineProbe::neighbours(engine, i, j)) continue;
                const double wait = n == 0 ? 0 : (until - start) * draw.small(-3);
                EngineProbe::refresh(engine, i, start + wait);
                met += EngineProbe::compare(engine, i, {j});
            }
        }
    }
    return met;
}

}  // namespace

TEST(a_glance_is_never_too_late) {
    for (const double length : {1.0, 1e-9, 3e7})
        for (const double speed : {1.0, 700.0}) {
            int met = 0, falling = 0;
            for (uint64_t seed = 0; seed < 30; ++seed)
                for (const double gap : {0.05, 0.5, 3.0, 20.0}) {
                    const double ratio = seed % 3 == 0 ? 1 : seed % 3 == 1 ? 10 : 1000;
                    const double side = (1 + gap) * std::cbrt(64.0);
                    met += compare_pairs({length, speed, 0, seed % 4 == 0 ? 1e7 : 0, ratio, 0, gap},
                                         seed, 32, 3);
                    met += compare_pairs({length, speed, side, 0, ratio, 0, gap}, seed, 32, 3);
                    met += compare_pairs({length, speed, side, 0, 1, 1, gap}, seed, 32, 3);
                    for (const double fall : {0.01, 3.0})
                        falling +=
                            compare_pairs({length, speed, 0, 0, ratio, 0, gap, fall}, seed, 32, 3);
                }
            met += compare_pairs({length, speed, 1e7, 0, 1, 0, 1}, 3, 32, 3);
            CHECK(met > 5000);
            CHECK(falling > 2000);
        }
}
