// Who is near whom: shells around spheres, their rows of neighbours, and the glances by which these
// are looked through.
#include <limits>
#include <span>

#include "engine.hpp"

namespace carom {

namespace {

// Neighbours. A sphere with less than kLonely tries a shell twice as wide, which may have kMost;
// one with more than kCrowded makes a narrower one when it comes to it, with more than kMob at
// once.
constexpr size_t kLonely = 4, kMost = 10, kCrowded = 30, kMob = 48;

}  // namespace

// The centre is rounded to single precision: what is stored is the centre.
void Engine::place_shell(int i, const Vec3& centre, int widening) {
    Event& e = events_[size_t(i)];
    e.shell_x = float(centre.x);
    e.shell_yz[0] = float(centre.y);
    e.shell_yz[1] = float(centre.z);
    const double far =
        std::max(std::abs(centre.x), std::max(std::abs(centre.y), std::abs(centre.z)));
    while (widening < kEndless && margin(widening) < far * 0x1p-20) ++widening;  // rounding is less
    rows_.line(i).margin = int16_t(widening);
    widest_ = std::max(widest_, widening);
}

// The sphere leaves its shell: make a new one around it.
void Engine::escape(int i) {
    if (gravity_ && falls_[size_t(i)]) {
        // Only a bound was due. Keep the shell while the sphere is well inside.
        const double room = margin(rows_.line(i).margin);
        if (cells_.distance2(motion(i, now_).x, shell(i).centre) < 0.5 * room * room)
            return predict(i);
    }
    // The rows that change come from memory while the sphere's own is looked through.
    renew_shell(i);
    profile_.lap(Profile::rebuild);
    predict(i);
    tell_neighbours(i);
    profile_.lap(Profile::rebuild);
}

bool Engine::crowded(int i) const {
    if (!shells_on_ || gridded_) return false;
    return rows_.size(i) > kCrowded && rows_.line(i).margin > least_widening(i);
}

// Where to centre a shell: ahead of the sphere, where it will be (a fourth fewer shells at packing
// fraction 0.25); in a dense fluid, where it soon turns round, at the sphere.
Vec3 Engine::ahead(const Motion& at, double r, int widening) const {
    const double speed = norm(at.v);
    if (speed == 0 || margin_ <= 0.5 * r) return at.x;
    return at.x + at.v * (0.6 * margin(widening) / speed);
}

// A shell around where the sphere is now, and with it its row of neighbours. A sphere that flies
// alone gets a wider shell each time, so that an expanding cloud costs ever less. Into such a shell
// others may fly, thousands of them, and each would look at its sphere ever after: it is remade.
void Engine::make_shell(int i) {
    renew_shell(i);
    tell_neighbours(i);
}

void Engine::renew_shell(int i) {
    ++work_.shells;
    const auto shell_of = [this](int32_t j) { return shell(j); };
    const int widening = rows_.line(i).margin;
    const size_t neighbours = rows_.size(i);
    int wish = widening;
    if (neighbours > kCrowded && widening > least_widening(i))
        --wish;
    else if (neighbours < kLonely && widening < most_widening_)
        ++wish;

    cells_.remove(i, shell(i), shell_of);
    const Motion at = motion(i, now_);
    for (;;) {
        place_shell(i, ahead(at, spheres_[size_t(i)].r, wish), wish);
        cells_.search(shell(i), shell_of, found_);
        if (wish > widening && found_.n > kMost) {
            wish = widening;
        } else if (wish < widening && found_.n > kCrowded && wish > least_widening(i) &&
                   rows_.line(i).margin == wish) {
            --wish;
        } else {
            break;
        }
    }
    cells_.add(i, shell(i), shell_of);
    exchange(i);
}

// The row becomes what was found. Rows are symmetric: who joins or leaves this row gains or loses i
// in its own, see tell_neighbours.
void Engine::exchange(int i) {
    const std::span<const int32_t> now = found_.ids();
    const Row& old = rows_.line(i);
    left_.clear();
    joined_.clear();
    if (old.n >= 0 && now.size() <= Row::kPlaces) {
        Difference d = kernels_->difference(reinterpret_cast<const int32_t*>(&old), old.n,
                                            now.data(), int(now.size()));
        for (; d.gone != 0; d.gone &= d.gone - 1) left_.push_back(old.id[std::countr_zero(d.gone)]);
        for (; d.fresh != 0; d.fresh &= d.fresh - 1)
            joined_.push_back(now[size_t(std::countr_zero(d.fresh))]);
        for (const int32_t j : left_) fetch(&rows_.line(j));
        for (const int32_t j : joined_) fetch(&rows_.line(j));
    } else {
        std::vector<int32_t> before, after(now.begin(), now.end());
        for (const Row& row : rows_.of(i)) before.insert(before.end(), row.id, row.id + row.n);
        std::sort(before.begin(), before.end());
        std::sort(after.begin(), after.end());
        std::ranges::set_difference(before, after, std::back_inserter(left_));
        std::ranges::set_difference(after, before, std::back_inserter(joined_));
    }
    rows_.assign(i, now);
}

void Engine::tell_neighbours(int i) {
    for (const int32_t j : left_) rows_.remove(j, i);
    for (const int32_t j : joined_) {
        rows_.add(j, i);
        if (rows_.line(j).n < 0 && rows_.size(j) > kMob) outgrown_.push_back(j);
    }
    while (!outgrown_.empty()) {
        const int32_t j = outgrown_.back();
        outgrown_.pop_back();
        if (j == i || rows_.size(j) <= kMob || !crowded(j)) continue;
        renew_shell(j);
        tell_neighbours(j);
        predict(j);
    }
}

// An epoch in which little happens may go on for ever. What is done for all spheres, and what suits
// the times that were usual once, is then done anew after ever longer times.
void Engine::look_again() {
    if (epoch_events_ - focused_events_ < int64_t(size()) / 4) span_ = std::min(2 * span_, 0x1p900);
    focused_events_ = epoch_events_;
    focus();
    calendar_.reset(pending(), now_);
}

// Chooses the units of glances for this epoch, and looks at every sphere anew.
//
// A distance between neighbours is at most a few cells, so single precision errs by about 2^-22 of
// a cell; the steps of positions and times err by less, except for a sphere too fast, too large,
// too small or in too wide a shell: those are marked to be solved exactly.
void Engine::focus() {
    focused_until_ = now_ + 1.5 * span_;
    if (!glancing_) return;
    glances_.resize(size());
    const bool asked = tuning_.ahead >= 0;
    far_ = asked ? tuning_.ahead == 1 : size() > (gridded_ ? kGridInCache : kListsInCache);
    at_hand_ = !asked && size() <= (gridded_ ? kGridAtHand : kListsAtHand);
    const double epoch = span_;
    double energy = 0;
    for (const Sphere& s : spheres_) energy += norm2(s.v);
    const double speed = std::sqrt(energy / double(size()));
    const double length = Clock::power_of_two_above(cell_);
    lens_.time = speed > 0 ? std::min(Clock::power_of_two_above(cell_ / speed), epoch) : epoch;
    // An open axis has a period of 4096 cells: no two neighbours that are not marked are further
    // apart than 300.
    const Vec3& p = world_.period;
    const double open = 0x1p12 * cell_;
    const double period[3] = {p.x > 0 ? p.x : open, p.y > 0 ? p.y : open, p.z > 0 ? p.z : open};
    lens_.inverse = Four{1 / period[0], 1 / period[1], 1 / period[2], 0x1p-2 / epoch};
    double widest = 0;
    for (int a = 0; a < 3; ++a) {
        const double unit = period[a] * 0x1p-32 / length;
        lens_.unit[a] = float(unit);
        widest = std::max(widest, unit);
    }
    lens_.tick = float(0x1p-30 * epoch / lens_.time);
    lens_.blur = float((gravity_ ? 0x1p-13 : 0x1p-15) * cell_ / length + 16 * widest);
    lens_.still = lens_.blur * lens_.blur;
    float fastest = lens_.blur / (16 * lens_.tick);
    if (gravity_) {
        // So long at most a sphere that goes up and comes down stays in its shell, and what is
        // rounded off its velocity must not become a distance.
        const double stays = 2 * std::sqrt(32 * cell_ / norm(world_.gravity)) / lens_.time;
        fastest = std::min(fastest, float(0x1p21 * lens_.blur / stays));
    }
    lens_.fastest2 = fastest * fastest;
    lens_.farthest = 0x1p30 * cell_;
    lens_.scale = lens_.time / length;
    lens_.start = now_;
    for (size_t i = 0; i < size(); ++i) {
        const double r = spheres_[i].r;
        const bool clear = r < 128 * cell_ && r > cell_ / 1024;
        glances_[i].r = clear ? float(r / length) : std::numeric_limits<float>::quiet_NaN();
        refresh(int(i));
    }
}

}  // namespace carom
