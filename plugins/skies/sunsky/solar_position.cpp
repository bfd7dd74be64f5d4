// SPDX-License-Identifier: Apache-2.0
// The PSA algorithm: Blanco-Muriel, Alarcon-Padilla, Lopez-Moratalla, Lara-Coira 2001, Computing the solar vector,
// Solar Energy 70(5). Accurate to half an arc minute from 1999 to 2015, and to a few in adjacent decades.
#include "sunsky/solar_position.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

namespace restage::sunsky {

double days_since_2000(const Moment& when) {
    using namespace std::chrono;
    const year_month month = year(when.year) / std::clamp(when.month, 1, 12);
    const auto last = unsigned((month / std::chrono::last).day());
    const sys_days date = month / day(std::clamp(unsigned(std::max(when.day, 1)), 1u, last));
    return double((date - sys_days(2000y / January / 1)).count()) - 0.5 + (when.hour - when.zone) / 24;
}

SunPosition sun_at(const Place& place, const Moment& when) {
    const double n = days_since_2000(when);
    // Ecliptic coordinates of the sun, obliquity of the ecliptic, then right ascension and declination.
    const double omega = 2.1429 - 0.0010394594 * n;
    const double mean_longitude = 4.8950630 + 0.017202791698 * n;
    const double anomaly = 6.2400600 + 0.0172019699 * n;
    const double longitude = mean_longitude + 0.03341607 * std::sin(anomaly) + 0.00034894 * std::sin(2 * anomaly) -
                             0.0001134 - 0.0000203 * std::sin(omega);
    const double obliquity = 0.4090928 - 6.2140e-9 * n + 0.0000396 * std::cos(omega);
    const double ascension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
    const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
    // Then local coordinates.
    constexpr double degree = std::numbers::pi / 180;
    const double sidereal = 6.6974243242 + 0.0657098283 * n + (when.hour - when.zone); // at Greenwich [h]
    const double hour_angle = (15 * sidereal + place.longitude) * degree - ascension;
    const double latitude = place.latitude * degree;
    const double up =
        std::sin(latitude) * std::sin(declination) + std::cos(latitude) * std::cos(declination) * std::cos(hour_angle);
    const double east = -std::cos(declination) * std::sin(hour_angle);
    const double north =
        std::sin(declination) * std::cos(latitude) - std::cos(declination) * std::sin(latitude) * std::cos(hour_angle);
    constexpr double parallax = 6371.01 / 149597890; // earth's radius over its distance from the sun
    const double across = std::hypot(east, north);
    return {std::atan2(east, north), std::atan2(up, across) - parallax * across, declination};
}

} // namespace restage::sunsky
