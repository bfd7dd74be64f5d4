// SPDX-License-Identifier: Apache-2.0
// One export: the host's reader, the options, and the output so far. Each kind of thing has its own file
// (write_*.cpp). Same scene, same bytes: nothing here depends on addresses, time or the order of hash tables.
#pragma once

#include "common/matrix.hpp"
#include "common/output.hpp"
#include "common/picture.hpp"
#include "common/places.hpp"
#include "common/values.hpp"
#include "text.hpp"

#include <restage/scene_io.h>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace restage::pbrt_out {

using namespace exporters;

enum class Version { v3, v4 };

struct Options {
    Version version = Version::v4;
    Files textures = Files::copy;
    bool write_meshes = true; // false: refer to a mesh's original PLY, if it still exists
};

// The id of the line that keeps a whole light with a picture: its value, then the directive.
inline constexpr std::string_view whole_light = "whole";

// The kept lines of an imported thing, sorted. Lines of another version are unusable.
struct Kept {
    std::vector<std::string> lines;                // written back as they are
    std::map<std::string, std::string> for_values; // replaces that value
    std::vector<std::string> whole;                // replaces everything
    std::vector<std::string> foreign;              // of another format: comments
};

// A kept line of one version in the other's syntax; "" = it affects sampling only, so nothing is lost; nullopt = the
// other has no equivalent.
std::optional<std::string> in_other_words(const std::string& line, bool to_v3);

class Exporter {
  public:
    Exporter(const RestageSceneReader1& reader, Options options, Output& output)
        : in_(reader), options_(options), out_(output) {}
    bool run(const std::string& scene_name); // false = stopped by the user

  private:
    bool v3() const { return options_.version == Version::v3; }
    const char* format() const { return v3() ? "pbrt-v3" : "pbrt-v4"; }
    std::string point(const char* name) const { return (v3() ? "point " : "point3 ") + std::string(name); }

    void report(RestageFate fate, const std::string& what, const std::string& note);
    void approximated(const std::string& what, const std::string& note) { report(RESTAGE_APPROXIMATED, what, note); }
    void dropped(const std::string& what, const std::string& note) { report(RESTAGE_DROPPED, what, note); }
    Kept kept(const RestageOrigin& text, const std::string& what);
    void comment(const std::vector<std::string>& lines, const char* indent = "");
    std::string unique_name(const char* kind, const std::string& name);
    // The name of an unedited thing that a missing Include may define: it is referenced, not written. "" = any other.
    std::string extern_name(const char* kind, const Kept& kept);
    void flag(Params& params, const char* name, bool value) const; // v3 writes "true", v4 true

    // write_head.cpp: camera, film, filter, sampler, integrator, options
    void head();
    void camera(RestageHandle, bool active);
    void film(const Kept& settings, double shutter_time);
    void filter(const Kept& settings);
    void sampler_and_integrator(const Kept& settings);
    double shutter_time() const;

    // A light's colour before it became RGB, if unedited since; else false.
    bool put_exact(Params&, const Kept&, const char* id, const float (&value)[3], const std::string& what);
    std::string finished(Params&, const std::string& what); // as text, with the files it names in place
    void tell_missing(const std::string& what, const std::string& file); // once

    // write_textures.cpp
    std::string image_file(RestageHandle image);
    // Writes it and its dependencies first, as a scalar or a colour (default: as declared); its name, "" =
    // impossible.
    std::string texture(RestageHandle, std::optional<bool> as_float = {});
    // The Transform of a texture in space, the imported one if the values still agree with it; "" = none.
    std::string placing(const Values&, const std::string& imported, const std::string& what);
    void put_argument(Params&, const Values&, const char* id, const char* name, bool is_float, float otherwise);
    void put_image_texture(Params&, const RestageTexture&, const Values&, const std::string& what);
    void put_mapping(Params&, const Values&, const std::string& what);
    bool put_procedural(Params&, const RestageTexture&, const Values&, const std::string& what, std::string& type);
    void put_scale_texture(Params&, const RestageTexture&, const Values&, const std::string& what);
    std::array<float, 3> average(RestageHandle texture) const { return exporters::average(in_, texture); }

