// The event loop: the only place that knows the order of things.
//
// engine.cpp    the loop, and what the outside sees
// setup.cpp     building: shells, grid, epochs
// shells.cpp    who is near whom
// order.cpp     who lies next to whom in memory
// predict.cpp   the next event of a sphere
// ahead.cpp     what the next events will touch
// execute.cpp   what an event does
// checkpoint.cpp, check.cpp
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "calendar.hpp"
#include "cells.hpp"
#include "clock.hpp"
#include "glance.hpp"
#include "grid.hpp"
#include "neighbours.hpp"
#include "profile.hpp"
#include "rules.hpp"
#include "spheres.hpp"
#include "world.hpp"

namespace carom {

// So many spheres are found in the caches: beyond, looking ahead pays. And so many in the cache
// next to the processor: beyond, it pays to bring some lines there. Measured on both sides.
constexpr size_t kListsInCache = 14000, kGridInCache = 64000;
constexpr size_t kListsAtHand = 1000, kGridAtHand = 12000;

constexpr int kEndless = 60;  // doublings: such a shell is wider than positions are resolved

// How one sphere moves as seen from another, from time `from` on.
struct Relative {
    Vec3 r, v, a;
    double from;
};

// The same in free flight.
struct FreeRelative {
    Four r, v;
    double from;
};

class Engine {
public:
    Engine(const StartSpheres& start, double time, const World& world, const Tuning& tuning);

    Stop advance(double until, int64_t max_collisions, int64_t max_events);

    size_t size() const { return spheres_.size(); }
    double time() const { return user_ == asked_ ? asked_time_ : clock_.time(user_); }
    int64_t collisions() const { return collisions_; }
    int64_t wall_collisions() const { return wall_collisions_; }
    double dissipated() const { return dissipated_.value(); }
    double withheld() const { return withheld_.value(); }
    const Collapse& collapse() const { return collapse_; }
    double max_overlap() const;
    StartSphere sphere(int number) const;  // at time()
    size_t bytes() const;
    const Work& work() const { return work_; }
    const Profile& profile() const { return profile_; }

    // All events since the last call.
    std::vector<Record> take_log();

    // The stored states as they are. Predictions are pure, so the queue need not be saved.
    std::string checkpoint() const;
    void restore(const std::string& bytes);

    void check() const;  // throws std::logic_error if a structure contradicts another

private:
    friend struct EngineProbe;  // core/tests
    struct Motion {
        Vec3 x, v;
    };
    struct Next {  // an event that may be a sphere's next
        double t = kNever;
        int32_t partner = kNone;
        Image m;  // of the partner, relative to the anchors
    };

    struct Look {                           // half a prediction
        static constexpr int kPlaces = 63;  // of a row looked through at once
        double leaves;                      // its shell or cell at this time
        int32_t partner;                    // may be met first,
        double first;                       // not before this time,
        double second;                      // and any other not before this
        int axis = 0;                       // along which it leaves its cell
        void add(const Guess& guess, const int32_t* row, double now, double unit) {
            const double t1 = now + guess.first * unit, t2 = now + guess.second * unit;
            if (guess.slot == 0) return;
            if (t1 < first) {
                second = std::min(first, t2);
                first = t1;
                partner = row[guess.slot];
            } else {
                second = std::min(second, t1);
            }
        }
    };

    // check.cpp
    void check_cell(int i) const;
    void check_shell(int i) const;

    // setup.cpp
    bool choose_grid(const Tuning& tuning);
    bool room(Vec3& centre, Vec3& size) const;
    bool build_grid();
    void choose_shells(const Tuning& tuning);
    void choose_epoch(double time);
    void build_shells();
    bool build_shells_once();
    void predict_all();
    void begin_epoch(double t);
    void settle(int i);
    bool sort_in_memory();

