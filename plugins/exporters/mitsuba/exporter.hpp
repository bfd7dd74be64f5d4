// SPDX-License-Identifier: Apache-2.0
// One export: the host's reader, the options, and the output so far. Same scene, same bytes.
#pragma once

#include "common/matrix.hpp"
#include "common/output.hpp"
#include "common/picture.hpp"
#include "common/places.hpp"
#include "common/values.hpp"
#include "xml.hpp"

#include <restage/scene_io.h>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace restage::mitsuba_out {

using namespace exporters;
using Color = std::array<float, 3>;
using Function = float (*)(float); // of a texel: roughness to alpha and so on

class Exporter {
  public:
    Exporter(const RestageSceneReader1& in, Files textures, Output& out) : in_(in), out_(out), places_(out, textures) {}
    bool run(const std::string& scene_name); // false = stopped by the user

  private:
    void approximated(const std::string& what, const std::string& note) { report(RESTAGE_APPROXIMATED, what, note); }
    void dropped(const std::string& what, const std::string& note) { report(RESTAGE_DROPPED, what, note); }
    void report(RestageFate, const std::string& what, const std::string& note); // each line once
    void report_kept(const RestageOrigin&, const std::string& what); // what only the file's own format can hold
    std::string unique_id(const char* kind, const std::string& name);

    // write_sensor.cpp
    void integrator();
    void sensor();
    void film();
    void filter(const RestageFilm&);
    std::array<double, 2> clip_distances(const Matrix& camera_to_world);

    // write_textures.cpp
    // A texture as at most one picture, texel x -> mul x + add; no picture: the constant `add`.
    struct Flat {
        RestageHandle texture = 0; // the imagemap
        Color mul{1, 1, 1}, add{0, 0, 0};
    };
    std::optional<Flat> flat(RestageHandle texture, int depth = 0); // nullopt = more than that
    std::optional<Flat> flat_value(const Values&, const char* id, float otherwise, int depth);
    // As a property of the open element: a number or colour, or a reference to a texture that it writes first.
    void put_texture(Xml&, const char* name, RestageHandle, bool scalar, Function of_texel = nullptr);
    void put_number(Xml&, const char* name, const Values&, const char* id, float otherwise);
    void put_color(Xml&, const char* name, const Values&, const char* id, Color otherwise);
    std::string bitmap(const Flat&, bool scalar, Function of_texel); // its id
    std::string bitmap_file(const Flat&, bool scalar, Function of_texel, bool& raw);
    std::string checkerboard(RestageHandle, const RestageTexture&); // its id; "" = not of two constants
    void put_mapping(Xml&, const Values&, double scale, bool of_picture, const std::string& what);

    // write_materials.cpp
    std::string material(RestageHandle); // its id
    std::string cut_out(RestageHandle material, const RestageInstance&); // the id of the material with the alpha
    void surface(Xml&, const RestageMaterialDesc&, const Values&, const std::string& what); // one bsdf
    void put_metal(Xml&, const Values&, const char* eta_id, const char* k_id);
    float mean(const Values&, const char* id, float otherwise);
    void put_alpha(Xml&, const Values&, const char* u_id, const char* v_id, float otherwise);
    double least_alpha(const Values&, const char* u_id, const char* v_id, float otherwise); // 1 when textured
    void plastic(Xml&, const Values&, const char* color_id, Color otherwise, const char* u_id, const char* v_id,
                 float roughness, float eta, const std::string& what);
    void thin_diffuse(Xml&, const Color& reflected, const Color& transmitted);
    void principled(Xml&, const Values&, const std::string& what);

    // write_lights.cpp
    void environment();
    void light(RestageHandle);

    // write_shapes.cpp
    bool shapes();
    void shape(Xml&, const RestageInstance&, bool in_group, const std::string& id);
    bool sphere(Xml&, const RestageInstance&, const RestageMesh&, const std::string& id);
    void finish_shape(Xml&, const RestageInstance&, bool flipped);
    std::string mesh_file(RestageHandle);

    const RestageSceneReader1& in_;
    Output& out_;
    Places places_;
    Xml head_{1}, textures_{1}, materials_{1}, lights_{1}, shapes_{1};
    std::set<std::string> reported_, ids_;
    std::map<std::string, std::string> texture_ids_; // by what distinguishes them
    std::map<std::string, std::string> cut_outs_, groups_;
    std::map<RestageHandle, std::string> material_ids_, mesh_files_;
};

} // namespace restage::mitsuba_out
