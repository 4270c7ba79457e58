// When a pair meets, exactly: in every image in which it can, with gravity or without; and the
// order of events of one time.
#include <algorithm>
#include <cmath>

#include "engine.hpp"

namespace carom {

namespace {

// The whole boxes m for which |r - m L| can be at most `reach`, along one axis.
struct Span {
    int32_t lo, hi;
};
Span images_within(double r, double reach, double inverse_period) {
    if (inverse_period == 0) return {0, 0};
    return {int32_t(std::ceil((r - reach) * inverse_period - 1e-9)),
            int32_t(std::floor((r + reach) * inverse_period + 1e-9))};
}

}  // namespace

// Order of simultaneous events of sphere i: (i, j, image) with i < j, as for events of different
// spheres in the calendar.
bool Engine::precedes(int i, const Next& p, const Next& q) const {
    if (p.t != q.t) return p.t < q.t;
    if (q.partner == kNone || q.partner == kEscape) return true;
    const auto label = [this](int32_t k) { return k >= 0 ? labels_[size_t(k)] : k; };
    const int32_t own = labels_[size_t(i)], with_p = label(p.partner), with_q = label(q.partner);
    const int32_t pa = with_p >= 0 ? std::min(own, with_p) : own,
                  qa = with_q >= 0 ? std::min(own, with_q) : own,
                  pb = with_p >= 0 ? std::max(own, with_p) : with_p,
                  qb = with_q >= 0 ? std::max(own, with_q) : with_q;
    if (pa != qa) return pa < qa;
    if (pb != qb) return pb < qb;
    const bool turned = own > with_p;  // the image as the lower of the two sees it
    const Image a = turned ? q.m : p.m, b = turned ? p.m : q.m;
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

// Two that have just collided cannot meet again in that image before either has had another event,
// unless something presses them together. Without this, rounding repeats collisions of no speed for
// ever.
bool Engine::just_met(int i, int32_t j, Image m) const {
    const Body &p = bodies_[size_t(i)], &q = bodies_[size_t(j)];
    return p.last == j && q.last == i && p.last_image == nearby(m + p.image - q.image);
}

// One pair in one image. r, v, a: relative motion at time `from`, the later of the two anchors.
void Engine::consider_image(int i, int32_t j, const Relative& rel, Image m, Next& best) const {
    const auto& [r, v, a, from] = rel;
    const double sigma = spheres_[size_t(i)].r + spheres_[size_t(j)].r;
    double wait = kNever;
    const bool free = norm2(a) == 0;
    if (free) {
        wait = contact_time(r, v, sigma);
        if (wait == kNever) return;
    }
    const bool again = just_met(i, j, m);
    if (free) {
        if (again) return;
    } else {
        const bool here = fresh_[size_t(i)] && fresh_[size_t(j)];  // still where they met
        wait = Approach(r, v, a, sigma, 1).first(again && here);
        if (wait == kNever) return;
    }
    const Next e{from + wait, j, m};
    if (precedes(i, e, best)) best = e;
}

// One pair, in all images in which it can meet.
void Engine::consider(int i, int32_t j, Next& best) const {
    ++work_.exact;
    Relative rel = relative(i, j);
    if (!periodic_) return consider_image(i, j, rel, {}, best);
    // The image is chosen from where both are now.
    const Vec3 here = flown(rel.r, rel.v, rel.a, now_ - rel.from);
    if (several_images_) {
        const double reach = spheres_[size_t(i)].r + spheres_[size_t(j)].r + 4 * margin(widest_);
        if (reach >= half_period_) {
            const Span x = images_within(here.x, reach, inverse_period_.x),
                       y = images_within(here.y, reach, inverse_period_.y),
                       z = images_within(here.z, reach, inverse_period_.z);
            const Vec3 r = rel.r;
            for (int32_t mx = x.lo; mx <= x.hi; ++mx)
                for (int32_t my = y.lo; my <= y.hi; ++my)
                    for (int32_t mz = z.lo; mz <= z.hi; ++mz) {
                        const Image m{mx, my, mz};
                        rel.r = r - shift(m, world_.period);
                        consider_image(i, j, rel, m, best);
                    }
            return;
        }
    }
    const Vec3 m = nearest(here * inverse_period_);
    rel.r -= m * world_.period;
    consider_image(i, j, rel, to_image(m), best);
}

void Engine::predict_walls(int i, Next& best) const {
    const Sphere& s = spheres_[size_t(i)];
    const Body& body = bodies_[size_t(i)];
    if (body.fixed()) return;
    const Vec3 a = acceleration(i);
    for (int k = 0; k < int(world_.walls.size()); ++k) {
        if (k == body.rests_on) continue;
        const double wait = wall_time(world_.walls[size_t(k)], s, a, body.last == wall_code(k));
        if (wait == kNever) continue;
        const Next e{s.t + wait, wall_code(k), {}};
        if (precedes(i, e, best)) best = e;
    }
}

}  // namespace carom