    // engine.cpp
    Motion motion(int i, double t) const;
    bool epoch_over(const Calendar::Due& due) const;
    bool stale(const Event& event) const {
        return event.partner >= 0 && events_[size_t(event.partner)].count != event.partner_count;
    }
    bool busy_epoch() const {
        return epoch_events_ >= 64 * int64_t(size()) && clock_.epoch > clock_.shortest;
    }
    Vec3 acceleration(int i) const { return falls_[size_t(i)] ? world_.gravity : Vec3{}; }
    Vec3 whole_boxes(const Vec3& x) const { return nearest(x * inverse_period_); }
    Pending pending() const { return {events_.data(), labels_.data(), size(), gridded_}; }
    int32_t next_partner(const Event& e) const { return pending().partner(e); }

    // predict.cpp
    void predict(int i);
    void predict_both(int i, int j);
    void find_event(int i);
    void refresh(int i);
    Look look(int i) const;
    void choose(int i, const Look& look, double& t, int32_t& partner) const;
    void choose_exactly(int i, const Look& look, double& t, int32_t& partner) const;
    void solve(int i);
    void make_sure(int i);
    void open_bucket();
    void decide(int i, const Look& look);
    double contact(int i, int32_t j) const;
    double free_contact(int i, int32_t j) const;
    void settle_on(int i, double t, int32_t partner, double leaves, int axis);
    template <class Visit>
    void each_near(int i, const Visit& visit) const;
    int32_t collect(const GridBlock& block, size_t first) const;
    void look_at_exit(int i, Grid::Cell cell, Look& out) const;
    bool look_around_both(int i, int j, Look& a, Look& b) const;
    void look_through(int i, const GridBlock& block, Look& out) const;
    void change_cell(int i);
    void predict_walls(int i, Next& best) const;
    void consider(int i, int32_t j, Next& best) const;
    bool just_met(int i, int32_t j, Image m) const;
    void consider_image(int i, int32_t j, const Relative& rel, Image m, Next& best) const;
    bool precedes(int i, const Next& p, const Next& q) const;
    Relative relative(int i, int j) const;
    FreeRelative free_relative(int i, int j) const;
    double escape_time(int i) const;

    // shells.cpp
    void escape(int i);
    Vec3 ahead(const Motion& at, double r, int widening) const;
    void make_shell(int i);
    void renew_shell(int i);
    bool crowded(int i) const;
    int least_widening(int i) const { return spheres_[size_t(i)].r > giant_ ? 0 : least_widening_; }
    double margin(int widening) const;
    Shell shell(int i) const;
    void place_shell(int i, const Vec3& centre, int widening);
    void exchange(int i);
    void tell_neighbours(int i);
    void focus();
    void look_again();

    // ahead.cpp
    void look_ahead() const;
    void bring_near() const;
    void ask_for_pair(int i, int32_t j) const;
    void ask_for_rows(int i, const Event& e) const;
    void ask_for_row_neighbours(int i, const Event& e) const;
    GridBlock new_cells(int i, const Event& e) const;
    void ask_for_cells(int i, const Event& e) const;
    GridBlock cells_of_both(int i, int32_t j) const;
    void ask_for_partners_cells(int i, const Event& e) const;
    void ask_for_cell_neighbours(int i, const Event& e) const;

    // execute.cpp
    void execute(int i);
    void collide(int32_t i, int32_t j, Image m, double t);
    void collide_plain(int32_t i, int32_t j, double t);
    void meet_deeper(double depth);
    void hit_wall(int32_t i, int k, double t);
    void anchor(int32_t i, const Vec3& x, const Vec3& v, double t);
    void wrap(int32_t i);
    void anchor_plain(int32_t i, Four x, Four v, double t);
    void wake(int32_t i, const Vec3& impulse, double t);
    bool recent(int32_t i, double t) const;
    void watch(int32_t i, int32_t j, double t, double speed);
    void log(double t, int32_t i, int32_t j, const Vec3& impulse);

    World world_;
    Tuning tuning_;
    Vec3 inverse_period_;
    Four box_, inverse_box_;  // the period and its inverse
    bool gravity_ = false, periodic_ = false;
    bool plain_ = false;           // free flight, one image, restitution 1
    bool shells_on_ = true;        // neighbours matter at all
    double half_period_ = kNever;  // of the shortest periodic axis

