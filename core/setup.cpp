// Building: shells and cells from the density, epochs from the speeds.

#include "arithmetic.hpp"
#include "engine.hpp"

namespace carom {

namespace {

constexpr double kSpherical = 4.18879020478639098;  // 4 pi / 3
// Packing fraction up to which a grid is faster: where lists fit into the caches, where only a grid
// does, and where neither does.
constexpr double kDilute = 0.37, kDiluteAndLarge = 0.3, kDiluteAndFar = 0.18;
constexpr double kPerCell = 0.8;           // spheres in a cell of it
constexpr size_t kMany = size_t(1) << 22;  // so many take too much memory in lists

double median_radius(const Array<Sphere>& spheres) {
    const double first = spheres.front().r;
    if (std::ranges::all_of(spheres, [&](const Sphere& s) { return s.r == first; })) return first;
    std::vector<double> r;
    r.reserve(spheres.size());
    for (const Sphere& s : spheres) r.push_back(s.r);
    const auto middle = r.begin() + std::ptrdiff_t(r.size() / 2);
    std::nth_element(r.begin(), middle, r.end());
    return *middle;
}

// Extent of the spheres along each axis, or the period where there is one.
Vec3 extent(const Array<Sphere>& spheres, const Vec3& period) {
    Vec3 lo{kNever, kNever, kNever}, hi{-kNever, -kNever, -kNever};
    for (const Sphere& s : spheres) {
        lo = {std::min(lo.x, s.x.x - s.r), std::min(lo.y, s.x.y - s.r),
              std::min(lo.z, s.x.z - s.r)};
        hi = {std::max(hi.x, s.x.x + s.r), std::max(hi.y, s.x.y + s.r),
              std::max(hi.z, s.x.z + s.r)};
    }
    const Vec3 d = hi - lo;
    return {period.x > 0 ? period.x : d.x, period.y > 0 ? period.y : d.y,
            period.z > 0 ? period.z : d.z};
}

}  // namespace

// The margin gives a sphere about thirteen neighbours, which is near the fastest at every density
// tried: fewer and shells are remade too often, more and every prediction looks at too many. In
// open space, where spheres part, less: a cloud has more shells to make than events.
void Engine::choose_shells(const Tuning& tuning) {
    Vec3 middle, sides;
    const double neighbours = room(middle, sides) ? 13 : 11;
    if (!shells_on_) return;
    gridded_ = glancing_ = choose_grid(tuning);
    plain_ = gridded_ && world_.restitution == 1 && last_touch_.empty();
    if (gridded_) return;
    const double r = median_radius(spheres_);
    double largest = 0, giants = 0;
    const Vec3 box = extent(spheres_, world_.period);
    const double volume = box.x * box.y * box.z;
    for (const Sphere& s : spheres_) {
        largest = std::max(largest, s.r);
        if (s.r > 2 * r) giants += kSpherical * s.r * s.r * s.r;
    }
    const double free = std::max(volume - giants, 0.1 * volume);
    const double shell = std::cbrt(neighbours * free / (kSpherical * double(size())));
    margin_ = std::clamp(0.5 * shell - r, 0.1 * r, 16 * r);
    if (tuning.margin > 0) margin_ = tuning.margin;
    double most = kNever;
    if (periodic_) {
        // One image of a neighbour is enough while no other can come within reach.
        const double single = 0.249 * (half_period_ - 2 * r);
        if (single >= 0.1 * r) margin_ = std::min(margin_, single);
        margin_ = std::min(margin_, 0.25 * half_period_);
        most = std::max(margin_, 0.249 * (half_period_ - 2 * largest));
        several_images_ = 2 * largest + 4 * most >= half_period_;
    }
    most_widening_ = 0;
    while (most_widening_ < kEndless && 2 * margin(most_widening_) <= most) ++most_widening_;
    // All on one level if the sizes allow.
    common_ = largest <= 2 * r ? largest : r;
    cell_ = tuning.cell > 0 ? tuning.cell : 2 * (common_ + margin_) * (1 + 1e-9);
    giant_ = 2 * r;
    least_widening_ = 0;
    while (margin(least_widening_ - 1) >= 0.1 * r) --least_widening_;
    glancing_ = !several_images_;
    plain_ = glancing_ && !gravity_ && world_.restitution == 1 && last_touch_.empty();
    if (several_images_) images_.resize(size());
}

// An epoch lasts some dozens of collisions of a sphere. Its exact length does not matter; that it
// follows from the start state alone does.
void Engine::choose_epoch(double time) {
    double energy = 0, section = 0;
    for (const Sphere& s : spheres_) {
        energy += norm2(s.v);
        section += s.r * s.r;
    }
    const double n = double(size());
    const Vec3 box = extent(spheres_, world_.period);
    const double across = norm(box);
    double path = box.x * box.y * box.z / (17.7715 * section);  // 1 / (sqrt2 pi n sigma^2)
    path = std::clamp(path, 0.01 * std::sqrt(section / n), across);
    double speed = std::sqrt(energy / n);
    speed = std::max(speed, std::sqrt(norm(world_.gravity) * across));
    clock_.start(time, speed > 0 && path / speed < 1e100 ? 32 * path / speed : 1.0);
}

// A sphere said to rest: on the plane across gravity that it is nearest to.
void Engine::settle(int i) {
    double nearest_gap = kNever;
    const Sphere& s = spheres_[size_t(i)];
    for (size_t k = 0; k < world_.walls.size(); ++k) {
        const Wall& w = world_.walls[k];
        if (w.kind != WallKind::plane || dot(w.normal, world_.gravity) >= 0) continue;
        if (norm(cross(world_.gravity, w.normal)) > 1e-12 * norm(world_.gravity)) continue;
        const double gap = std::abs(dot(w.normal, s.x) - w.offset - s.r);
        if (gap > 1e-6 * s.r || gap >= nearest_gap) continue;
        nearest_gap = gap;
        bodies_[size_t(i)].rests_on = int16_t(k);
        falls_[size_t(i)] = 0;
    }
}

// The room in which the spheres are for certain: false if an axis has neither period nor walls.
bool Engine::room(Vec3& centre, Vec3& size) const {
    const Vec3& p = world_.period;
    const double period[3] = {p.x, p.y, p.z};
    double lo[3], hi[3];
    for (int a = 0; a < 3; ++a) {
        lo[a] = period[a] > 0 ? -0.5 * period[a] : -kNever;
        hi[a] = period[a] > 0 ? 0.5 * period[a] : kNever;
        for (const Wall& w : world_.walls) {
            const double n[3] = {w.normal.x, w.normal.y, w.normal.z};
            if (w.kind == WallKind::plane) {
                if (n[a] == 1) lo[a] = std::max(lo[a], w.offset);
                if (n[a] == -1) hi[a] = std::min(hi[a], -w.offset);
            } else if (w.kind == WallKind::sphere || a < 2) {
                lo[a] = std::max(lo[a], -w.offset);
                hi[a] = std::min(hi[a], w.offset);
            }
        }
        if (!(hi[a] - lo[a] < kNever)) return false;
    }
    centre = {0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1]), 0.5 * (lo[2] + hi[2])};
    size = {hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]};
    return true;
}

