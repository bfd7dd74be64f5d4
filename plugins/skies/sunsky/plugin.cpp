// SPDX-License-Identifier: Apache-2.0
// "sunsky": its parameters and its image.
#include "sunsky/daylight.hpp"
#include "sunsky/solar_position.hpp"

#include <restage/sky.h>
#include <restage/plugin.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numbers>

namespace {

namespace sdk = restage::sdk;
using namespace restage::sunsky;

// Luminance [cd/m^2] that becomes 1 at an intensity of 1: about that of white paper in the sun at noon.
constexpr double unit_luminance = 25000;

constexpr RestageParam params[] = {
    sdk::choice("mode", "Sun by", "direction|place", 0,
                {"direction: azimuth and elevation. place: position, date and time, below"}),
    sdk::number("azimuth", "Azimuth", 0, 360, 180,
                {"Of the sun, clockwise from north, if it is given by direction", "deg"}),
    sdk::number("elevation", "Elevation", -18, 90, 35,
                {"Of the sun above the horizon, if it is given by direction. Below 0 is twilight", "deg"}),
    sdk::number("turbidity", "Turbidity", 2, 10, 3, {"Haze: 2 is a clear sky, 3 a typical one, 6 hazy, 10 misty"}),
    sdk::color("ground", "Ground", {0.2f, 0.2f, 0.2f},
               {"The colour of the land below the horizon, lit by sun and sky"}),
    sdk::toggle("sun", "Sun", true, {"The sun's disk and its light; off: only the sky"}),
    sdk::number(
        "sun_size", "Sun size", 0.5f, 20, 1,
        {"Diameter of the disk relative to the true one. The irradiance stays the same; shadows get softer", "x"}),
    sdk::number("intensity", "Intensity", 0, 100, 1,
                {"Multiplies everything. At 1, a value of 1 is 25 000 cd/m^2, about white paper at noon"}),
    sdk::number("north", "North", -360, 360, 0,
                {.tooltip = "Rotates everything clockwise, including the sun", .unit = "deg", .advanced = true}),
    sdk::number("latitude", "Latitude", -90, 90, 48.2f,
                {.tooltip = "Of the place, north positive", .unit = "deg", .advanced = true}),
    sdk::number("longitude", "Longitude", -180, 180, 16.4f,
                {.tooltip = "Of the place, east positive", .unit = "deg", .advanced = true}),
    sdk::integer("year", "Year", 1950, 2050, 2026, {.tooltip = "Of the date", .advanced = true}),
    sdk::integer("month", "Month", 1, 12, 6, {.tooltip = "1 is January", .advanced = true}),
    sdk::integer("day", "Day", 1, 31, 21, {.tooltip = "Of the month", .advanced = true}),
    sdk::number("hour", "Time", 0, 24, 14, {.tooltip = "Local clock time", .unit = "h", .advanced = true}),
    sdk::number("zone", "Time zone", -12, 14, 2,
                {.tooltip = "Hours ahead of UTC, including daylight saving", .unit = "h", .advanced = true}),
};

class Values {
  public:
    Values(const RestageValue* values, std::uint32_t count) : values_(values), count_(count) {}
    double number(const char* id) const { return find(id).v[0]; }
    int whole(const char* id) const { return find(id).i; }
    bool is(const char* id, const char* choice) const {
        const char* text = find(id).text;
        return text && std::strcmp(text, choice) == 0;
    }
    Color color(const char* id) const {
        const RestageValue& v = find(id);
        return {v.v[0], v.v[1], v.v[2]};
    }

  private:
    const RestageValue& find(const char* id) const {
        static constexpr RestageValue nothing{};
        for (std::uint32_t i = 0; i < count_; ++i)
            if (const RestageValue& v = RESTAGE_AT(RestageValue, values_, i); v.id && std::strcmp(v.id, id) == 0)
                return v;
        return nothing;
    }
    const RestageValue* values_;
    std::uint32_t count_;
};

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

DaylightParams daylight_of(const Values& values) {
    DaylightParams out{.azimuth = radians(values.number("azimuth")),
                       .elevation = radians(values.number("elevation")),
                       .turbidity = values.number("turbidity"),
                       .albedo = values.color("ground"),
                       .sun = values.whole("sun") != 0};
    if (values.is("mode", "place")) {
        const SunPosition sun = sun_at({values.number("latitude"), values.number("longitude")},
                                       {values.whole("year"), values.whole("month"), values.whole("day"),
                                        values.number("hour"), values.number("zone")});
        out.azimuth = sun.azimuth, out.elevation = sun.elevation;
    }
    out.azimuth += radians(values.number("north"));
    return out;
}

int make(const RestageValue* list, std::uint32_t count, const RestageSkyJob1* out) {
    const Values values(list, count);
    const Daylight daylight(daylight_of(values));
    const double scale = values.number("intensity") / unit_luminance;
    for (std::uint32_t y = 0; y < out->width; ++y) {
        if (y % 16 == 0 && !out->progress(out->ctx, float(y) / float(out->width))) return 0;
        float* row = out->pixels + std::size_t{y} * out->width * 3;
        for (std::uint32_t x = 0; x < out->width; ++x) {
            double w[3];
            restage_sky_direction(out->width, x + 0.5, y + 0.5, w);
            const Color light = daylight.at({w[0], w[1], w[2]});
            for (std::size_t k = 0; k < 3; ++k)
                row[3 * x + k] = float(light[k] * scale);
        }
    }
    const Color disk = daylight.disk();
    if (disk[0] + disk[1] + disk[2] > 0) {
        const double size = values.number("sun_size");
        RestageSkySun sun{};
        sun.size = sizeof sun;
        sun.angular_radius = float(sun_radius * size);
        const auto solid_angle = [](double radius) { return 1 - std::cos(radius); };
        const double dimmed = solid_angle(sun_radius) / solid_angle(sun_radius * size);
        const Direction& to = daylight.to_sun();
        sun.direction[0] = float(to.x), sun.direction[1] = float(to.y), sun.direction[2] = float(to.z);
        for (std::size_t k = 0; k < 3; ++k)
            sun.radiance[k] = float(disk[k] * scale * dimmed);
        out->sun(out->ctx, &sun);
    }
    return 1;
}

const RestageSky1 sky = {sizeof(RestageSky1),
                         RESTAGE_COUNT(params),
                         "sunsky",
                         "Sun and sky",
                         "A clear sky and its sun, by direction or by place and time",
                         params,
                         make};

} // namespace

RESTAGE_PLUGIN("org.restage.sky.sunsky", "0.1.0", {RESTAGE_SKY1, &sky})