    // write_materials*.cpp
    std::string material(RestageHandle);
    void put_float(Params&, const Values&, const char* id, const char* name, float otherwise);
    void put_color(Params&, const Values&, const char* id, const char* name, std::array<float, 3> otherwise,
                   bool albedo = true);
    void put_roughness(Params&, const Values&, const std::string& what, const char* u_id, const char* v_id,
                       const char* u_name, const char* v_name, bool zero_is_smooth, float otherwise = 0);
    void put_common(Params&, const Values&, const std::string& what);
    void put_for_plugin(const std::string& name, const RestageMaterialDesc&);
    std::string material_v4(Params&, const RestageMaterialDesc&, const Values&, const std::string& what); // pbrt's type
    std::string material_v3(Params&, const RestageMaterialDesc&, const Values&, const std::string& what);

    // write_world.cpp
    std::string medium(RestageHandle);
    void lights();
    void light(RestageHandle);
    void environment();
    // Its picture in the other mapping, times a colour; "" if there are no pixels.
    std::string environment_file(const RestageEnvironment&, const std::array<float, 3>& tint);
    std::string own_picture(const OwnPicture&, const std::string& name); // its file

    // write_picture_lights.cpp: goniometric and projection
    struct PictureLight;
    bool picture_light(const RestageLight&, const std::string& what, std::string& type, Params&);
    void goniometric(PictureLight&, std::string& type, Params&);
    void projection(PictureLight&, Params&);
    RestageHandle picture_named(const std::string& file);

    // write_shapes.cpp
    struct Placement { // one Shape in the file, or one ObjectInstance
        RestageHandle instance = 0;
        std::string object;
    };
    void shapes();
    void plan_objects();
    void write_object(const std::string& name, const std::vector<RestageHandle>& members);
    void write_instance(RestageHandle, const char* indent, const double* relative_to);
    void report_alpha(const RestageInstance&, const std::string& type);
    std::vector<std::string> missing_lines(const RestageMesh&, const RestageInstance&, const Kept&);
    std::vector<std::string> shape_lines(RestageHandle mesh, const RestageInstance&, const Kept&);
    std::string shape_line(const std::string& type, Params&, const RestageInstance&, const Kept&);
    std::string ply_file(RestageHandle mesh, const RestageMesh&);
    void transform(const double m[16], const char* indent);
    std::vector<std::string> group_path(RestageHandle group);
    void groups_of_nothing(); // so that reading restores them

    // What pbrt cannot express, in comments that the importer reads (see its build_names.cpp).
    void mark(const char* indent, const char* key, const std::vector<std::string>& strings);
    void only_for_us(std::size_t start); // turns the text written since `start` into lines `#restage ...`

    const RestageSceneReader1& in_;
    const Options options_;
    Output& out_;
    Places places_{out_, options_.textures};
    std::string text_;
    std::set<std::string> reported_, told_missing_;
    bool lossy_ = false; // something was approximated or dropped since it was set to false
    std::map<std::string, std::set<std::string>> names_; // by kind
    std::map<RestageHandle, std::string> materials_, media_, meshes_, images_;
    std::map<std::pair<RestageHandle, bool>, std::string> textures_; // by kind: whether it is a scalar
    std::set<std::pair<RestageHandle, bool>> writing_; // begun
    std::map<RestageHandle, unsigned> mesh_uses_; // Shape lines that will name it
    std::map<RestageHandle, std::string> group_names_;
    std::set<RestageHandle> written_groups_;
    std::set<RestageHandle> told_mirrored_; // meshes with mirrored normal maps
    std::map<RestageHandle, std::vector<RestageHandle>> members_; // by group
    std::map<RestageHandle, std::string> object_of_; // by group: the object it is an instance of
    std::map<std::string, std::vector<RestageHandle>> objects_; // members, of the first group
    std::map<RestageHandle, std::string> object_of_instance_; // ungrouped instances that share everything
};

} // namespace restage::pbrt_out