// A grid instead of lists, where spheres are alike and in a room.
bool Engine::choose_grid(const Tuning& tuning) {
    if (!shells_on_ || gravity_ || tuning.grid == 0) return false;
    double largest = 0, section = 0;
    for (const Sphere& s : spheres_) {
        largest = std::max(largest, s.r);
        section += s.r * s.r * s.r;
    }
    Vec3 centre, size;
    if (!room(centre, size)) return false;
    double volume = size.x * size.y * size.z;
    for (const Wall& w : world_.walls) {
        const double r2 = w.offset * w.offset;
        if (w.kind == WallKind::sphere) volume = std::min(volume, kSpherical * r2 * w.offset);
        if (w.kind == WallKind::cylinder)
            volume = std::min(volume, 0.75 * kSpherical * r2 * size.z);
    }
    const double packing = kSpherical * section / volume;
    const double dilute = spheres_.size() > kGridInCache    ? kDiluteAndFar
                          : spheres_.size() > kListsInCache ? kDiluteAndLarge
                                                            : kDilute;
    if (tuning.grid < 0 && packing > dilute && spheres_.size() < kMany) return false;
    if (largest > 2 * median_radius(spheres_)) return false;
    const double width =
        std::max(2 * largest * (1 + 1e-6), std::cbrt(kPerCell * volume / double(spheres_.size())));
    const Vec3& p = world_.period;
    const bool periodic[3] = {p.x > 0, p.y > 0, p.z > 0};
    if (!grid_.reset(tuning.cell > 0 ? std::max(width, tuning.cell) : width, centre, size, periodic,
                     spheres_.size()))
        return false;
    cell_ = width;
    common_ = largest;
    return true;
}

// False if many share few cells: the mean density says nothing of a cluster in a large box.
bool Engine::build_grid() {
    grid_.clear();
    for (size_t i = 0; i < size(); ++i) {
        if (grid_.links() > 64 + size() / 16) return false;
        const Vec3 x = motion(int(i), now_).x;  // may have left the box it is anchored in
        const Grid::Cell cell = grid_.cell_of(x - whole_boxes(x) * world_.period);
        grid_.add(int32_t(i), cell);
        events_[i].cell = Grid::pack(cell, 0);
    }
    return true;
}

