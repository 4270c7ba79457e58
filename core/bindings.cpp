// The engine's part of the Python module carom._core; raster_bindings.cpp has the pictures'.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "arithmetic.hpp"
#include "engine.hpp"
#include "helfand.hpp"

namespace nb = nanobind;
using carom::Engine;
using carom::Helfand;
using carom::Vec3;

namespace {

using Vectors = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Numbers = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Flags = nb::ndarray<const bool, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Images = nb::ndarray<const int32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Counts = nb::ndarray<const uint32_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Bytes = nb::ndarray<const uint8_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Three = nb::ndarray<const double, nb::shape<3>, nb::c_contig, nb::device::cpu>;
using WallRows = nb::ndarray<const double, nb::shape<-1, 7>, nb::c_contig, nb::device::cpu>;

Vec3 three(const Three& a) { return {a(0), a(1), a(2)}; }
Vec3 row(const Vectors& a, size_t i) { return {a(i, 0), a(i, 1), a(i, 2)}; }

// Room for numbers that will all be written: clearing it first would cost as much again.
template <class T>
std::unique_ptr<T[]> room_for(size_t count) {
    return std::make_unique_for_overwrite<T[]>(count);
}

// Hands numbers over to NumPy without a copy.
template <class T, class... Shape>
auto array_of(std::unique_ptr<T[]>&& data, Shape... shape) {
    T* held = data.release();
    nb::capsule owner(held, [](void* p) noexcept { delete[] static_cast<T*>(p); });
    return nb::ndarray<nb::numpy, T>(held, {size_t(shape)...}, owner);
}

// One row per wall: kind, bounce-back, normal (3), offset, restitution.
std::vector<carom::Wall> walls_from(const WallRows& rows) {
    std::vector<carom::Wall> walls;
    for (size_t k = 0; k < rows.shape(0); ++k)
        walls.push_back({carom::WallKind(int(rows(k, 0))), rows(k, 1) != 0,
                         Vec3{rows(k, 2), rows(k, 3), rows(k, 4)}, rows(k, 5), rows(k, 6)});
    return walls;
}

auto make_engine(const Vectors& position, const Vectors& velocity, const Numbers& mass,
                 const Numbers& radius, const Flags& fixed, const Flags& resting,
                 const Images& image, const Counts& count, double time, const Three& period,
                 const WallRows& walls, double restitution, double contact_time,
                 const Three& gravity, bool collide, double margin, double cell, bool log,
                 double slice, const std::string& simd, bool sort, int grid, int ahead,
                 bool profile) {
    const size_t n = position.shape(0);
    if (velocity.shape(0) != n || mass.shape(0) != n || radius.shape(0) != n ||
        fixed.shape(0) != n || resting.shape(0) != n || image.shape(0) != n ||
        count.shape(0) != n || n == 0)
        throw nb::value_error("arrays of different lengths, or no sphere");
    const carom::StartSpheres start(n, [&](size_t i) {
        return carom::StartSphere{row(position, i),
                                  row(velocity, i),
                                  radius(i),
                                  mass(i),
                                  fixed(i),
                                  resting(i),
                                  {image(i, 0), image(i, 1), image(i, 2)},
                                  count(i)};
    });
    const carom::World world{three(period), walls_from(walls), restitution,
                             contact_time,  three(gravity),    collide};
    const nb::gil_scoped_release release;
    return std::make_unique<Engine>(
        start, time, world,
        carom::Tuning{margin, cell, log, slice, simd, sort, profile, grid, ahead});
}

auto state_of(const Engine& engine) {
    const size_t n = engine.size();
    auto position = room_for<double>(3 * n), velocity = room_for<double>(3 * n);
    auto image = room_for<int32_t>(3 * n);
    auto count = room_for<uint32_t>(n);
    auto resting = room_for<uint8_t>(n);
    {
        const nb::gil_scoped_release release;
        const carom::PlainArithmetic plain;
        for (size_t i = 0; i < n; ++i) {
            const carom::StartSphere s = engine.sphere(int(i));
            const double x[3] = {s.position.x, s.position.y, s.position.z};
            const double v[3] = {s.velocity.x, s.velocity.y, s.velocity.z};
            const int32_t m[3] = {s.image.x, s.image.y, s.image.z};
            std::copy(x, x + 3, &position[3 * i]);
            std::copy(v, v + 3, &velocity[3 * i]);
            std::copy(m, m + 3, &image[3 * i]);
            count[i] = s.count;
            resting[i] = s.resting;
        }
    }
    return nb::make_tuple(array_of(std::move(position), n, 3), array_of(std::move(velocity), n, 3),
                          array_of(std::move(image), n, 3), array_of(std::move(count), n),
                          array_of(std::move(resting), n));
}

auto take_log(Engine& engine) {
    const std::vector<carom::Record> log = engine.take_log();
    const size_t n = log.size() * sizeof(carom::Record);
    auto bytes = room_for<uint8_t>(n);
    if (n > 0) std::memcpy(bytes.get(), log.data(), n);
    return array_of(std::move(bytes), n);
}

auto make_helfand(const Vectors& velocity, const Numbers& mass, const Numbers& radius,
                  const Numbers& charge, double time) {
    const size_t n = velocity.shape(0);
    if (mass.shape(0) != n || radius.shape(0) != n || charge.shape(0) != n)
        throw nb::value_error("arrays of different lengths");
    std::vector<Vec3> v(n);
    for (size_t i = 0; i < n; ++i) v[i] = row(velocity, i);
    const auto numbers = [n](const Numbers& a) { return std::vector(a.data(), a.data() + n); };
    return std::make_unique<Helfand>(v, numbers(mass), numbers(radius), numbers(charge), time);
}

auto helfand_advance(Helfand& h, const Bytes& records, const Numbers& times) {
    const size_t n = records.shape(0) / sizeof(carom::Record), m = times.shape(0);
    auto out = room_for<double>(m * Helfand::kMoments);
    {
        const nb::gil_scoped_release release;
        h.advance(records.data(), n, times.data(), m, out.get());
    }
    return array_of(std::move(out), m, Helfand::kMoments);
}

}  // namespace

