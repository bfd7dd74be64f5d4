// SPDX-License-Identifier: Apache-2.0
// The sun's position from place, date and time.
#pragma once

namespace restage::sunsky {

struct Place {
    double latitude = 0, longitude = 0; // [deg], north and east positive
};
struct Moment {
    int year = 2000, month = 1, day = 1; // Gregorian; clamped to the last day of the month
    double hour = 12; // local time of the zone
    double zone = 0;  // hours ahead of UTC
};
struct SunPosition {
    double azimuth = 0;     // [rad], clockwise from north
    double elevation = 0;   // [rad] above the horizon, without refraction
    double declination = 0; // [rad]
};

double days_since_2000(const Moment&); // since 1 January 2000, 12h UTC
SunPosition sun_at(const Place&, const Moment&);

} // namespace restage::sunsky
