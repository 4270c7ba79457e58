// The pictures' part of the Python module carom._core.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <memory>

#include "raster/raster.hpp"

namespace nb = nanobind;
namespace raster = carom::raster;
using carom::Vec3;

namespace {

using Vectors = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Numbers = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Colors = nb::ndarray<const uint32_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Eye = nb::ndarray<const double, nb::shape<4, 3>, nb::c_contig, nb::device::cpu>;
using FaceRows = nb::ndarray<const double, nb::shape<-1, 23>, nb::c_contig, nb::device::cpu>;
using EdgeRows = nb::ndarray<const double, nb::shape<-1, 8>, nb::c_contig, nb::device::cpu>;
using Three = std::array<double, 3>;
using Values = nb::typed<nb::dict, nb::str, nb::object>;

Vec3 three(const double* a) { return {a[0], a[1], a[2]}; }

// Everything about light and colours by name, which reads better than a row of numbers.
raster::Look look_from(const Values& values) {
    raster::Look look;
    const auto vector = [&](const char* name) {
        return three(nb::cast<Three>(values[name]).data());
    };
    const auto color = [&](const char* name) {
        const Vec3 a = vector(name);
        return raster::F3{float(a.x), float(a.y), float(a.z)};
    };
    const auto number = [&](const char* name) { return nb::cast<float>(values[name]); };
    look.lamp = vector("lamp"), look.up = vector("up");
    look.low = vector("low"), look.high = vector("high");
    look.key = color("key"), look.sky = color("sky"), look.ground = color("ground");
    look.back = color("back"), look.line = color("line"), look.shell = color("shell");
    look.surface = color("surface"), look.tint = color("tint");
    look.fog_from = number("fog_from"), look.fog_per_length = number("fog_per_length");
    look.fog_most = number("fog_most"), look.line_width = number("line_width");
    look.soft = number("soft"), look.deepest = number("deepest");
    look.shadowed = number("shadowed"), look.crowd_cell = number("crowd_cell");
    look.wire = nb::cast<bool>(values["wire"]);
    look.shadows = nb::cast<bool>(values["shadows"]);
    return look;
}

auto make_raster(int width, int height, int samples, double pixel, const Eye& eye,
                 const Values& values, const FaceRows& faces, const EdgeRows& edges,
                 std::vector<double> shells) {
    if (width < 1 || height < 1 || width > 16384 || height > 16384 || samples < 1 || samples > 2)
        throw nb::value_error("width and height from 1 to 16384, samples 1 or 2");
    const double* const e = eye.data();
    const raster::View view{three(e), three(e + 3), three(e + 6), three(e + 9),
                            pixel,    width,        height,       samples};
    const raster::Look look = look_from(values);
    raster::Room room;
    room.shells = std::move(shells);
    for (size_t k = 0; k < faces.shape(0); ++k) {
        const double* const f = &faces(k, 0);
        room.faces.push_back({three(f),
                              three(f + 3),
                              three(f + 6),
                              three(f + 9),
                              f[12],
                              f[13],
                              {f[14], f[15]},
                              {f[16], f[17]},
                              f[18],
                              f[19],
                              f[20],
                              f[21],
                              f[22]});
    }
    for (size_t k = 0; k < edges.shape(0); ++k) {
        const double* const f = &edges(k, 0);
        room.edges.push_back({three(f), three(f + 3), f[6], f[7]});
    }
    const nb::gil_scoped_release release;
    return std::make_unique<raster::Raster>(view, look, std::move(room));
}

auto draw(raster::Raster& self, const Vectors& position, const Numbers& radius, const Colors& color,
          size_t own) {
    const size_t n = position.shape(0);
    if (radius.shape(0) != n || color.shape(0) != n || own > n)
        throw nb::value_error("arrays of different lengths");
    const size_t width = self.view().width, height = self.view().height;
    uint8_t* const bytes = new uint8_t[3 * width * height];
    nb::capsule owner(bytes, [](void* p) noexcept { delete[] static_cast<uint8_t*>(p); });
    {
        std::vector<Vec3> places(n);
        for (size_t i = 0; i < n; ++i) places[i] = three(&position(i, 0));
        const std::vector<double> radii(radius.data(), radius.data() + n);
        const std::vector<uint32_t> colors(color.data(), color.data() + n);
        const nb::gil_scoped_release release;
        self.draw(places, radii, colors, own, bytes);
    }
    return nb::ndarray<nb::numpy, uint8_t>(bytes, {height, width, 3}, owner);
}

}  // namespace

void bind_raster(nb::module_& m) {
    nb::class_<raster::Raster>(m, "Raster", "Draws pictures of spheres in a room, from one place.")
        .def(nb::new_(&make_raster), nb::arg("width"), nb::arg("height"), nb::arg("samples"),
             nb::arg("pixel"), nb::arg("eye"), nb::arg("look"), nb::arg("faces"), nb::arg("edges"),
             nb::arg("shells"),
             "eye: place, right, up, forward. faces and edges: rows as in core/raster/picture.hpp.")
        .def("draw", &draw, nb::arg("position"), nb::arg("radius"), nb::arg("color"),
             nb::arg("own"),
             nb::sig("def draw(self, position: NDArray[numpy.float64], "
                     "radius: NDArray[numpy.float64], color: NDArray[numpy.uint32], "
                     "own: int) -> "
                     "NDArray[numpy.uint8]"),
             "(height, width, 3). All but the first `own` spheres are images of these.");
}
