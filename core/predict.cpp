// The next event of a sphere, and who its neighbours are.
#include "engine.hpp"

namespace carom {

namespace {

// r(t) and v(t) of a flight anchored at time zero.
inline Vec3 flown(const Vec3& x, const Vec3& v, const Vec3& a, double t) {
    return x + (v + a * (0.5 * t)) * t;
}

constexpr size_t kLonely = 10, kCrowded = 30;  // neighbours

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
bool Engine::precedes(int i, const Event& p, const Event& q) const {
    if (p.t != q.t) return p.t < q.t;
    if (q.partner == kNone || q.partner == kEscape) return true;
    const int32_t pa = p.partner >= 0 ? std::min(i, p.partner) : i,
                  qa = q.partner >= 0 ? std::min(i, q.partner) : i,
                  pb = p.partner >= 0 ? std::max(i, p.partner) : p.partner,
                  qb = q.partner >= 0 ? std::max(i, q.partner) : q.partner;
    if (pa != qa) return pa < qa;
    if (pb != qb) return pb < qb;
    const bool turned = i > p.partner;  // the image as the lower of the two sees it
    const Image a = turned ? q.m : p.m, b = turned ? p.m : q.m;
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

// One pair in one image. r, v, a: relative motion at time `from`, the later of the two anchors.
void Engine::consider_pair(int i, int32_t j, const Vec3& r, const Vec3& v, const Vec3& a, Image m,
                           double sigma, double from, Event& best) const {
    double wait = kNever;
    const bool free = norm2(a) == 0;
    if (free) {
        wait = contact_time(r, v, sigma);
        if (wait == kNever) return;
    }
    // Two that have just collided cannot meet again in that image before either has had another
    // event, unless something presses them together. Without this, rounding repeats collisions of
    // no speed for ever.
    const Body &p = bodies_[size_t(i)], &q = bodies_[size_t(j)];
    const bool just_met = p.last == j && q.last == i && p.last_image == m + p.image - q.image;
    if (free) {
        if (just_met) return;
    } else {
        const bool here = fresh_[size_t(i)] && fresh_[size_t(j)];  // still where they met
        wait = Approach(r, v, a, sigma, 1).first(just_met && here);
        if (wait == kNever) return;
    }
    Event e = best;
    e.t = from + wait;
    e.partner = j;
    e.m = m;
    if (precedes(i, e, best)) best = e;
}

// From the later anchor on both fly freely: what is predicted depends on nothing else.
inline Relative relative_free(const Sphere& p, const Sphere& q) {
    const double from = p.t > q.t ? p.t : q.t;
    return {(p.x + p.v * (from - p.t)) - (q.x + q.v * (from - q.t)), p.v - q.v, {}, from};
}

Relative Engine::relative(int i, int j) const {
    const Sphere &p = spheres_[size_t(i)], &q = spheres_[size_t(j)];
    if (!gravity_) return relative_free(p, q);
    const Vec3 pa = acceleration(i), qa = acceleration(j);
    const double from = p.t > q.t ? p.t : q.t, dp = from - p.t, dq = from - q.t;
    return {flown(p.x, p.v, pa, dp) - flown(q.x, q.v, qa, dq), (p.v + pa * dp) - (q.v + qa * dq),
            pa - qa, from};
}

template <bool kGravity, bool kImages>
void Engine::predict_pairs(int i, Event& best) const {
    const Sphere& p = spheres_[size_t(i)];
    for (const int32_t j : rows_.of(i)) fetch(&spheres_[size_t(j)]);
    for (const int32_t j : rows_.of(i)) {
        const Sphere& q = spheres_[size_t(j)];
        Relative rel = kGravity ? relative(i, j) : relative_free(p, q);
        auto& [r, v, a, from] = rel;
        const double sigma = p.r + q.r;
        Vec3 m;  // image, chosen from where both are now
        if (periodic_) {
            const Vec3 here = kGravity ? flown(r, v, a, now_ - from) : r + v * (now_ - from);
            if constexpr (kImages) {
                const double reach = sigma + 4 * widest_margin_;
                if (reach >= half_period_) {
                    const Span x = images_within(here.x, reach, inverse_period_.x),
                               y = images_within(here.y, reach, inverse_period_.y),
                               z = images_within(here.z, reach, inverse_period_.z);
                    for (int32_t mx = x.lo; mx <= x.hi; ++mx)
                        for (int32_t my = y.lo; my <= y.hi; ++my)
                            for (int32_t mz = z.lo; mz <= z.hi; ++mz) {
                                const Image each{mx, my, mz};
                                consider_pair(i, j, r - shift(each, world_.period), v, a, each,
                                              sigma, from, best);
                            }
                    continue;
                }
            }
            m = nearest(here * inverse_period_);
            r -= m * world_.period;
        }
        // Most pairs end here: they part.
        if (!kGravity && dot(r, v) >= 0) continue;
        consider_pair(i, j, r, v, a, to_image(m), sigma, from, best);
    }
}

void Engine::predict_walls(int i, Event& best) const {
    const Sphere& s = spheres_[size_t(i)];
    const Body& body = bodies_[size_t(i)];
    if (body.fixed()) return;
    const Vec3 a = acceleration(i);
    for (int k = 0; k < int(world_.walls.size()); ++k) {
        if (k == body.rests_on) continue;
        const double wait = wall_time(world_.walls[size_t(k)], s, a, body.last == wall_code(k));
        if (wait == kNever) continue;
        Event e = best;
        e.t = s.t + wait;
        e.partner = wall_code(k);
        e.m = {};
        if (precedes(i, e, best)) best = e;
    }
}

// How long the sphere stays in its shell: exact without gravity, a safe lower bound with it.
double Engine::escape_time(int i) const {
    const Sphere& s = spheres_[size_t(i)];
    const Motion at = motion(i, now_);
    Vec3 d = at.x - shells_[size_t(i)].centre;
    d -= nearest(d * inverse_period_) * world_.period;
    double margin = shells_[size_t(i)].reach - s.r;
    if (margin >= kEndless * margin_) return kNever;
    // A hair early: two that touch just as they leave touching shells must know each other by then.
    margin *= 1 - 1e-9;
    const double v2 = norm2(at.v), room = margin * margin - norm2(d);
    if (falls_[size_t(i)] && gravity_) {
        const double left = margin - norm(d);
        if (left <= 0) return now_;
        const double g = norm(world_.gravity);
        return now_ + 2 * left / (std::sqrt(v2) + std::sqrt(v2 + 2 * g * left));
    }
    if (v2 == 0) return kNever;
    if (room <= 0) return now_;
    const double b = dot(d, at.v), q = std::sqrt(b * b + v2 * room);
    return now_ + (b > 0 ? room / (b + q) : (q - b) / v2);
}

void Engine::predict(int i) {
    find_event(i);
    calendar_.schedule(i, events_[size_t(i)]);
}

void Engine::find_event(int i) {
    Event best = events_[size_t(i)];
    best.t = kNever;
    best.partner = kNone;
    best.m = {};
    predict_walls(i, best);
    if (shells_on_) {
        const bool images = half_period_ < kNever;
        if (gravity_)
            images ? predict_pairs<true, true>(i, best) : predict_pairs<true, false>(i, best);
        else
            images ? predict_pairs<false, true>(i, best) : predict_pairs<false, false>(i, best);
        const double leaves = escape_time(i);
        if (leaves <= best.t && leaves < kNever) {  // of two at one time, this one first
            best.t = leaves;
            best.partner = kEscape;
        }
    }
    best.partner_count = best.partner >= 0 ? events_[size_t(best.partner)].count : 0;
    events_[size_t(i)] = best;
}

// The sphere leaves its shell: make a new one around it.
void Engine::escape(int i) {
    const Shell& shell = shells_[size_t(i)];
    const double margin = shell.reach - spheres_[size_t(i)].r;
    if (gravity_ && falls_[size_t(i)]) {
        // Only a bound was due. Keep the shell while the sphere is well inside.
        if (cells_.distance2(motion(i, now_).x, shell.centre) < 0.5 * margin * margin)
            return predict(i);
    }
    make_shell(i);
    predict(i);
}

bool Engine::crowded(int i) const {
    return rows_.size(i) > kCrowded &&
           shells_[size_t(i)].reach - spheres_[size_t(i)].r > 1.01 * least_margin(i);
}

// A shell around where the sphere is now, and with it its row of neighbours. A sphere that flies
// alone gets a wider shell each time, so that an expanding cloud costs ever less.
void Engine::make_shell(int i) {
    Shell& shell = shells_[size_t(i)];
    const double r = spheres_[size_t(i)].r, margin = shell.reach - r;
    double wish = margin;
    if (crowded(i))
        wish = std::max(0.5 * margin, least_margin(i));
    else if (rows_.size(i) * 4 < kLonely && margin < most_margin_)
        wish = std::min(2 * margin, most_margin_);

    cells_.remove(i, shell);
    const Motion at = motion(i, now_);
    const double speed = norm(at.v);
    for (;;) {
        // Ahead of the sphere, where it will be (a fourth fewer shells at packing fraction 0.25;
        // in a dense fluid, where it soon turns round, none).
        const double ahead = speed > 0 && margin_ > 0.5 * r ? 0.6 * wish / speed : 0;
        shell.centre = at.x + at.v * ahead;
        shell.reach = r + wish;
        found_.clear();
        cells_.search(shell, shells_, found_);
        if (wish <= margin || found_.size() <= kLonely) break;
        wish = margin;
    }
    widest_margin_ = std::max(widest_margin_, wish);
    cells_.add(i, shell);

    // Rows are symmetric: whoever joins or leaves this row gains or loses i in its own.
    if (stamp_ > UINT32_MAX - 2) {
        std::fill(mark_.begin(), mark_.end(), 0);
        stamp_ = 0;
    }
    stamp_ += 2;
    for (const int32_t j : found_) mark_[size_t(j)] = stamp_;
    const auto old = rows_.of(i);
    std::vector<int32_t>& gone = gone_;
    gone.clear();
    for (const int32_t j : old) {
        if (mark_[size_t(j)] == stamp_)
            mark_[size_t(j)] = stamp_ + 1;  // in both
        else
            gone.push_back(j);
    }
    for (const int32_t j : gone) fetch(rows_.line(j));
    for (const int32_t j : found_)
        if (mark_[size_t(j)] == stamp_) fetch(rows_.line(j));
    for (const int32_t j : gone) {
        rows_.remove(i, j);
        rows_.remove(j, i);
    }
    for (const int32_t j : found_) {
        if (mark_[size_t(j)] == stamp_ + 1) continue;
        rows_.add(i, j);
        rows_.add(j, i);
    }
}

}  // namespace carom