void bind_raster(nb::module_& m);  // in raster_bindings.cpp

NB_MODULE(_core, m) {
    m.doc() = "The event loop in C++: moves spheres from one collision to the next.";

    nb::class_<Engine>(m, "Engine", "Moves spheres from one collision to the next.")
        .def(nb::new_(&make_engine), nb::arg("position"), nb::arg("velocity"), nb::arg("mass"),
             nb::arg("radius"), nb::arg("fixed"), nb::arg("resting"), nb::arg("image"),
             nb::arg("count"), nb::arg("time"), nb::arg("period"), nb::arg("walls"),
             nb::arg("restitution"), nb::arg("contact_time"), nb::arg("gravity"),
             nb::arg("collide"), nb::arg("margin") = 0.0, nb::arg("cell") = 0.0,
             nb::arg("log") = true, nb::arg("slice") = 0.05, nb::arg("simd") = "",
             nb::arg("sort") = true, nb::arg("grid") = -1, nb::arg("ahead") = -1,
             nb::arg("profile") = false)
        .def(
            "advance",
            [](Engine& e, double until, int64_t max_collisions, int64_t max_events) {
                return int(e.advance(until, max_collisions, max_events));
            },
            nb::arg("until"), nb::arg("max_collisions"), nb::arg("max_events"),
            nb::call_guard<nb::gil_scoped_release>(), "Runs until a time or a count; see Stop.")
        .def("state", &state_of,
             nb::sig("def state(self) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64], "
                     "NDArray[numpy.int32], NDArray[numpy.uint32], NDArray[numpy.uint8]]"),
             "(position, velocity, image, count, resting) at `time`.")
        .def("take_log", &take_log, nb::sig("def take_log(self) -> NDArray[numpy.uint8]"),
             "Records since the last call, as bytes.")
        .def("max_overlap", &Engine::max_overlap, "Deepest overlap met, in contact distances.")
        .def("check", &Engine::check, "Raises if two structures contradict one another.")
        .def(
            "checkpoint",
            [](const Engine& e) {
                const std::string s = e.checkpoint();
                return nb::bytes(s.data(), s.size());
            },
            "The stored states, for the same bits after a restart.")
        .def(
            "restore",
            [](Engine& e, const nb::bytes& b) { e.restore(std::string(b.c_str(), b.size())); },
            nb::arg("checkpoint"), "Continues from a checkpoint of the same scene.")
        .def_prop_ro("time", &Engine::time, "Simulated time now.")
        .def_prop_ro("collisions", &Engine::collisions, "Between spheres.")
        .def_prop_ro("wall_collisions", &Engine::wall_collisions, "With walls.")
        .def_prop_ro("dissipated", &Engine::dissipated, "Energy the rules have taken.")
        .def_prop_ro("withheld", &Engine::withheld, "Energy the contact-time cure kept.")
        .def(
            "profile",
            [](const Engine& e) {
                using P = carom::Profile;
                const P& p = e.profile();
                return std::map<std::string, double>{{"predict", p.of(P::predict)},
                                                     {"rebuild", p.of(P::rebuild)},
                                                     {"queue", p.of(P::queue)},
                                                     {"collide", p.of(P::collide)}};
            },
            "Seconds that each part of the work took, from a sample of the events.")
        .def(
            "work",
            [](const Engine& e) {
                const carom::Work& w = e.work();
                return std::map<std::string, int64_t>{{"predictions", w.predictions},
                                                      {"shells", w.shells},
                                                      {"stale", w.stale},
                                                      {"exact", w.exact}};
            },
            "What it has done: predictions, shells remade or cells crossed, predictions of a\n"
            "partner hit by another, pairs solved exactly.")
        .def_prop_ro("memory", &Engine::bytes, "Bytes in use.")
        .def_prop_ro(
            "collapse",
            [](const Engine& e) -> std::optional<std::tuple<double, int, int>> {
                const carom::Collapse& c = e.collapse();
                if (c.i == carom::kNone) return std::nullopt;
                return std::make_tuple(c.time, c.i, c.j);
            },
            "(time, i, j) of an inelastic collapse, or None.");

    nb::class_<Helfand>(m, "Helfand", "What the fluxes of momentum, energy and charge add up to.")
        .def(nb::new_(&make_helfand), nb::arg("velocity"), nb::arg("mass"), nb::arg("radius"),
             nb::arg("charge"), nb::arg("time"))
        .def("advance", &helfand_advance, nb::arg("records"), nb::arg("times"),
             nb::sig("def advance(self, records: NDArray[numpy.uint8], times: "
                     "NDArray[numpy.float64]) -> NDArray[numpy.float64]"),
             "Takes collisions, as bytes; the moments at rising times, (m, 12): xx, yy, zz, xy,\n"
             "xz, yz of momentum, then x, y, z of energy and of charge.");

    m.def("simd_levels", &carom::simd_levels,
          "Instruction sets that this machine can run, slowest first.");
    m.def(
        "simd", [] { return std::string(carom::kernels().name); },
        "The instruction set in use; the environment variable CAROM_SIMD chooses another.");

    m.def(
        "first_overlap",
        [](const Vectors& position, const Numbers& radius, const Flags& fixed,
           const Three& period) -> std::optional<std::tuple<int, int, double>> {
            const size_t n = position.shape(0);
            if (radius.shape(0) != n || fixed.shape(0) != n)
                throw nb::value_error("arrays of different lengths");
            const carom::StartSpheres spheres(n, [&](size_t i) {
                carom::StartSphere s;
                s.position = row(position, i);
                s.radius = radius(i);
                s.fixed = fixed(i);
                return s;
            });
            const carom::Overlap o = carom::first_overlap(spheres, three(period));
            if (o.i == carom::kNone) return std::nullopt;
            return std::make_tuple(o.i, o.j, o.depth);
        },
        nb::arg("position"), nb::arg("radius"), nb::arg("fixed"), nb::arg("period"),
        "The deepest overlapping pair (i, j, depth), or None.");

    bind_raster(m);
}
