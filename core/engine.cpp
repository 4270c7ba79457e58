#include "engine.hpp"

#include <cfenv>
#include <chrono>
#include <stdexcept>
#include <utility>

namespace carom {

namespace {

// Round to nearest, no flush to zero, whatever the caller (or a library it loaded) has set.
class PlainArithmetic {
public:
    PlainArithmetic() {
        std::fegetenv(&saved_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~PlainArithmetic() { std::fesetenv(&saved_); }
    PlainArithmetic(const PlainArithmetic&) = delete;
    PlainArithmetic& operator=(const PlainArithmetic&) = delete;

private:
    std::fenv_t saved_;
};

double seconds() {
    using clock = std::chrono::steady_clock;
    return std::chrono::duration<double>(clock::now().time_since_epoch()).count();
}

constexpr size_t kLogCapacity = size_t(1) << 17;

}  // namespace

Engine::Engine(const std::vector<StartSphere>& start, double time, const World& world,
               const Tuning& tuning)
    : world_(world), logging_(tuning.log), slice_(tuning.slice) {
    const PlainArithmetic plain;
    const size_t n = start.size();
    const Vec3& p = world_.period;
    inverse_period_ = {p.x > 0 ? 1 / p.x : 0, p.y > 0 ? 1 / p.y : 0, p.z > 0 ? 1 / p.z : 0};
    for (const double l : {p.x, p.y, p.z})
        if (l > 0) half_period_ = std::min(half_period_, 0.5 * l);
    periodic_ = half_period_ < kNever;
    gravity_ = norm2(world_.gravity) > 0;
    shells_on_ = world_.collide && n > 1;
    bool inelastic = world_.restitution < 1;
    for (const Wall& w : world_.walls) inelastic |= w.restitution < 1;

    spheres_.resize(n);
    bodies_.resize(n);
    events_.resize(n);
    falls_.resize(n);
    fresh_.resize(n);
    if (inelastic) watches_.resize(n);
    if (world_.contact_time > 0) last_touch_.assign(n, -kNever);
    for (size_t i = 0; i < n; ++i) {
        const StartSphere& s = start[i];
        spheres_[i] = {s.position, 0, s.velocity, s.radius};
        bodies_[i].mass = s.fixed ? kNever : s.mass;
        bodies_[i].image = s.image;
        events_[i].count = s.count;
        falls_[i] = gravity_ && !s.fixed;
        wrap(int32_t(i));
        if (s.resting && falls_[i]) settle(int(i));
    }
    choose_epoch(time);
    now_ = user_ = clock_.offset(time);
    for (Sphere& s : spheres_) s.t = now_;
    log_start_ = time;
    log_shift_ = user_;
    choose_shells(tuning);
    build_shells();
    predict_all();
}

Engine::Motion Engine::motion(int i, double t) const {
    const Sphere& s = spheres_[size_t(i)];
    const double dt = t - s.t;
    if (!falls_[size_t(i)]) return {s.x + s.v * dt, s.v};
    return {s.x + (s.v + world_.gravity * (0.5 * dt)) * dt, s.v + world_.gravity * dt};
}

// Is this the first physical event that belongs to a new epoch? After a silent epoch it does not:
// it is best solved from the anchors as they are.
bool Engine::epoch_over(const Entry& entry) const {
    const Event& event = events_[size_t(entry.id)];
    if (epoch_events_ == 0 || (event.t < clock_.epoch && !busy_epoch())) return false;
    if (!Calendar::live(entry, event) || event.partner <= kEscape) return false;
    return event.partner < 0 || events_[size_t(event.partner)].count == event.partner_count;
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
            user_ = std::max(user_, now_);
            return Stop::slice;
        }
        const Entry* top = calendar_.top(events_, limit);
        if (top == nullptr) {
            if (until == kNever) return Stop::idle;
            user_ = asked_ = std::max(user_, limit);
            asked_time_ = until;
            return Stop::time;
        }
        const Entry entry = *top;
        const Event& event = events_[size_t(entry.id)];
        if (epoch_over(entry)) {
            begin_epoch(entry.t);
            limit = clock_.offset(until);
            continue;
        }
        calendar_.pop();
        if (!Calendar::live(entry, event)) continue;
        now_ = entry.t;
        if (event.partner == kEscape) {
            escape(entry.id);
            continue;
        }
        if (event.partner >= 0 && events_[size_t(event.partner)].count != event.partner_count) {
            predict(entry.id);  // its partner has been hit by somebody else
            continue;
        }
        execute(entry.id);
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

StartSphere Engine::sphere(int i) const {
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
    double deepest = deepest_;
    for (size_t i = 0; shells_on_ && i < size(); ++i) {
        const Motion at = motion(int(i), user_);
        for (const int32_t j : rows_.of(int(i))) {
            if (j < int32_t(i)) continue;
            if (bodies_[i].fixed() && bodies_[size_t(j)].fixed()) continue;
            const double sigma = spheres_[i].r + spheres_[size_t(j)].r;
            const Vec3 d = at.x - motion(j, user_).x;
            const double r = norm(d - whole_boxes(d) * world_.period);
            deepest = std::max(deepest, (sigma - r) / sigma);
        }
    }
    return deepest;
}

std::vector<Record> Engine::take_log(double& start) {
    start = log_start_;
    log_start_ = time();
    log_shift_ = user_;
    return std::exchange(log_, {});
}

size_t Engine::bytes() const {
    const auto of = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
    return of(spheres_) + of(bodies_) + of(events_) + of(falls_) + of(fresh_) + of(last_touch_) +
           of(watches_) + of(shells_) + of(mark_) + rows_.bytes() + cells_.bytes() +
           calendar_.bytes();
}

void Engine::check() const {
    const auto demand = [](bool ok, const char* what) {
        if (!ok) throw std::logic_error(what);
    };
    for (size_t i = 0; i < size(); ++i) {
        const Event& e = events_[i];
        demand(e.t >= now_ || e.partner == kNone, "an event lies in the past");
        demand(spheres_[i].t <= now_, "an anchor lies in the future");
        if (!shells_on_) continue;
        const Motion at = motion(int(i), now_);
        const double margin = shells_[i].reach - spheres_[i].r;
        demand(e.t <= now_ || margin >= kEndless * margin_ ||  // about to be remade, or never
                   cells_.distance2(at.x, shells_[i].centre) <= margin * margin * (1 + 1e-9),
               "a sphere has left its shell unseen");
        std::vector<int32_t> found;
        cells_.search(shells_[i], shells_, found);
        demand(found.size() == rows_.size(int(i)) + 1, "a row misses a neighbour");
        for (const int32_t j : rows_.of(int(i))) {
            const auto row = rows_.of(j);
            demand(std::count(row.begin(), row.end(), int32_t(i)) == 1, "rows are not symmetric");
        }
    }
}

}  // namespace carom
