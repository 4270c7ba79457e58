// The next event of a sphere.
#include "engine.hpp"

namespace carom {

// How long the sphere stays in its shell: exact without gravity, a safe lower bound with it.
double Engine::escape_time(int i) const {
    const int widening = rows_.line(i).margin;
    if (widening >= kEndless) return kNever;
    const Event& e = events_[size_t(i)];
    const Sphere& s = spheres_[size_t(i)];
    Four v = velocity_of(s), x = position_of(s) + v * (now_ - s.t);
    if (gravity_) {
        const Motion at = motion(i, now_);
        x = Four(at.x);
        v = Four(at.v);
    }
    const Four from = x - Four(e.shell_x, e.shell_yz[0], e.shell_yz[1], 0);
    const Vec3 d = (from - nearest(from * inverse_box_) * box_).three(), u = v.three();
    // A hair early: two that touch just as they leave touching shells must know each other by then.
    const double room = margin(widening) * (1 - 1e-9);
    const double v2 = norm2(u), left2 = room * room - norm2(d);
    if (falls_[size_t(i)] && gravity_) {
        const double left = room - norm(d);
        if (left <= 0) return now_;
        const double g = norm(world_.gravity);
        return now_ + 2 * left / (std::sqrt(v2) + std::sqrt(v2 + 2 * g * left));
    }
    if (v2 == 0) return kNever;
    if (left2 <= 0) return now_;
    // The sum without cancellation is a factor of either root. No branch: which way cannot be
    // foreseen (dense lists 1.03 times faster).
    const double b = dot(d, u), c = std::abs(b) + std::sqrt(b * b + v2 * left2);
    const double over[2] = {c, left2}, under[2] = {v2, c};
    return now_ + over[b > 0] / under[b > 0];
}

void Engine::find_event(int i) {
    if (glancing_) {
        refresh(i);
        return decide(i, look(i));
    }
    Next best;
    predict_walls(i, best);
    double leaves = kNever;
    if (shells_on_) {
        for (const Row& row : rows_.of(i)) {
            for (const int32_t j : row.ids()) fetch(&spheres_[size_t(j)]);
            for (const int32_t j : row.ids()) consider(i, j, best);
        }
        leaves = escape_time(i);
    }
    settle_on(i, best.t, best.partner, leaves, 0);
    if (several_images_) images_[size_t(i)] = best.m;
}

inline void Engine::settle_on(int i, double t, int32_t partner, double leaves, int axis) {
    Event& e = events_[size_t(i)];
    // No branch: which comes first cannot be foreseen, and is known late (1.02 times faster).
    const bool escapes = leaves <= t && leaves < kNever;  // of two at one time, this one first
    e.t = std::min(leaves, t);
    if (gridded_) {
        // Further than this, single precision may mistake who is first: look again at the crossing.
        const double wait = t - now_, most = 64 * cell_;
        const bool far = int(t < kNever) & int(escapes) &
                         int(wait * wait * norm2(spheres_[size_t(i)].v) > most * most);
        e.contact = far ? kNever : t;
        e.cell = Grid::pack(Grid::unpack(e.cell), axis);
        partner = far ? kEscape : partner;
    } else {
        partner = escapes ? kEscape : partner;
    }
    e.partner = partner;
    e.partner_count = events_[size_t(partner >= 0 ? partner : i)].count;
}

inline void Engine::look_at_exit(int i, Grid::Cell cell, Look& out) const {
    const Sphere& s = spheres_[size_t(i)];
    const Four v = velocity_of(s),
               here = position_of(s) + v * (now_ - s.t);  // no gravity on a grid
    const auto [wait, axis] = grid_.crossing(grid_.from_middle(here, cell), v, cell);
    out.leaves = now_ + wait;
    out.axis = axis;
}

void Engine::look_through(int i, const GridBlock& block, Look& out) const {
    int32_t n = collect(block, 1);
    int32_t* row = near_.id.data();
    for (int k = 1; k <= 16; ++k) row[n + k] = i;
    // The first place of each piece is not looked at: it is the last of the piece before.
    for (; n > 0; n -= Look::kPlaces, row += Look::kPlaces)
        out.add(kernels_->first_met(lens_, glances_.data(), glances_[size_t(i)], i, row,
                                    std::min(n, Look::kPlaces)),
                row, now_, lens_.time);
}

// What i and j see who are near each other: most of it is the same. False if they are not.
bool Engine::look_around_both(int i, int j, Look& a, Look& b) const {
    GridBlock block;
    const Grid::Cell p = Grid::unpack(events_[size_t(i)].cell),
                     q = Grid::unpack(events_[size_t(j)].cell);
    if (!grid_.around_both(p, q, block)) return false;
    look_at_exit(i, p, a);
    look_at_exit(j, q, b);
    int32_t n = collect(block, 1);
    int32_t* row = near_.id.data();
    row[0] = i;
    for (int k = 1; k <= 16; ++k) row[n + k] = i;
    const Glance* const me[2] = {&glances_[size_t(i)], &glances_[size_t(j)]};
    for (; n > 0; n -= Look::kPlaces, row += Look::kPlaces) {
        Guess met[2];
        kernels_->first_met_by_two(lens_, glances_.data(), me, row, std::min(n, Look::kPlaces),
                                   met);
        a.add(met[0], row, now_, lens_.time);
        b.add(met[1], row, now_, lens_.time);
    }
    return true;
}

// First half of a prediction: who of the neighbours may be met first, at a glance.
inline Engine::Look Engine::look(int i) const {
    Look out{kNever, kNone, kNever, kNever};
    if (gridded_) {
        const Grid::Cell cell = Grid::unpack(events_[size_t(i)].cell);
        look_at_exit(i, cell, out);
        look_through(i, grid_.around(cell), out);
        return out;
    }
    out.leaves = escape_time(i);
    for (const Row& part : rows_.of(i)) {
        const auto* row = reinterpret_cast<const int32_t*>(&part);
        out.add(kernels_->first_met(lens_, glances_.data(), glances_[size_t(i)], i, row, part.n),
                row, now_, lens_.time);
    }
    return out;
}

// Second half: only the guess is solved exactly. If another may come before even that one, all are.
inline void Engine::decide(int i, const Look& look) {
    double t = kNever;
    int32_t partner = kNone;
    if (!world_.walls.empty()) {
        Next wall;
        predict_walls(i, wall);
        t = wall.t;
        partner = wall.partner;
    }
    choose(i, look, t, partner);
    settle_on(i, t, partner, look.leaves, look.axis);
}

// Exact times are for what happens soon. Of two bounds far apart the first is next whatever the
// exact time, which is solved for when the bound is due: many a partner is hit by somebody else
// before, and by then it has come from memory.
inline void Engine::choose(int i, const Look& look, double& t, int32_t& partner) const {
    if (look.first == kNever) return;
    // On a grid what is met later is known for good, so that a crossing need look at new cells
    // only.
    const double limit = gridded_ ? t : std::min(t, look.leaves);
    const bool unsure = is_guess(partner);
    if (look.first > limit + (unsure ? doubt_ : 0)) return;
    if (far_ && look.first + doubt_ < std::min(limit, look.second) && look.partner != i &&
        !calendar_.in_hand(look.first)) {
        t = look.first;
        partner = guess_of(look.partner);
        return;
    }
    if (unsure) {
        Next best;
        predict_walls(i, best);
        each_near(i, [&](int32_t j) { consider(i, j, best); });
        t = best.t;
        partner = best.partner;
        return;
    }
    choose_exactly(i, look, t, partner);
}

void Engine::choose_exactly(int i, const Look& look, double& t, int32_t& partner) const {
    const double leaves = gridded_ ? kNever : look.leaves;
    double limit = std::min(t, leaves);
    if (look.first < kNever && look.first <= limit && look.partner != i) {
        const double met = contact(i, look.partner);
        if (met < t ||
            (met == t && t < kNever && precedes(i, {met, look.partner, {}}, {t, partner, {}}))) {
            t = met;
            partner = look.partner;
            limit = std::min(t, leaves);
        }
    }
    if (look.second == kNever || look.second > limit) return;
    Next best{t, partner, {}};
    each_near(i, [&](int32_t j) { consider(i, j, best); });
    t = best.t;
    partner = best.partner;
}

// A guess is due: its exact time, if it is what the bound promised. Otherwise its partner has been
// hit since, or was only brushed: all are looked at again, and this time solved.
void Engine::solve(int i) {
    Event& e = events_[size_t(i)];
    const int32_t j = guessed(e.partner);
    const double bound = e.t, met = contact(i, j);
    Look seen{kNever, kNone, kNever, kNever};
    if (met >= bound && met <= bound + doubt_) {
        if (gridded_) look_at_exit(i, Grid::unpack(e.cell), seen);
        return settle_on(i, met, j, seen.leaves, seen.axis);
    }
    ++work_.predictions;
    ++work_.stale;
    refresh(i);
    seen = look(i);
    Next wall;
    predict_walls(i, wall);
    choose_exactly(i, seen, wall.t, wall.partner);
    settle_on(i, wall.t, wall.partner, seen.leaves, seen.axis);
}

void Engine::make_sure(int i) {
    solve(i);
    calendar_.schedule(i, pending());
}

void Engine::open_bucket() {
    if (!far_) {
        if (!at_hand_) bring_near();
        return;
    }
    look_ahead();
    calendar_.review(pending(), [this](int i) {
        if (!is_guess(next_partner(events_[size_t(i)]))) return false;
        solve(i);
        return true;
    });
}

// The sphere enters the next cell of the grid. What it would have met, it still will; only the nine
// cells that come into sight can hold something sooner.
void Engine::change_cell(int i) {
    ++work_.shells;
    Event& e = events_[size_t(i)];
    const Grid::Cell old = Grid::unpack(e.cell);
    const int axis = Grid::axis(e.cell);
    const bool up = Grid::upwards(spheres_[size_t(i)].v, axis);
    const Grid::Cell cell = grid_.next(old, axis, up);
    grid_.remove(i, old);
    grid_.add(i, cell);
    e.cell = Grid::pack(cell, axis);
    profile_.lap(Profile::rebuild);
    if (e.partner == kEscape || stale(e)) return predict(i);
    refresh(i);
    Look seen{kNever, kNone, kNever, kNever};
    look_at_exit(i, cell, seen);
    look_through(i, grid_.face(cell, axis, up), seen);
    double t = e.contact;
    int32_t partner = e.partner;
    choose(i, seen, t, partner);
    settle_on(i, t, partner, seen.leaves, seen.axis);
    profile_.lap(Profile::predict);
    calendar_.schedule(i, pending());
    profile_.lap(Profile::queue);
}

inline double Engine::contact(int i, int32_t j) const {
    if (!gravity_) return free_contact(i, j);
    Next met;
    consider(i, j, met);
    return met.t;
}

// When two in free flight meet in the one image that they can: what `consider` finds for them.
inline double Engine::free_contact(int i, int32_t j) const {
    ++work_.exact;
    auto [r, v, from] = free_relative(i, j);
    const Four m = nearest((r + v * (now_ - from)) * inverse_box_);
    r = r - m * box_;
    const double sigma = spheres_[size_t(i)].r + spheres_[size_t(j)].r;
    const double wait = contact_time(r.three(), v.three(), sigma);
    if (bodies_[size_t(i)].last == j && just_met(i, j, to_image(m.three()))) return kNever;
    return from + wait;
}

void Engine::predict(int i) {
    ++work_.predictions;
    find_event(i);
    profile_.lap(Profile::predict);
    calendar_.schedule(i, pending());
    profile_.lap(Profile::queue);
}

// Both partners of a collision: the second is looked at while the first waits for memory.
void Engine::predict_both(int i, int j) {
    if (!glancing_) {
        predict(i);
        predict(j);
        return;
    }
    work_.predictions += 2;
    refresh(i);
    refresh(j);
    Look a{kNever, kNone, kNever, kNever}, b = a;
    if (!gridded_ || !look_around_both(i, j, a, b)) {
        a = look(i);
        b = look(j);
    }
    decide(i, a);
    decide(j, b);
    profile_.lap(Profile::predict);
    calendar_.schedule(i, pending());
    calendar_.schedule(j, pending());
    profile_.lap(Profile::queue);
}

}  // namespace carom
