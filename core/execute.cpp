// What an event does. Rules only say how the relative velocity changes; here alone it is applied.
#include "engine.hpp"

namespace carom {

void Engine::execute(int i) {
    const Event e = events_[size_t(i)];
    ++epoch_events_;
    if (e.partner < 0) {
        hit_wall(i, -1 - e.partner, e.t);
        ++wall_collisions_;
        profile_.lap(Profile::collide);
        if (crowded(i)) make_shell(i);
        predict(i);
        return;
    }
    // In the order of their labels, so that no bit depends on who is where in memory. A plain
    // collision is the same seen from either side.
    const bool turned = (!plain_ || logging_) && labels_[size_t(i)] > labels_[size_t(e.partner)];
    const int32_t lo = turned ? e.partner : i, hi = turned ? i : e.partner;
    const Image m = several_images_ ? images_[size_t(i)] : Image{};
    if (plain_)
        collide_plain(lo, hi, e.t);
    else
        collide(lo, hi, turned ? Image{} - m : m, e.t);
    ++collisions_;
    profile_.lap(Profile::collide);
    if (crowded(lo)) make_shell(lo);
    if (crowded(hi)) make_shell(hi);
    profile_.lap(Profile::rebuild);
    predict_both(lo, hi);
}

// The usual case, and the same bits as below: free flight, one image, restitution 1.
void Engine::collide_plain(int32_t i, int32_t j, double t) {
    const Sphere &p = spheres_[size_t(i)], &q = spheres_[size_t(j)];
    const auto [apart, v, from] = free_relative(i, j);
    const Four path = v * (t - from);
    const Four boxes = nearest((apart + path) * inverse_box_);
    const Vec3 r = (apart - boxes * box_ + path).three();
    const double sigma = p.r + q.r, r2 = norm2(r);
    if (r2 < sigma * sigma * shallow2_) meet_deeper((sigma - std::sqrt(r2)) / sigma);

    Body &a = bodies_[size_t(i)], &b = bodies_[size_t(j)];
    Pair share_a{0.5, 0}, share_b{0.5, 0};
    if (a.mass != b.mass || a.fixed()) {
        share_a = b.fixed() ? Pair{1, 0} : a.fixed() ? Pair{} : share(a.mass, b.mass);
        share_b = a.fixed() ? Pair{1, 0} : b.fixed() ? Pair{} : share(b.mass, a.mass);
    }
    const Vec3 change = smooth(r, v.three(), 1);
    const Image unwrapped =
        Image{int32_t(boxes.x()), int32_t(boxes.y()), int32_t(boxes.z())} + a.image - b.image;
    a.last = j, b.last = i;
    a.last_image = nearby(unwrapped), b.last_image = nearby(Image{} - unwrapped);
    if (logging_) log(t, i, j, change * (a.fixed() ? b.mass : a.mass * share_a.hi));
    const Four kick = Four(change), pv = velocity_of(p), qv = velocity_of(q);
    anchor_plain(i, position_of(p) + pv * (t - p.t), pv + (kick * share_a.hi + kick * share_a.lo),
                 t);
    anchor_plain(j, position_of(q) + qv * (t - q.t), qv - (kick * share_b.hi + kick * share_b.lo),
                 t);
}

void Engine::meet_deeper(double depth) {
    deepest_ = std::max(deepest_, depth);
    shallow2_ = (1 - deepest_) * (1 - deepest_) * (1 + 1e-15);  // no square of a distance above
}

void Engine::collide(int32_t i, int32_t j, Image m, double t) {
    const Motion p = motion(i, t), q = motion(j, t);
    // Not the difference of the two places: that loses digits far from the origin.
    const Relative rel = relative(i, j);
    const double dt = t - rel.from;
    const Vec3 path = (rel.v + rel.a * (0.5 * dt)) * dt, v = rel.v + rel.a * dt;
    if (periodic_ && !several_images_) m = to_image(whole_boxes(rel.r + path));  // they touch
    const Vec3 r = rel.r - shift(m, world_.period) + path;
    Body &a = bodies_[size_t(i)], &b = bodies_[size_t(j)];
    const double ri = spheres_[size_t(i)].r, rj = spheres_[size_t(j)].r;
    const double distance = norm(r), speed = std::min(0.0, dot(r, v) / distance);
    Pair share_a{0.5, 0}, share_b{0.5, 0};
    if (a.mass != b.mass || a.fixed()) {
        share_a = b.fixed() ? Pair{1, 0} : a.fixed() ? Pair{} : share(a.mass, b.mass);
        share_b = a.fixed() ? Pair{1, 0} : b.fixed() ? Pair{} : share(b.mass, a.mass);
    }
    const double mu = a.fixed() ? b.mass : a.mass * share_a.hi;
    deepest_ = std::max(deepest_, (ri + rj - distance) / (ri + rj));

    const double nominal = world_.restitution;
    const double e = recent(i, t) || recent(j, t) ? 1 : nominal;
    Vec3 change;       // of the relative velocity
    double least = 0;  // rebound speed below which one would rest on the other
    if (falls_[size_t(i)] != falls_[size_t(j)]) {
        const double press = -dot(acceleration(i) - acceleration(j), r) / distance;
        least = rebound_floor(press, least_rise(nominal, std::min(ri, rj)));
    }
    const bool hop = e * -speed < least;
    if (hop) {
        change = r * ((least - speed) / distance);
        dissipated_ += 0.5 * mu * (speed * speed - least * least);
    } else {
        change = smooth(r, v, e);
        if (e < 1)
            dissipated_ += 0.5 * mu * (1 - e * e) * speed * speed;
        else if (nominal < 1)
            withheld_ += 0.5 * mu * (1 - nominal * nominal) * speed * speed;
    }

    const Image unwrapped = m + a.image - b.image;
    a.last = j, b.last = i;
    a.last_image = nearby(unwrapped), b.last_image = nearby(Image{} - unwrapped);
    const Vec3 impulse = change * mu;
    log(t, i, j, impulse);
    anchor(i, p.x, p.v + change * share_a, t);
    anchor(j, q.x, q.v - change * share_b, t);
    wake(i, impulse, t);
    wake(j, impulse, t);
    if (e < 1 && !hop) watch(i, j, t, norm(v));
}

void Engine::hit_wall(int32_t i, int k, double t) {
    const Wall& w = world_.walls[size_t(k)];
    const Motion at = motion(i, t);
    Body& body = bodies_[size_t(i)];
    const double r = spheres_[size_t(i)].r, mass = body.mass;
    const double e = recent(i, t) ? 1 : w.restitution;

    const Vec3 d = w.kind == WallKind::plane ? w.normal : -across(w, at.x);
    const double length = norm(d), speed = std::min(0.0, dot(at.v, d) / length);
    double press = std::max(0.0, -dot(acceleration(i), d) / length);
    if (w.kind != WallKind::plane && w.restitution < 1) {
        // Following a curve presses onto it too.
        press += (norm2(across(w, at.v)) - speed * speed) / (w.offset - r);
    }
    const double least = rebound_floor(press, least_rise(w.restitution, r));
    const bool lasting = e * -speed < least;
    const bool rests = lasting && w.kind == WallKind::plane &&
                       norm(cross(world_.gravity, d)) <= 1e-12 * norm(world_.gravity) * length;

    Vec3 v = at.v;
    if (lasting) {
        const double out = rests ? 0 : least;
        if (w.bounce_back)
            v = (v - d * (speed / length)) * -e + d * (out / length);
        else
            v += d * ((out - speed) / length);
    } else if (w.bounce_back) {
        v = v * -e;
    } else {
        v = reflect(v, d, e);
    }
    if (lasting || e < 1)
        dissipated_ += 0.5 * mass * (norm2(at.v) - norm2(v));
    else if (w.restitution < 1)
        withheld_ += 0.5 * mass * (1 - w.restitution * w.restitution) *
                     (w.bounce_back ? norm2(at.v) : speed * speed);

    const Vec3 impulse = (v - at.v) * mass;
    body.last = wall_code(k);
    log(t, i, rests ? kCameToRest - k : wall_code(k), impulse);
    anchor(i, at.x, v, t);
    if (rests) {
        body.rests_on = int16_t(k);
        falls_[size_t(i)] = 0;
    } else {
        wake(i, impulse, t);
    }
    if (e < 1 && !lasting) watch(i, wall_code(k), t, norm(at.v));
}

// The same as below, where there is nothing else to do.
inline void Engine::anchor_plain(int32_t i, Four x, Four v, double t) {
    const Four boxes = nearest(x * inverse_box_);
    x = (x - boxes * box_).with_fourth(t);
    place(spheres_[size_t(i)], x, v);  // of which a kick has changed no radius
    ++events_[size_t(i)].count;
    if (boxes.x() == 0 && boxes.y() == 0 && boxes.z() == 0) return;
    Image& image = bodies_[size_t(i)].image;
    image = image + to_image(boxes.three());
}

// The sphere leaves its last event from x with velocity v.
void Engine::anchor(int32_t i, const Vec3& x, const Vec3& v, double t) {
    Sphere& s = spheres_[size_t(i)];
    place(s, Four(x, t), Four(v, s.r));
    wrap(i);
    if (gravity_) fresh_[size_t(i)] = 1;
    ++events_[size_t(i)].count;
    if (!last_touch_.empty()) last_touch_[size_t(i)] = t;
}

void Engine::wrap(int32_t i) {
    if (!periodic_) return;
    Sphere& s = spheres_[size_t(i)];
    const Vec3 boxes = whole_boxes(s.x);
    if (boxes.x == 0 && boxes.y == 0 && boxes.z == 0) return;
    s.x -= boxes * world_.period;
    bodies_[size_t(i)].image = bodies_[size_t(i)].image + to_image(boxes);
}

// An impulse across the wall it rests on sets a sphere free.
void Engine::wake(int32_t i, const Vec3& impulse, double t) {
    Body& body = bodies_[size_t(i)];
    if (body.rests_on < 0) return;
    if (dot(impulse, world_.walls[size_t(body.rests_on)].normal) == 0) return;
    body.rests_on = -1;
    falls_[size_t(i)] = 1;
    log(t, i, kWoke, {});
}

bool Engine::recent(int32_t i, double t) const {
    return !last_touch_.empty() && t - last_touch_[size_t(i)] < world_.contact_time;
}

void Engine::watch(int32_t i, int32_t j, double t, double speed) {
    for (const int32_t k : {i, j}) {
        if (k < 0 || bodies_[size_t(k)].fixed()) continue;
        if (watches_[size_t(k)].collapsed(t, speed, spheres_[size_t(k)].r, size()) &&
            collapse_.i == kNone)
            collapse_ = {clock_.time(t), labels_[size_t(i)], j >= 0 ? labels_[size_t(j)] : j};
    }
}

void Engine::log(double t, int32_t i, int32_t j, const Vec3& impulse) {
    if (!logging_) return;
    const int32_t partner = j >= 0 ? labels_[size_t(j)] : j;
    log_.push_back({clock_.time(t), labels_[size_t(i)], partner, impulse});
}

}  // namespace carom
