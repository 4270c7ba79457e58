// The light that comes from a place on a sphere to the eye. The same as the page's light.js.
#pragma once

#include "shadow.hpp"
#include "visibility.hpp"

namespace carom::raster {

class Shading {
public:
    Shading(const View& view, const Look& look);

    // Paints what is seen of the spheres over what is in the frame. visible: those that are seen.
    void paint(const Visibility& seen, const std::vector<int>& visible,
               const std::vector<Ball>& balls, const std::vector<Skin>& skins,
               const Casters& casters, Frame& frame) const;

private:
    struct Batch;
    void light(Batch& batch, int who, const Ball& ball, const Skin& skin,
               const Casters& casters) const;
    void shadow(Batch& batch, int ball, const Casters& casters) const;

    View view_;
    Look look_;
    F3 lamp_, up_;
    std::vector<float> rays_;  // view.ray_x of each column
};

}  // namespace carom::raster
