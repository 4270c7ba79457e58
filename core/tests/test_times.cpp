// Event times against roots found the slow way.
#include <random>

#include "../contact.hpp"
#include "../walls.hpp"
#include "check.hpp"

using namespace carom;

namespace {

std::mt19937_64 bits(7);
double uniform(double lo, double hi) {
    return lo + (hi - lo) * std::uniform_real_distribution<double>()(bits);
}
Vec3 vector(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
}

// First t in (0, horizon) where f falls through zero, by walking in small steps and bisecting.
template <class F>
double walked(const F& f, double horizon) {
    const int steps = 200000;
    double a = 0;
    for (int k = 1; k <= steps; ++k) {
        const double b = horizon * k / steps;
        if (f(a) > 0 && f(b) <= 0) {
            double lo = a, hi = b;
            for (int n = 0; n < 80; ++n) {
                const double mid = 0.5 * (lo + hi);
                (f(mid) > 0 ? lo : hi) = mid;
            }
            return hi;
        }
        a = b;
    }
    return kNever;
}

bool agree(double t, double expected, double horizon) {
    if (t > horizon && expected == kNever) return true;
    return std::abs(t - expected) <= 1e-9 * (1 + expected);
}

}  // namespace

TEST(pairs_meet_when_their_gap_closes) {
    for (int n = 0; n < 30; ++n) {
        const Vec3 r = vector(3), v = vector(1);
        if (norm(r) <= 1) continue;
        const auto gap = [&](double t) { return norm2(r + v * t) - 1; };
        CHECK(agree(contact_time(r, v, 1), walked(gap, 20), 20));
    }
}

TEST(overlapping_pairs_meet_at_once_or_never) {
    CHECK(contact_time({0.9, 0, 0}, {-1, 0, 0}, 1) == 0);
    CHECK(contact_time({0.9, 0, 0}, {1, 0, 0}, 1) == kNever);
    CHECK(contact_time({2, 0, 0}, {0, 0, 0}, 1) == kNever);
}

TEST(accelerated_pairs_meet_when_their_gap_closes) {
    for (int n = 0; n < 40; ++n) {
        const Vec3 r = vector(3), v = vector(2), a = vector(1);
        if (norm(r) <= 1) continue;
        const auto gap = [&](double t) { return norm2(r + (v + a * (0.5 * t)) * t) - 1; };
        CHECK(agree(Approach(r, v, a, 1, 1).first(), walked(gap, 20), 20));
    }
}

TEST(accelerated_spheres_leave_a_container) {
    for (int n = 0; n < 40; ++n) {
        const Vec3 r = vector(0.5), v = vector(2), a = vector(1);
        const auto gap = [&](double t) { return 1 - norm2(r + (v + a * (0.5 * t)) * t); };
        CHECK(agree(Approach(r, v, a, 1, -1).first(), walked(gap, 20), 20));
    }
}

TEST(curved_walls_without_gravity) {
    for (int n = 0; n < 40; ++n) {
        const Vec3 r = vector(0.5), v = vector(2);
        const auto gap = [&](double t) { return 1 - norm2(r + v * t); };
        CHECK(agree(exit_time(r, v, 1), walked(gap, 20), 20));
    }
    CHECK(exit_time({0.5, 0, 0}, {0, 0, 0}, 1) == kNever);
    CHECK(exit_time({1 + 1e-15, 0, 0}, {0, 1, 0}, 1) == 0);  // put outside by rounding
}

TEST(planes_with_and_without_gravity) {
    for (const double h : {-1.0, 0.0, 1.0}) {
        for (int n = 0; n < 20; ++n) {
            const double f = uniform(0.01, 3), s = uniform(-3, 3);
            const auto gap = [&](double t) { return f + s * t + 0.5 * h * t * t; };
            CHECK(agree(plane_time(f, s, h), walked(gap, 20), 20));
        }
    }
    CHECK(plane_time(0, -1, -1) == 0);
    CHECK(plane_time(0, 2, -1) == 4);       // up and back
    CHECK(plane_time(-1e-18, 0, -1) == 0);  // resting on it: at once
    CHECK(plane_time(-1e-18, 1, 0) == kNever);
}

TEST(the_nearest_image_is_the_same_from_both_sides) {
    for (int n = 0; n < 1000; ++n) {
        const double x = uniform(-1e6, 1e6);
        CHECK(nearest(-x) == -nearest(x));
        CHECK(std::abs(nearest(x) - x) <= 0.5);
    }
    CHECK(nearest(0.5) == 0 && nearest(1.5) == 2 && nearest(-0.5) == 0);
}
