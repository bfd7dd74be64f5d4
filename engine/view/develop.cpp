// SPDX-License-Identifier: Apache-2.0
#include "view/develop.hpp"

#include "io/image_file.hpp"
#include "scene/color_temperature.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace restage::view {

namespace {

using scene::ToneCurve;

constexpr float most = 1e12f; // larger values are as white

// Pixels are developed in blocks, channel by channel: compilers use vector instructions for everything but tables.
struct Block {
    static constexpr std::size_t size = 32;
    using Channel = std::array<float, size>;
    alignas(16) std::array<Channel, 3> c;
};

float limited(float x) { // NaN: black
    const float above = x > -most ? x : -most;
    return above < most ? above : most;
}
float unit(float x) {
    const float above = x > 0 ? x : 0.f;
    return above < 1 ? above : 1.f;
}

glm::dmat3 rows(const std::array<double, 9>& m) {
    return glm::transpose(glm::dmat3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]));
}

// 8-bit sRGB indexed by the upper 16 bits of a float, avoiding a power per pixel: 7 bits of mantissa are finer than
// 8-bit sRGB needs below 1, except for the darkest steps.
class Encoding {
  public:
    explicit Encoding(float (*curve)(float)) : table_(0x8000) {
        for (std::uint32_t i = 0; i < table_.size(); ++i) {
            const float x = std::bit_cast<float>(i << 16 | 0x8000u);
            table_[i] = std::isnan(x) ? 0 : encode(curve(x));
        }
    }
    std::uint32_t operator()(float x) const { return table_[std::bit_cast<std::uint32_t>(x > 0 ? x : 0.f) >> 16]; }

  private:
    static std::uint8_t encode(float x) { // IEC 61966-2-1
        x = std::clamp(x, 0.f, 1.f);
        const float y = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
        return std::uint8_t(std::lround(y * 255));
    }
    std::vector<std::uint8_t> table_;
};

const Encoding& srgb() {
    static const Encoding table([](float x) { return x; });
    return table;
}

const Encoding& filmic() {
    static const Encoding table(
        [](float x) { return std::isfinite(x) ? x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f) : 1; });
    return table;
}

std::uint32_t pack(std::uint32_t r, std::uint32_t g, std::uint32_t b) { return r | g << 8 | b << 16 | 0xff000000u; }

void multiply(glm::mat3 matrix, Block& block) { // a copy, which the block cannot alias
    const glm::vec3 &x = matrix[0], &y = matrix[1], &z = matrix[2];
    auto& [red, green, blue] = block.c;
    for (std::size_t i = 0; i < Block::size; ++i) {
        const float r = red[i], g = green[i], b = blue[i];
        red[i] = x.x * r + y.x * g + z.x * b;
        green[i] = x.y * r + y.y * g + z.y * b;
        blue[i] = x.z * r + y.z * g + z.z * b;
    }
}

// Its two curves are tables: half a step of either changes less than 0.1 of 8 bits, and both fit a cache.
class Agx {
  public:
    Agx() {
        for (std::size_t i = 0; i < log_curve_.size(); ++i)
            log_curve_[i] = float(contrast(std::bit_cast<float>((std::uint32_t(i) + first) << 15 | 0x4000u)));
        for (std::size_t i = 0; i < power_.size(); ++i)
            power_[i] = float(std::pow(double(i) / double(power_.size() - 1), 2.2));
    }
    static glm::dmat3 before() { return inset() * from_srgb(); }
    void operator()(Block& block) const {
        for (Block::Channel& channel : block.c)
            look_up(channel, log_curve_, [](float x) { // x <= 0 is a negative number, too
                const std::int32_t at = (std::bit_cast<std::int32_t>(x) >> 15) - std::int32_t(first);
                const std::int32_t above = at > 0 ? at : 0;
                return above < last ? above : last;
            });
        multiply(outset_, block);
        for (Block::Channel& channel : block.c)
            // NOLINTNEXTLINE(bugprone-incorrect-roundings): x >= 0, and lround is no vector instruction
            look_up(channel, power_, [](float x) { return std::int32_t(unit(x) * 2048 + 0.5f); });
        multiply(to_srgb_, block);
    }

