// SPDX-License-Identifier: Apache-2.0
// A map's sun as a directional light of its own, instead of a highlight that is clamped.
#pragma once

#include <array>
#include <vector>

#include "envmap/image.h"
#include "envmap/latlong.h"

namespace airlight {

struct SunOptions {
    /// Radians from the brightest pixel, in (0, pi/2], within which the lobe must fall to its
    /// surroundings; at least 1.5 rows of the map.
    double largest_radius = 0.15;
    /// How many times as bright as its surroundings the brightest pixel must be, > 1.
    double least_contrast = 4;
};

enum class SunVerdict {
    found,
    dark,  ///< no pixel has positive luminance
    flat,  ///< nothing, or nothing around it, is fainter by least_contrast
    wide,  ///< half as bright as the peak beyond largest_radius: a window or a sky, no sun
};

/// A sentence for people.
const char* to_text(SunVerdict verdict);

/// What was taken out of a map. Channels are those of the map.
struct Sun {
    SunVerdict verdict = SunVerdict::dark;
    std::array<double, 3> direction = {};  ///< towards the sun, unit, world frame
    /// Irradiance on a surface that faces it, the radiance above its surroundings integrated over
    /// the lobe, [radiance * sr], per channel, none negative.
    std::vector<double> irradiance;
    /// Half-angle of the uniform disc whose mean direction is as long as the lobe's: what a
    /// renderer gives the light for its penumbrae and highlights.
    double angular_radius = 0;
    double solid_angle = 0;  ///< of the pixels that were changed
    double reach = 0;        ///< largest angle between direction and such a pixel's centre
    std::vector<LatLongPixel> pixels;  ///< those of the lobe
};

/// Takes the brightest lobe out of a lat-long map and puts its surroundings in its place. Where
/// there is no sun the map stays as it is and `verdict` says why.
///
/// The lobe is the connected region about the pixel of largest luminance (the first of equals; the
/// mean of the channels if they are not three) that is brighter than its surroundings B by B/2 and
/// by 1/256 of the peak, or than what lies between it and the next thing at largest_radius. Pixels
/// that touch, or have one between them, also across the seam or a pole, are connected. The
/// surroundings are the pixels of a ring about it that are not as bright; their median is the B
/// meant above, and the plane fitted to them, within their extremes, replaces the lobe, channel by
/// channel; what is below it stays.
///
/// Energy: what the map lost is the irradiance, of each channel to 1e-13 of the map's. The first
/// moment of what the map lost differs from irradiance * direction by at most irradiance * 2
/// sin(a/2), a the largest angle between direction and a point of the lobe; of the luminance, by (1
/// - cos a), as direction is its mean. Spherical harmonics of what is left and of the light,
/// irradiance * Y_lm(direction), sum to those of the map but for l (l+1) angular_radius^2 / 8 of
/// the light's, in degree l, for a disc (tests: within 5 % of that, up to l = 5).
///
/// A second call takes the next sun. Single dark pixels that lossy compression leaves within a sun
/// stay. Cost: a pass over the map and O(n log n) for the n pixels within largest_radius; 1024 x
/// 512 takes 10 to 40 ms, 4096 x 2048 0.2 s, one thread of a busy machine.
///
/// Throws Error: usage for options outside their domain, data if the map has no pixels or values
/// that are not finite, with their number and the first one's place.
Sun extract_sun(Image& map, const SunOptions& options = {});

}  // namespace airlight
