// Asking memory in time: when a bucket of events is taken in hand, for what the events of the next
// buckets will touch, each stage for a bucket nearer. Lists at 108 000 spheres: 1.7 to 2.1 times
// faster; at a few thousand 0.85. Each line forgotten costs much: a gas of a million got 1.13 times
// faster by the last three (both cells of a crossing, and the crosser's glance).
#include "engine.hpp"

namespace carom {

void Engine::look_ahead() const {
    const auto each_due = [this](int later, const auto& ask) {
        calendar_.each(later, [&](int32_t i) {
            const Event& e = events_[size_t(i)];
            if (calendar_.due_in(later, e.t)) ask(i, e);
        });
    };
    if (gridded_) {
        fetch(calendar_.line(5));
        calendar_.each(4, [this](int32_t i) {
            fetch(&events_[size_t(i)]);
            fetch(&spheres_[size_t(i)]);
        });
        each_due(3, [this](int32_t i, const Event& e) { ask_for_cells(i, e); });
        each_due(2, [this](int32_t i, const Event& e) { ask_for_partners_cells(i, e); });
        each_due(1, [this](int32_t i, const Event& e) { ask_for_cell_neighbours(i, e); });
    } else {
        fetch(calendar_.line(4));
        calendar_.each(3, [this](int32_t i) { fetch(&events_[size_t(i)]); });
        each_due(2, [this](int32_t i, const Event& e) { ask_for_rows(i, e); });
        each_due(1, [this](int32_t i, const Event& e) { ask_for_row_neighbours(i, e); });
    }
}

// Where all is in some cache, but not in the first: what the two of each event in hand will need of
// their own. Lists at 8 000, 16 000 and 28 000 spheres: 1.02, 1.04 and 1.11 times faster.
void Engine::bring_near() const {
    const auto own = [this](int32_t k) {
        fetch_near(&spheres_[size_t(k)]);
        fetch_near(&bodies_[size_t(k)]);
        if (gridded_) return;
        fetch_near(&rows_.line(k));
        fetch_near(&rows_.line(k).id[Row::kPlaces / 2]);
    };
    calendar_.each(1, [this](int32_t i) { fetch_near(&events_[size_t(i)]); });
    calendar_.each(0, [&](int32_t i) {
        own(i);
        const int32_t j = events_[size_t(i)].partner;
        if (j < 0) return;
        own(j);
        fetch_near(&events_[size_t(j)]);
    });
}

void Engine::ask_for_rows(int i, const Event& e) const {
    fetch(&spheres_[size_t(i)]);
    fetch(&rows_.line(i));
    const int32_t j = sphere_met(e.partner);
    if (j < 0) return;
    fetch(&rows_.line(j));
    ask_for_pair(i, j);
}

void Engine::ask_for_pair(int i, int32_t j) const {
    fetch(&bodies_[size_t(i)]);
    fetch(&events_[size_t(j)]);
    fetch(&spheres_[size_t(j)]);
    fetch(&bodies_[size_t(j)]);
    if (!logging_) return;
    fetch(&labels_[size_t(i)]);
    fetch(&labels_[size_t(j)]);
}

void Engine::ask_for_row_neighbours(int i, const Event& e) const {
    const auto neighbours = [this](int32_t k) {
        const Row& row = rows_.line(k);
        for (int q = 0; q < row.n; ++q) fetch(&glances_[size_t(row.id[q])]);
    };
    neighbours(i);
    if (e.partner == kEscape) cells_.fetch_around(ahead(motion(i, e.t), spheres_[size_t(i)].r, 0));
    const int32_t j = sphere_met(e.partner);
    if (j >= 0) neighbours(j);
}

// The cells that come into sight if i crosses into the next one at e.t.
GridBlock Engine::new_cells(int i, const Event& e) const {
    const int axis = Grid::axis(e.cell);
    const bool up = Grid::upwards(spheres_[size_t(i)].v, axis);
    return grid_.face(grid_.next(Grid::unpack(e.cell), axis, up), axis, up);
}

void Engine::ask_for_cells(int i, const Event& e) const {
    const Grid::Cell own = Grid::unpack(e.cell);
    if (next_partner(e) == kEscape) {
        const int axis = Grid::axis(e.cell);
        grid_.fetch_cell(own);
        grid_.fetch_cell(grid_.next(own, axis, Grid::upwards(spheres_[size_t(i)].v, axis)));
        grid_.fetch_block(new_cells(i, e));
        if (e.partner >= 0) fetch(&events_[size_t(e.partner)]);
        return;
    }
    grid_.fetch_block(grid_.around(own));
    if (const int32_t j = sphere_met(e.partner); j >= 0) ask_for_pair(i, j);
}

// The cells that i and j look through if they meet; see look_around_both.
GridBlock Engine::cells_of_both(int i, int32_t j) const {
    GridBlock both;
    const Grid::Cell p = Grid::unpack(events_[size_t(i)].cell),
                     q = Grid::unpack(events_[size_t(j)].cell);
    return grid_.around_both(p, q, both) ? both : grid_.around(q);
}

void Engine::ask_for_partners_cells(int i, const Event& e) const {
    const int32_t j = sphere_met(e.partner);
    if (j < 0 || next_partner(e) == kEscape) return;
    grid_.fetch_block(cells_of_both(i, j));
}

void Engine::ask_for_cell_neighbours(int i, const Event& e) const {
    const auto glances = [this](const GridBlock& block) {
        const int32_t n = collect(block, 0);
        for (int32_t k = 0; k < n; ++k) fetch(&glances_[size_t(near_.id[size_t(k)])]);
    };
    if (next_partner(e) == kEscape) {
        fetch(&glances_[size_t(i)]);  // it is in none of the new cells
        return glances(new_cells(i, e));
    }
    const int32_t j = sphere_met(e.partner);
    glances(j >= 0 ? cells_of_both(i, j) : grid_.around(Grid::unpack(e.cell)));
}

}  // namespace carom