  private:
    // ITU-R BT.2087, from BT.709; BT.2020 to 709 is its inverse.
    static glm::dmat3 from_srgb() {
        return rows({0.627403895934699, 0.329283038377884, 0.043313065687417, //
                     0.069097289358232, 0.919540395075459, 0.011362315566309, //
                     0.016391438875150, 0.088013307877226, 0.895595253247624});
    }
    static glm::dmat3 inset() {
        return rows({0.856627153315983, 0.0951212405381588, 0.0482516061458583, //
                     0.137318972929847, 0.761241990602591, 0.101439036467562,   //
                     0.11189821299995, 0.0767994186031903, 0.811302368396859});
    }
    static glm::dmat3 outset() {
        return rows({1.1271005818144368, -0.11060664309660323, -0.016493938717834573, //
                     -0.1413297634984383, 1.157823702216272, -0.016493938717834257,   //
                     -0.14132976349843826, -0.11060664309660294, 1.2519364065950405});
    }
    // Of stops from 10 below middle grey, 0.18, to 6.5 above: a straight line through the pivot, bent to reach 0 and 1.
    static double contrast(double x) {
        constexpr double below = 10, range = 16.5, pivot = below / range, grey = 0.5, slope = 2;
        const double t = std::clamp((std::log2(x / 0.18) + below) / range, 0.0, 1.0);
        const bool up = t > pivot;
        const double power = up ? 3.25 : 3, run = up ? 1 - pivot : pivot, rise = up ? 1 - grey : grey;
        const double scale =
            std::pow(std::pow(slope * run, -power) * (std::pow(slope * run / rise, power) - 1), -1 / power);
        const double along = slope * std::abs(t - pivot) / scale;
        const double bent = scale * along / std::pow(1 + std::pow(along, power), 1 / power);
        return up ? grey + bent : grey - bent;
    }
    template <class Table, class Index>
    static void look_up(Block::Channel& channel, const Table& table, Index&& index) {
        std::array<std::int32_t, Block::size> at;
        for (std::size_t i = 0; i < Block::size; ++i)
            at[i] = index(channel[i]);
        for (std::size_t i = 0; i < Block::size; ++i)
            channel[i] = table[std::size_t(at[i])];
    }

    static constexpr std::uint32_t first = (127u - 13) << 8; // of 2^-13, in 256ths of octaves
    static constexpr std::int32_t last = (18 << 8) - 1; // to 2^5
    std::array<float, last + 1> log_curve_;
    std::array<float, 2049> power_;
    glm::mat3 outset_{outset()}, to_srgb_{glm::inverse(from_srgb())};
};

const Agx& agx() {
    static const Agx it;
    return it;
}

void neutral(Block& block) {
    constexpr float start = 0.8f - 0.04f, rest = 1 - start, desaturation = 0.15f;
    auto& [red, green, blue] = block.c;
    for (std::size_t i = 0; i < Block::size; ++i) {
        float r = red[i] > 0 ? red[i] : 0.f, g = green[i] > 0 ? green[i] : 0.f, b = blue[i] > 0 ? blue[i] : 0.f;
        const float less = r < g ? r : g, least = less < b ? less : b;
        // What a dielectric reflects besides its colour.
        const float offset = least < 0.08f ? least - 6.25f * least * least : 0.04f;
        r -= offset, g -= offset, b -= offset;
        const float more = r > g ? r : g, peak = more > b ? more : b, high = peak > start ? peak : start;
        const float compressed = 1 - rest * rest / (high + rest - start); // at `start` it is the same
        const float keep = 1 / (desaturation * (high - compressed) + 1), scale = keep * compressed / high;
        const float white = compressed * (1 - keep);
        red[i] = r * scale + white;
        green[i] = g * scale + white;
        blue[i] = b * scale + white;
    }
}

