#include "engine.hpp"

#include <stdexcept>
#include <utility>

#include "arithmetic.hpp"

namespace carom {

namespace {

constexpr size_t kLogCapacity = size_t(1) << 17;

}  // namespace

Engine::Engine(const StartSpheres& start, double time, const World& world, const Tuning& tuning)
    : world_(world),
      tuning_(tuning),
      kernels_(&kernels(tuning.simd)),
      sort_(tuning.sort),
      logging_(tuning.log),
      slice_(tuning.slice) {
    const PlainArithmetic plain;
    if (tuning.profile) profile_.start();
    const size_t n = start.size();
    const Vec3& p = world_.period;
    inverse_period_ = {p.x > 0 ? 1 / p.x : 0, p.y > 0 ? 1 / p.y : 0, p.z > 0 ? 1 / p.z : 0};
    box_ = Four(p);
    inverse_box_ = Four(inverse_period_);
    for (const double l : {p.x, p.y, p.z})
        if (l > 0) half_period_ = std::min(half_period_, 0.5 * l);
    periodic_ = half_period_ < kNever;
    gravity_ = norm2(world_.gravity) > 0;
    shells_on_ = world_.collide && n > 1;
    bool inelastic = world_.restitution < 1;
    for (const Wall& w : world_.walls) inelastic |= w.restitution < 1;

    labels_.resize(n);
    places_.resize(n);
    spheres_.resize(n);
    bodies_.resize(n);
    events_.resize(n);
    falls_.resize(n);
    fresh_.resize(n);
    if (inelastic) watches_.resize(n);
    if (world_.contact_time > 0) last_touch_.assign(n, -kNever);
    for (size_t i = 0; i < n; ++i) {
        const StartSphere s = start[i];
        labels_[i] = places_[i] = int32_t(i);
        spheres_[i] = {s.position, 0, s.velocity, s.radius};
        bodies_[i].mass = s.fixed ? kNever : s.mass;
        bodies_[i].image = s.image;
        events_[i].count = s.count;
        falls_[i] = gravity_ && !s.fixed;
        wrap(int32_t(i));
        if (s.resting && falls_[i]) settle(int(i));
    }
    choose_epoch(time);
    now_ = user_ = happened_ = clock_.offset(time);
    for (Sphere& s : spheres_) s.t = now_;
    choose_shells(tuning);
    sort_in_memory();
    build_shells();
    predict_all();
}

// Is this the first physical event that belongs to a new epoch? After a silent epoch it does not:
// it is best solved from the anchors as they are.
bool Engine::epoch_over(const Calendar::Due& due) const {
    if (epoch_events_ == 0 || (due.t < clock_.epoch && !busy_epoch())) return false;
    const Event& event = events_[size_t(due.id)];
    return !is_bookkeeping(next_partner(event)) && !stale(event);
}

Stop Engine::advance(double until, int64_t max_collisions, int64_t max_events) {
    const PlainArithmetic plain;
    if (collapse_.i != kNone) return Stop::collapse;
    if (max_collisions <= 0 || max_events <= 0) return Stop::count;
    const double deadline = seconds() + slice_;
    const size_t full = log_.size() + kLogCapacity;
    const int64_t last_collision = collisions_ + max_collisions;
    const int64_t last_event = collisions_ + wall_collisions_ + max_events;
    double limit = clock_.offset(until);

    for (unsigned k = 1;; ++k) {
        if (k % 64 == 0 && seconds() > deadline) {
            // Who asks for no time sees none that only bookkeeping has reached.
            user_ = std::max(user_, until < kNever ? now_ : happened_);
            return Stop::slice;
        }
        Calendar::Due due;
        profile_.begin(k);
        if (!calendar_.next(pending(), limit, due, [this] { open_bucket(); })) {
            if (until == kNever) return Stop::idle;
            user_ = asked_ = std::max(user_, limit);
            asked_time_ = until;
            return Stop::time;
        }
        if (epoch_over(due)) {
            begin_epoch(due.t);
            limit = clock_.offset(until);
            continue;
        }
        calendar_.pop();
        profile_.lap(Profile::queue);
        now_ = due.t;
        if (now_ > focused_until_) look_again();
        const Event& event = events_[size_t(due.id)];
        if (const int32_t partner = next_partner(event); is_bookkeeping(partner)) {
            if (partner != kEscape)
                make_sure(due.id);
            else
                gridded_ ? change_cell(due.id) : escape(due.id);
            continue;
        }
        if (stale(event)) {
            ++work_.stale;
            predict(due.id);  // its partner has been hit by somebody else
            continue;
        }
        execute(due.id);
        happened_ = now_;
        if (collapse_.i == kNone && collisions_ < last_collision &&
            collisions_ + wall_collisions_ < last_event && log_.size() < full)
            continue;
        user_ = now_;
        if (collapse_.i != kNone) return Stop::collapse;
        return log_.size() >= full && collisions_ < last_collision &&
                       collisions_ + wall_collisions_ < last_event
                   ? Stop::slice
                   : Stop::count;
    }
}

StartSphere Engine::sphere(int number) const {
    const int i = places_[size_t(number)];
    const Motion at = motion(i, user_);
    const Body& body = bodies_[size_t(i)];
    StartSphere s;
    const Vec3 boxes = periodic_ ? whole_boxes(at.x) : Vec3{};
    s.position = at.x - boxes * world_.period;
    s.image = body.image + to_image(boxes);
    s.velocity = at.v;
    s.radius = spheres_[size_t(i)].r;
    s.fixed = body.fixed();
    s.mass = body.mass;
    s.resting = body.rests_on >= 0;
    s.count = events_[size_t(i)].count;
    return s;
}

double Engine::max_overlap() const {
    const PlainArithmetic plain;
    double deepest = deepest_;
    for (size_t i = 0; shells_on_ && i < size(); ++i) {
        const Motion at = motion(int(i), user_);
        each_near(int(i), [&](int32_t j) {
            if (j < int32_t(i) || (bodies_[i].fixed() && bodies_[size_t(j)].fixed())) return;
            const double sigma = spheres_[i].r + spheres_[size_t(j)].r;
            const Vec3 d = at.x - motion(j, user_).x;
            const double r = norm(d - whole_boxes(d) * world_.period);
            deepest = std::max(deepest, (sigma - r) / sigma);
        });
    }
    return deepest;
}

std::vector<Record> Engine::take_log() { return std::exchange(log_, {}); }

size_t Engine::bytes() const {
    const auto of = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
    return of(labels_) + of(places_) + of(spheres_) + of(bodies_) + of(events_) + of(images_) +
           of(falls_) + of(fresh_) + of(last_touch_) + of(watches_) + of(glances_) + rows_.bytes() +
           cells_.bytes() + calendar_.bytes();
}

}  // namespace carom
