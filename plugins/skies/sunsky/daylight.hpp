// SPDX-License-Identifier: Apache-2.0
// The light of a clear sky, with twilight and the ground below the horizon: the distribution is that of Preetham,
// Shirley, Smits 1999, the amount of light Bird's and Hulstrom's.
#pragma once

#include "sunsky/sunlight.hpp"

namespace restage::sunsky {

struct Direction {
    double x = 0, y = 0, z = 1; // unit; z up, y north, x east
};
Direction direction_of(double azimuth, double elevation); // [rad], azimuth clockwise from north

struct DaylightParams {
    double azimuth = 0, elevation = 0.5; // of the sun [rad]
    double turbidity = 3;
    Color albedo{0.2, 0.2, 0.2}; // of the ground, linear sRGB
    bool sun = true;
};

// Perez' distribution of one component: Y, x or y.
struct Perez {
    double a, b, c, d, e;
    double at(double cos_theta, double gamma, double cos_gamma) const;
};

class Daylight {
  public:
    explicit Daylight(const DaylightParams&);
    // Luminance as linear sRGB [cd/m^2] of the sky, or of the ground below it, without the sun's disk.
    Color at(const Direction&) const;
    // Radiance of the disk at the sun's true size; black when it has set.
    Color disk() const { return disk_; }
    const Direction& to_sun() const { return to_sun_; }
    // Illuminance of a level surface, per channel [lx].
    Color from_sky() const { return from_sky_; }
    Color from_sun() const { return from_sun_; }

  private:
    Color sky(const Direction&) const;

    DaylightParams params_;
    Direction to_sun_, shown_sun_; // clamped to the horizon
    Perez luminance_, x_, y_;
    double zenith_[3] = {1, 0, 0}; // Y [cd/m^2], x, y, divided by the distribution's value there
    Color disk_{}, from_sky_{}, from_sun_{}, ground_{};
};

} // namespace restage::sunsky