    Clock clock_;
    double now_ = 0;                          // offset of the event in hand
    double user_ = 0;                         // offset of the time the outside sees
    double happened_ = 0;                     // of the last physical event
    double asked_ = kNever, asked_time_ = 0;  // offset of the last `until`, and it to the bit
    int64_t epoch_events_ = 0;

    // One entry per sphere, in an order of the engine's own: see sort_in_memory.
    Array<int32_t> labels_;  // the sphere's number outside
    Array<int32_t> places_;  // where the sphere of that number is
    Array<Sphere> spheres_;
    Array<Body> bodies_;
    Array<Event> events_;
    Array<Image> images_;       // of the events' partners, where a box is so small that it matters
    Array<uint8_t> falls_;      // gravity acts on it: neither fixed nor resting
    Array<uint8_t> fresh_;      // its anchor is its last event, not the start of an epoch
    Array<double> last_touch_;  // TC model only
    Array<Watch> watches_;      // inelastic runs only

    const Kernels* kernels_;
    bool glancing_ = false;  // one image: pairs are looked through at a glance
    Lens lens_{};
    double span_ = 1;           // for such a time: an epoch, longer where little happens
    double focused_until_ = 0;  // glances are too old after that
    double doubt_ = 0;          // a bound is rarely this much earlier than what it bounds
    int64_t focused_events_ = 0;
    Array<Glance> glances_;

    bool gridded_ = false;  // neighbours are found on a grid, not in lists
    Grid grid_;
    mutable Found near_;

    bool several_images_ = false;    // of a neighbour may be met
    double margin_ = 0;              // of most shells
    int widest_ = 0;                 // any shell has been doubled so often
    int most_widening_ = 0;          // so often a lonely sphere's may be
    int least_widening_ = 0;         // so often a crowded one may be: a negative number
    double common_ = 0, giant_ = 0;  // radius the cells are made for; above which one is a giant
    double cell_ = 0;                // width of the smallest cells
    bool sort_ = true;
    bool far_ = false;     // neighbours are far away in memory: they do not all fit into the cache
    bool at_hand_ = true;  // all fit into the cache next to the processor
    Rows rows_;
    Cells cells_;
    Calendar calendar_;
    Found found_;
    std::vector<int32_t> left_, joined_;  // a row that has changed
    std::vector<int32_t> outgrown_;       // rows that have become too long