// Dims towards the corners of the whole film.
class Vignette {
  public:
    Vignette(const Developing& d, std::uint32_t width, std::uint32_t height) : width_(width) {
        const glm::vec4& w = d.window;
        const glm::vec2 film(float(width) / (w.y - w.x), float(height) / (w.w - w.z)); // [pixel]
        middle_ = glm::vec2(0.5f - w.x, 0.5f - w.z) * film - 0.5f;
        strength_ = 4 * d.how.vignette / glm::dot(film, film);
    }
    void operator()(Block& block, std::size_t first) const {
        for (std::size_t i = 0; i < Block::size; ++i) {
            const std::size_t pixel = first + i;
            const float x = float(pixel % width_) - middle_.x, y = float(pixel / width_) - middle_.y;
            const float cos2 = 1 / (1 + strength_ * (x * x + y * y)); // of the ray's angle
            for (Block::Channel& channel : block.c)
                channel[i] *= cos2 * cos2;
        }
    }

  private:
    std::size_t width_;
    glm::vec2 middle_{0}; // [pixel]
    float strength_ = 0;
};

// tone(block) makes linear colours for `encode` of exposed, dimmed and adapted ones.
template <class Tone>
void each(std::span<const glm::vec3> color, std::uint32_t width, std::uint32_t height, const Developing& d,
          const glm::dmat3& matrix, Tone&& tone, const Encoding& encode, std::uint32_t* out) {
    const Vignette vignette(d, width, height);
    const bool adapts = matrix != glm::dmat3(1);
    const float factor = d.factor;
    const glm::mat3 m(matrix);
    Block block{};
    for (std::size_t first = 0; first < color.size(); first += Block::size) {
        const std::size_t count = std::min(Block::size, color.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            const glm::vec3 c = color[first + i] * factor;
            block.c[0][i] = c.x, block.c[1][i] = c.y, block.c[2][i] = c.z;
        }
        for (Block::Channel& channel : block.c)
            for (float& x : channel)
                x = limited(x);
        if (d.how.vignette > 0) vignette(block, first);
        if (adapts) multiply(m, block);
        tone(block);
        for (std::size_t i = 0; i < count; ++i)
            *out++ = pack(encode(block.c[0][i]), encode(block.c[1][i]), encode(block.c[2][i]));
    }
}

float linear_of(std::uint32_t encoded) {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values;
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = io::srgb_to_linear(float(i) / 255);
        return values;
    }();
    return table[encoded & 255];
}

// Where less than all of a pixel is covered, its light is in front of the backdrop.
void add_backdrop(const Developing& d, std::uint32_t* rgba) {
    const Encoding& encode = srgb();
    for (std::size_t i = 0; i < d.coverage.size(); ++i) {
        const float covered = std::clamp(d.coverage[i], 0.f, 1.f);
        if (covered == 1) continue;
        glm::vec3 light(linear_of(rgba[i]), linear_of(rgba[i] >> 8), linear_of(rgba[i] >> 16));
        std::uint32_t alpha = 255;
        if (d.how.backdrop == scene::Backdrop::color) {
            light += d.how.backdrop_color * (1 - covered);
        } else {
            const float opaque = std::max({covered, light.x, light.y, light.z});
            alpha = std::uint32_t(std::lround(opaque * 255));
            if (opaque > 0) light /= opaque;
        }
        rgba[i] = (pack(encode(light.x), encode(light.y), encode(light.z)) & 0xffffff) | alpha << 24;
    }
}

} // namespace

void develop(std::span<const glm::vec3> color, std::uint32_t width, std::uint32_t height, const Developing& d,
             std::uint32_t* rgba) {
    std::vector<glm::vec3> scattered;
    if (d.how.bloom > 0) color = scattered = bloomed(color, width, height, d.how.bloom);
    const glm::dmat3 balance = scene::white_balance(double(d.how.temperature), double(d.how.tint));
    const auto run = [&](const glm::dmat3& matrix, auto&& tone, const Encoding& encode) {
        each(color, width, height, d, matrix, tone, encode, rgba);
    };
    const auto none = [](Block&) {};
    switch (d.how.tone) {
        case ToneCurve::srgb:
            run(balance, none, srgb());
            break;
        case ToneCurve::filmic:
            run(balance, none, filmic());
            break;
        case ToneCurve::agx:
            run(Agx::before() * balance, agx(), srgb());
            break;
        case ToneCurve::neutral:
            run(balance, neutral, srgb());
            break;
    }
    if (d.how.backdrop != scene::Backdrop::black) add_backdrop(d, rgba);
}

} // namespace restage::view
