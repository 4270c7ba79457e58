// What the tests see of an engine's inside.
#pragma once

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "../engine.hpp"
#include "check.hpp"

namespace carom {

struct EngineProbe {
    static bool glancing(const Engine& e) { return e.glancing_; }
    static bool gridded(const Engine& e) { return e.gridded_; }
    static double epoch(const Engine& e) { return e.clock_.epoch; }
    static double margin(const Engine& e, int widening) { return e.margin(widening); }
    static int most_widening(const Engine& e) { return e.most_widening_; }
    static double width(const Engine& e) { return e.cell_; }

    // Looks at sphere i at that moment.
    static void refresh(Engine& e, int i, double now) {
        e.now_ = now;
        e.refresh(i);
    }
    // Puts sphere i into a shell so wide, as if it had been lonely; or into the cell it is in.
    static void place(Engine& e, int i, double now, int widening) {
        const Engine::Motion at = e.motion(i, now);
        if (e.gridded_)
            e.events_[size_t(i)].cell = Grid::pack(e.grid_.cell_of(wrapped(e, at.x)), 0);
        else
            e.place_shell(i, e.ahead(at, e.spheres_[size_t(i)].r, widening), widening);
    }
    // Until when it stays there.
    static double leaves(Engine& e, int i, double now) {
        const Engine::Motion at = e.motion(i, now);
        if (e.gridded_) {
            const Grid::Cell cell = Grid::unpack(e.events_[size_t(i)].cell);
            const Four x(at.x), v(at.v);
            return now + e.grid_.crossing(e.grid_.from_middle(x, cell), v, cell).wait;
        }
        e.now_ = now;
        return e.escape_time(i);
    }
    static bool neighbours(const Engine& e, int i, int j) {
        if (e.gridded_) {
            const Grid::Cell p = Grid::unpack(e.events_[size_t(i)].cell),
                             q = Grid::unpack(e.events_[size_t(j)].cell);
            bool near = true;
            for (int a = 0; a < 3; ++a) {
                const auto next = [&](bool up) { return e.grid_.next(p, a, up).c[a]; };
                near = near && (q.c[a] == p.c[a] || q.c[a] == next(true) || q.c[a] == next(false));
            }
            return near;
        }
        const double near = e.shell(i).reach + e.shell(j).reach;
        return e.cells_.distance2(e.shell(i).centre, e.shell(j).centre) < near * near;
    }
    static void focus(Engine& e, double now) {
        e.now_ = now;
        e.focus();
    }

    static double exact(const Engine& e, int i, int32_t j) {
        Engine::Next next;
        e.consider(i, j, next);
        return next.t;
    }

    // Until when a prediction of sphere i must hold; it is made anew then.
    static double horizon(const Engine& e, int i) {
        if (!e.gridded_) return e.escape_time(i);
        const double v = norm(e.spheres_[size_t(i)].v);
        return v > 0 ? e.now_ + 64 * e.cell_ / v : kNever;
    }

    // The bounds that a glance at these neighbours gives, against their exact times, with every
    // instruction set. Returns how many of the neighbours are met in time.
    static int compare(Engine& e, int i, const std::vector<int32_t>& near) {
        int met = 0;
        e.refresh(i);
        const double until = horizon(e, i);
        int32_t row[Row::kPlaces + 1];
        for (int32_t& id : row) id = i;
        for (size_t k = 0; k < near.size(); ++k) row[k + 1] = near[k];
        for (const std::string& level : simd_levels()) {
            const Guess g = kernels(level).first_met(
                e.lens_, e.glances_.data(), e.glances_[size_t(i)], i, row, int(near.size()));
            CHECK(g.slot >= 0 && g.slot <= int(near.size()));
            CHECK(g.first >= 0 && g.first <= g.second);
            check_two(e, level, i, row, int(near.size()));
            const double first = e.now_ + g.first * e.lens_.time,
                         second = e.now_ + g.second * e.lens_.time;
            for (int k = 1; k <= int(near.size()); ++k) {
                const double t = exact(e, i, row[k]);
                // A test may look at a moment at which the pair would have met before.
                if (t == kNever || t > until || t < e.now_) continue;
                ++met;
                const bool earlier = (k == g.slot ? first : second) <= t;
                CHECK(earlier);
                if (!earlier && ++told < 20) tell(e, i, row[k], t, k == g.slot ? first : second);
            }
        }
        return met;
    }

    // Two who look through a row together see what each sees alone.
    static void check_two(Engine& e, const std::string& level, int i, const int32_t* row, int n) {
        const int other = n > 0 ? row[1] : i;
        e.refresh(other);
        const Glance* const me[2] = {&e.glances_[size_t(i)], &e.glances_[size_t(other)]};
        const Kernels& k = kernels(level);
        Guess both[2];
        k.first_met_by_two(e.lens_, e.glances_.data(), me, row, n, both);
        const int self[2] = {i, other};
        for (const int one : {0, 1}) {
            const Guess alone =
                k.first_met(e.lens_, e.glances_.data(), *me[one], self[one], row, n);
            CHECK(both[one].slot == alone.slot);
            CHECK(both[one].first == alone.first && both[one].second == alone.second);
        }
    }

    // All spheres of a running engine with the neighbours that they have.
    static int compare_all(Engine& e) {
        if (!e.glancing_) return 0;
        int met = 0;
        for (int i = 0; i < int(e.size()); ++i) {
            std::vector<int32_t> near;
            e.each_near(i, [&](int32_t j) { near.push_back(j); });
            for (size_t k = 0; k < near.size(); k += Row::kPlaces) {
                const size_t end = std::min(near.size(), k + Row::kPlaces);
                met += compare(
                    e, i, {near.begin() + std::ptrdiff_t(k), near.begin() + std::ptrdiff_t(end)});
            }
        }
        return met;
    }

private:
    static Vec3 wrapped(const Engine& e, const Vec3& x) {
        return x - e.whole_boxes(x) * e.world_.period;
    }
    static inline int told = 0;
    static void tell(const Engine& e, int i, int j, double exact, double bound) {
        const Relative rel = e.relative(i, j);
        const Sphere &p = e.spheres_[size_t(i)], &q = e.spheres_[size_t(j)];
        Vec3 r = rel.r + rel.v * (e.now_ - rel.from);
        r -= nearest(r * e.inverse_period_) * e.world_.period;
        std::printf(
            "  now %.17g exact +%.9g bound +%.9g distance %.9g (contact %.9g) speed %.9g, "
            "own %.9g %.9g, cell %.9g, b %.9g, margin %.9g widening %d %d\n",
            e.now_, exact - e.now_, bound - e.now_, norm(r), p.r + q.r, norm(rel.v), norm(p.v),
            norm(q.v), e.cell_, dot(r, rel.v), e.margin_, e.gridded_ ? 0 : e.rows_.line(i).margin,
            e.gridded_ ? 0 : e.rows_.line(j).margin);
    }
};

}  // namespace carom
