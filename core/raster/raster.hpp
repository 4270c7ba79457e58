// Pictures of spheres without a graphics unit: the page's picture, traced on the processor.
#pragma once

#include <mutex>
#include <optional>
#include <utility>

#include "crowd.hpp"
#include "picture.hpp"
#include "shading.hpp"
#include "visibility.hpp"
#include "walls.hpp"

namespace carom::raster {

// Draws one picture after another of a room, from one place. What stays the same is drawn once.
class Raster {
public:
    Raster(const View& view, const Look& look, Room room);

    // position: in the world; color: 0xRRGGBB; bytes: height × width × 3. The first `own` spheres
    // fill the room, all others are images of them. One thread at a time, others wait.
    void draw(const std::vector<Vec3>& position, const std::vector<double>& radius,
              const std::vector<uint32_t>& color, size_t own, uint8_t* bytes);

    const View& view() const { return view_; }

private:
    void order(const std::vector<Vec3>& position, const std::vector<double>& radius);
    void place(const std::vector<Vec3>& position, const std::vector<double>& radius,
               const std::vector<uint32_t>& color);
    void sort_into_bands();
    Span rows_of(int band) const;
    Span columns_of(int band) const;
    void copy_beside(uint8_t* bytes) const;
    void paint(int band, uint8_t* bytes);
    void shade(int k);
    void uncover();
    void draw_veil();

    View view_;
    Look look_;
    Room room_;
    std::vector<Wall> walls_;
    LightMap shadows_, spots_;  // of the wall that is lit
    Shading shading_;
    Visibility seen_;
    Casters casters_;
    std::vector<float> distance_;       // of spheres, nearly
    std::vector<int> order_;            // from near to far
    std::vector<Ball> balls_;           // in this order
    std::vector<Skin> skins_;           // of these
    int band_ = 1;                      // rows of pixels that are drawn at once
    std::vector<int> starts_, inside_;  // spheres by band
    std::vector<Span> columns_;         // of bands, that spheres may cover
    std::vector<int> visible_;          // those of a band that are seen
    std::optional<Crowd> crowd_;
    Frame still_;                 // what lies behind all spheres
    Frame veil_;                  // how much what lies before all hides
    Frame frame_;                 // a band of the picture
    std::vector<uint8_t> empty_;  // the picture without spheres
    std::mutex busy_;
};

}  // namespace carom::raster
