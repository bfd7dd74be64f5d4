// SPDX-License-Identifier: Apache-2.0
// The contents of a material library. Bourke's page on MTL and Alias|Wavefront's manual, appendix B; the PBR statements
// are exocortex's.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace restage::obj {

struct MtlTexture {
    std::string file; // as written
    std::array<double, 3> scale{1, 1, 1}, offset{}, turbulence{};
    double base = 0, gain = 1, bump = 1;
    bool clamp = false;
    std::string colorspace, channel; // "" = not given
};

struct Mtl {
    std::string name;
    std::uint32_t line = 0;
    std::map<std::string, std::uint32_t> lines; // statement in its usual spelling (map_bump is "bump") -> its line
    std::map<std::string, std::array<double, 3>> colors; // Kd, Ks, Ke, Tf, Ka
    std::map<std::string, double> numbers; // Ns, Ni, d, illum, Pr, Pm, Ps, Pc, Pcr, aniso, anisor
    std::map<std::string, MtlTexture> textures; // map_Kd, ...
    std::map<std::string, std::uint32_t> not_understood;

    bool has(const char* key) const { return lines.contains(key); }
    std::array<double, 3> color(const char* key) const {
        const auto it = colors.find(key);
        return it == colors.end() ? std::array<double, 3>{} : it->second;
    }
    double number(const char* key, double otherwise) const {
        const auto it = numbers.find(key);
        return it == numbers.end() ? otherwise : it->second;
    }
    const MtlTexture* texture(const char* key) const {
        const auto it = textures.find(key);
        return it == textures.end() ? nullptr : &it->second;
    }
};

// In file order. Accepts any text: text that is not MTL gives no materials.
std::vector<Mtl> read_mtl(std::string_view text);

} // namespace restage::obj