    Work work_;
    Profile profile_;
    int64_t collisions_ = 0, wall_collisions_ = 0;
    Sum dissipated_, withheld_;
    double deepest_ = 0;
    double shallow2_ = 1 + 1e-15;  // no squared distance above this (in contacts) is a deeper one
    Collapse collapse_;
    bool logging_ = true;
    double slice_ = 0.05;
    std::vector<Record> log_;
};

// What is done several times for each event, and must not cost a call.

inline Engine::Motion Engine::motion(int i, double t) const {
    const Sphere& s = spheres_[size_t(i)];
    const double dt = t - s.t;
    if (!gravity_ || !falls_[size_t(i)]) return {s.x + s.v * dt, s.v};
    return {s.x + (s.v + world_.gravity * (0.5 * dt)) * dt, s.v + world_.gravity * dt};
}

// r(t) of a flight anchored at time zero.
inline Vec3 flown(const Vec3& x, const Vec3& v, const Vec3& a, double t) {
    return x + (v + a * (0.5 * t)) * t;
}

// From the later anchor on both fly freely: what is predicted depends on nothing else.
inline Relative Engine::relative(int i, int j) const {
    const Sphere &p = spheres_[size_t(i)], &q = spheres_[size_t(j)];
    const double from = p.t > q.t ? p.t : q.t, dp = from - p.t, dq = from - q.t;
    if (!gravity_) return {(p.x + p.v * dp) - (q.x + q.v * dq), p.v - q.v, {}, from};
    const Vec3 pa = acceleration(i), qa = acceleration(j);
    return {flown(p.x, p.v, pa, dp) - flown(q.x, q.v, qa, dq), (p.v + pa * dp) - (q.v + qa * dq),
            pa - qa, from};
}

inline FreeRelative Engine::free_relative(int i, int j) const {
    const Sphere &p = spheres_[size_t(i)], &q = spheres_[size_t(j)];
    const Four pv = velocity_of(p), qv = velocity_of(q);
    const double from = p.t > q.t ? p.t : q.t;
    return {(position_of(p) + pv * (from - p.t)) - (position_of(q) + qv * (from - q.t)), pv - qv,
            from};
}

inline double Engine::margin(int widening) const {
    return margin_ * std::bit_cast<double>(uint64_t(1023 + widening) << 52);  // 2^widening
}

inline Shell Engine::shell(int i) const {
    const Event& e = events_[size_t(i)];
    return {{e.shell_x, e.shell_yz[0], e.shell_yz[1]},
            spheres_[size_t(i)].r + margin(rows_.line(i).margin)};
}

// What changes of a glance: all but the radius, which `focus` gives.
inline void Engine::refresh(int i) {
    const Sphere& s = spheres_[size_t(i)];
    Four v = velocity_of(s), here = position_of(s) + v * (now_ - s.t);
    if (gravity_) {  // seen by one who falls along, all that fall fly straight on
        const Motion at = motion(i, now_);
        const double fall = now_ - lens_.start;
        const Vec3 x = at.x - world_.gravity * (0.5 * fall * fall),
                   u = at.v - world_.gravity * fall;
        here = Four(x);
        v = Four(u);
    }
    here = here.with_fourth(now_ - lens_.start);
    Glance& g = glances_[size_t(i)];
    const Four scaled = v * lens_.scale;
    const auto vx = float(scaled.x()), vy = float(scaled.y()), vz = float(scaled.z());
    const float v2 = vx * vx + vy * vy + vz * vz;
    bool clear = v2 < lens_.fastest2 && g.r > 0;
    if (v2 < 0x1p-60f) clear = clear && v.x() == 0 && v.y() == 0 && v.z() == 0;
    if (gravity_) clear = clear && falls_[size_t(i)];
    if (!gridded_) {
        const double far = std::abs(here.x()) + std::abs(here.y()) + std::abs(here.z());
        clear = clear && far < lens_.farthest && rows_.line(i).margin <= 4;
    }
    const FourInts place = steps(here, lens_.inverse);
    using FourFloats [[gnu::vector_size(16)]] = float;
    const FourFloats flight{clear ? vx : std::numeric_limits<float>::quiet_NaN(), vy, vz, g.r};
    std::memcpy(g.x, &place, sizeof place);  // at once, because it is about to be read at once
    std::memcpy(g.v, &flight, sizeof flight);
}

// The spheres in some cells of the grid, into near_.id from place `first` on.
inline int32_t Engine::collect(const GridBlock& block, size_t first) const {
    constexpr size_t kBehind = 16;  // room behind them
    for (;;) {
        const int32_t n = kernels_->collect(grid_.cells(), block, &near_.id[first],
                                            int32_t(near_.id.size() - first - kBehind));
        if (n >= 0) return n;
        near_.id.resize(2 * near_.id.size());
    }
}

template <class Visit>
void Engine::each_near(int i, const Visit& visit) const {
    if (!gridded_) {
        for (const Row& row : rows_.of(i))
            for (const int32_t j : row.ids()) visit(j);
        return;
    }
    const GridBlock block = grid_.around(Grid::unpack(events_[size_t(i)].cell));
    const int32_t n = collect(block, 0);
    for (int32_t k = 0; k < n; ++k)
        if (near_.id[size_t(k)] != i) visit(near_.id[size_t(k)]);
}

// The deepest pair nearer than sigma (1 - 1e-12), fixed pairs aside; i = kNone if there is none.
struct Overlap {
    int32_t i = kNone, j = kNone;
    double depth = 0;
};
Overlap first_overlap(const StartSpheres& spheres, const Vec3& period);

}  // namespace carom