void Engine::build_shells() {
    if (!shells_on_) return;
    if (gridded_) {
        if (build_grid()) return;
        Tuning lists = tuning_;
        lists.grid = 0;
        choose_shells(lists);
    }
    while (!build_shells_once()) {
        margin_ *= 0.5;
        ++least_widening_;
        cell_ = 2 * (common_ + margin_) * (1 + 1e-9);
    }
}

// False if the spheres stand too close together for shells this wide: the mean density says
// nothing of a dense cluster with one sphere far away.
bool Engine::build_shells_once() {
    const size_t n = size();
    rows_.reset(n);
    Vec3 centre, size{kNever, kNever, kNever};
    if (!room(centre, size)) size = {kNever, kNever, kNever};
    cells_.reset(cell_, world_.period, extent(spheres_, world_.period), size, n, *kernels_);
    const auto shell_of = [this](int32_t j) { return shell(j); };
    widest_ = 0;
    size_t pairs = 0;
    for (size_t i = 0; i < n; ++i) {
        place_shell(int(i), motion(int(i), now_).x, 0);
        const Shell s = shell(int(i));
        cells_.search(s, shell_of, found_);
        cells_.add(int(i), s, shell_of);
        pairs += found_.n;
        // 24 neighbours each, and one more pair for a lone giant, which may have all: no crowd.
        if (i >= 256 && pairs > 13 * i && least_widening_ < 0) return false;
        for (const int32_t j : found_.ids()) {
            rows_.add(int(i), j);
            rows_.add(j, int32_t(i));
        }
    }
    return true;
}

void Engine::predict_all() {
    span_ = clock_.epoch;
    focused_events_ = epoch_events_;
    focus();
    doubt_ = 0x1p-10 * lens_.time;  // not changed while any guess is left
    for (size_t i = 0; i < size(); ++i) find_event(int(i));
    calendar_.reset(pending(), now_);
}

// Flies every sphere to the start of the epoch in which offset t falls, anchors it there and
// predicts everything anew. This is the one change of stored state that is not a collision; it
// happens when a physical event beyond the epoch is due, or one too many within it, so nobody's
// bookkeeping moves it.
void Engine::begin_epoch(double t) {
    // A gas that cools or heats, or two balls in a squeeze, keep their collisions per epoch: the
    // precision of a time is that of the epoch's length.
    if (busy_epoch()) clock_.epoch *= 0.5;
    const double step = clock_.advance(t);
    for (size_t i = 0; i < size(); ++i) {
        Sphere& s = spheres_[i];
        if (s.t > step) {  // anchored at the late event of an otherwise silent epoch
            s.t -= step;
            continue;
        }
        const Motion at = motion(int(i), step);
        s.x = at.x;
        s.v = at.v;
        s.t = 0;
        wrap(int32_t(i));
        fresh_[i] = 0;
    }
    for (double& touch : last_touch_) touch -= step;
    for (Watch& w : watches_) w.start -= step;
    user_ -= step;
    happened_ -= step;
    asked_ = kNever;
    now_ = std::max(0.0, now_ - step);
    if (epoch_events_ < 4 * int64_t(size())) clock_.epoch *= 2;
    epoch_events_ = 0;
    if (sort_in_memory()) build_shells();
    predict_all();
}

Overlap first_overlap(const StartSpheres& spheres, const Vec3& period) {
    const PlainArithmetic plain;
    Overlap worst;
    const size_t n = spheres.size();
    if (n == 0) return worst;
    Array<Sphere> packed;
    packed.reserve(n);
    for (size_t i = 0; i < n; ++i)
        packed.push_back({spheres[i].position, 0, {}, spheres[i].radius});
    const Vec3 inverse{period.x > 0 ? 1 / period.x : 0, period.y > 0 ? 1 / period.y : 0,
                       period.z > 0 ? 1 / period.z : 0};
    Cells cells;
    const Vec3 size = extent(packed, period);
    cells.reset(2 * median_radius(packed) * (1 + 1e-9), period, size, size, n, kernels());
    Found found;
    const auto shell = [&](int32_t i) { return Shell{packed[size_t(i)].x, packed[size_t(i)].r}; };
    for (size_t i = 0; i < n; ++i) {
        cells.search(shell(int32_t(i)), shell, found);
        cells.add(int(i), shell(int32_t(i)), shell);
        for (const int32_t j : found.ids()) {
            if (spheres[i].fixed && spheres[size_t(j)].fixed) continue;
            const Vec3 d = packed[i].x - packed[size_t(j)].x;
            const double r = norm(d - nearest(d * inverse) * period);
            const double sigma = packed[i].r + packed[size_t(j)].r;
            if (r < sigma * (1 - 1e-12) && sigma - r > worst.depth)
                worst = {j, int32_t(i), sigma - r};
        }
    }
    return worst;
}

}  // namespace carom
