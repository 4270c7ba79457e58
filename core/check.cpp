// Do the engine's structures agree with one another? Slow, for tests.
#include <stdexcept>

#include "arithmetic.hpp"
#include "engine.hpp"

namespace carom {

namespace {

void demand(bool ok, const char* what) {
    if (!ok) throw std::logic_error(what);
}

}  // namespace

void Engine::check() const {
    const PlainArithmetic plain;
    for (size_t i = 0; i < size(); ++i) {
        const Event& e = events_[i];
        demand(e.t >= now_ || e.partner == kNone, "an event lies in the past");
        demand(spheres_[i].t <= now_, "an anchor lies in the future");
        if (!shells_on_) continue;
        gridded_ ? check_cell(int(i)) : check_shell(int(i));
        each_near(int(i), [&](int32_t j) {
            Next next;
            consider(int(i), j, next);
            demand(next.t >= std::min(e.t, events_[size_t(j)].t), "a collision is missed");
        });
    }
}

void Engine::check_cell(int i) const {
    const Grid::Cell cell = Grid::unpack(events_[size_t(i)].cell);
    demand(grid_.has(i, cell), "a sphere is not in its cell");
    demand(grid_.holds(motion(i, now_).x, cell), "a sphere has left its cell unseen");
}

void Engine::check_shell(int i) const {
    const Event& e = events_[size_t(i)];
    const int widening = rows_.line(i).margin;
    const double room = margin(widening);
    const Shell own = shell(i);
    demand(e.t <= now_ || widening >= kEndless ||  // about to be remade, or never
               cells_.distance2(motion(i, now_).x, own.centre) <= room * room * (1 + 1e-9),
           "a sphere has left its shell unseen");
    const auto known = [this](int k, int32_t j) {
        int64_t times = 0;
        for (const Row& row : rows_.of(k)) times += std::count(row.id, row.id + row.n, j);
        return times;
    };
    Found found;
    cells_.search(own, [this](int32_t j) { return shell(j); }, found);
    for (const int32_t j : found.ids()) {
        const Shell other = shell(j);
        const double near = own.reach + other.reach;
        if (j == i || !(cells_.distance2(own.centre, other.centre) < near * near)) continue;
        demand(known(i, j) == 1, "a row misses a neighbour");
    }
    for (const Row& row : rows_.of(i))
        for (const int32_t j : row.ids()) demand(known(j, i) == 1, "rows are not symmetric");
}

}  // namespace carom
