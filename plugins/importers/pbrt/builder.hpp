// SPDX-License-Identifier: Apache-2.0
// Walks the directives with pbrt's graphics state and pushes the scene to the host. Each kind of thing has its own file
// (build_*.cpp).
#pragma once

#include "curves.hpp"

#include <set>

namespace restage::pbrt {

// Names visible at a point of the file. v3 scopes them to attribute blocks, v4 has one space for all.
struct Names {
    std::map<std::string, RestageHandle> float_textures, color_textures, materials;
    std::map<std::string, const Directive*> material_sources;
};

struct State { // pbrt's graphics state
    Matrix ctm[2]; // at the start and end of the shutter
    unsigned active = 3;
    bool reverse_orientation = false;
    RestageHandle material = 0; // 0 = the default, created when first needed
    const Directive* material_from = nullptr; // its directive; v3: shapes may override its parameters
    RestageHandle group = 0; // of comments `# group: ...`
    std::string label, name; // words before the block; names of its contents, from `# name:`
    const Directive* area_light = nullptr;
    std::string interior, exterior;
    ColorSpace color_space = ColorSpace::srgb;
    std::map<std::string, ParamList> attributes; // of directive Attribute: "shape", "light", ...
    std::shared_ptr<Names> names = std::make_shared<Names>();
};

// A scalar or colour argument: a texture or a constant.
struct Argument {
    RestageHandle texture = 0;
    Rgb value;
};

// Numbered by a program ("mesh_00012"), so that a material's name says more.
bool is_generic_name(std::string_view name);

class Builder {
  public:
    explicit Builder(Import& import) : import_(import) {}
    // 1 = done, 0 = the user stopped it. Throws ImportError.
    bool run(SceneFile& scene);

  private:
    // builder.cpp
    void step(Directive& directive);
    void option_step(Directive& directive);
    void finish(const SceneFile& scene);
    void add_attributes(Directive& directive, const char* target);
    Names& writable_names();
    const Matrix& ctm(const Directive& directive); // at shutter opening; motion is reported
    bool in_world(const Directive& directive); // v3: false if it must be left out
    bool in_world_v3(const Directive& directive);
    void missing_file(const Directive& directive);

    // build_scopes.cpp
    void push(const Directive& directive);
    void pop(const Directive& directive, bool only_transform);
    void pop_v3(const Directive& directive); // an End that does not fit its Begin
    void transform_step(const Directive& directive);

    // build_names.cpp
    void read_comments(const Directive& directive);
    RestageHandle group_at(const std::vector<std::string>& path);
    std::string take_name(std::initializer_list<std::string_view> best_first);
    std::string shape_name(const Directive& directive, const std::string& file_stem);

    // build_textures.cpp
    void texture(const Directive& directive);
    // A file that is missing is reported; `keep_missing`: its name is kept, so that it can be relinked later.
    RestageHandle image(const Directive& directive, const std::string& file, RestageEncoding encoding, float gamma,
                        bool keep_missing);
    RestageHandle image_texture(const Directive& directive, const char* what);
    RestageHandle simple_texture(const Directive& d, bool is_float);
    Argument float_argument(const Directive& directive, const char* name, double otherwise);
    Argument color_argument(const Directive& directive, const char* name, Role role, Rgb otherwise);
    void put_float(Values& values, const char* id, const Directive& d, const char* name, double otherwise);
    void put_color(Values& values, const char* id, const Directive& d, const char* name, Role role, Rgb otherwise);
    void keep_exact(const char* id, const Directive& d, const char* name);
    // For spectral rendering: the spectrum of a value that RGB or a number stand for; see docs/plugins.md.
    void keep_spectrum(const char* id, Rgb value, const std::optional<Spectrum>& spectrum);
    RestageHandle find_texture(const Directive& directive, const char* name, bool is_float);
    std::optional<Rgb> constant_of(RestageHandle texture) const; // of a texture that is one colour everywhere
    RestageHandle scaled_texture(RestageHandle texture, double scale, bool is_float);

    // build_materials*.cpp
    RestageHandle material(const Directive& directive, const std::string& name, const std::string& type,
                           const std::string& label = "");
    RestageHandle material_of_shape(const Directive& shape);
    bool material_v4(const Directive& d, const std::string& type, Values& values, std::string& plugin);
    bool material_v3(const Directive& d, const std::string& type, Values& values, std::string& plugin);
    bool material_of_plugin(const Directive& d, const std::string& type, Values& values, std::string& plugin);
    bool is_rgl(const Directive& d) const; // pbrt-v4's own measured data: another format than MERL's
    bool is_for_plugin(const Directive& d) const; // names one that exists
    Rgb hair_color(const Directive& d);
    std::string subsurface(const Directive& d, const std::string& type, Values& values, std::string& plugin);
    Argument subsurface_reflectance(const Directive& d, const std::string& type, double eta);
    void approximated_material(const Directive& d, const std::string& type, Values& values, std::string& plugin);
    void disney(const Directive& d, Values& values);
    void put_metal(Values& values, const Directive& d, const char* eta, const char* k, const char* eta_id,
                   const char* k_id);
    void put_index(Values& values, const char* id, const Directive& d, const char* name, double otherwise);
    void put_roughness(Values& values, const Directive& d, const std::string& prefix, double otherwise,
                       const char* u_id = "uroughness", const char* v_id = "vroughness");
    void put_common(Values& values, const Directive& d);
    RestageHandle named_material(const Directive& directive, const std::string& name);
    RestageHandle default_material(const Directive& directive);

    // build_shapes.cpp
    void shape(const Directive& directive);
    // Unreadable things are kept: a mesh without triangles that represents these lines, and an instance of it.
    RestageHandle missing_mesh(const std::string& name, const std::string& line, const std::string& file = "");
    void placeholder(const Directive& directive, const std::string& name, const std::string& line,
                     const std::string& file = "");
    RestageHandle mesh(const Directive& directive, const std::string& name, const Mesh*& data);
    RestageHandle ply_mesh(const Directive& directive, const std::string& name, const Mesh*& data);
    // All of an instance except mesh, name and emission.
    RestageInstance instance_of(const Directive& shape, const Matrix& to_world);
    void place(RestageInstance instance, const std::string& name, const std::string& verbatim);
    void curve(const Directive& directive, const Matrix& to_world, const std::string& name,
               const std::string& mesh_name);
    void flush_curves();
    void end_object();
    void object_instance(const Directive& directive);
    std::string emission(const Directive& shape, const Mesh& mesh, RestageInstance& instance);

    // build_lights.cpp, build_camera.cpp, build_media.cpp
    void light(const Directive& directive);
    void infinite_light(const Directive& directive);
    void flush_environment();
    double light_scale(const Directive& d, Rgb& color);
    std::string exact_light(const Directive& d, const char* id, const char* name, const float (&value)[3],
                            double scale);
    void camera(const Directive& directive);
    bool realistic_camera(const Directive& directive, RestageCamera& out);
    void film_and_settings();
    void medium(const Directive& directive);
    void missing_files_of(const Directive& directive, const std::string& what);
    RestageHandle medium_named(const std::string& name, const Directive& directive);

    Import& import_;
    State state_;
    struct Saved {
        State state;
        const Directive* opened;
    };
    std::vector<Saved> stack_;
    std::map<std::string, std::array<Matrix, 2>> coordinate_systems_;
    bool world_ = false;
    const Directive* film_ = nullptr;
    const Directive* filter_ = nullptr;
    const Directive* sampler_ = nullptr;
    const Directive* integrator_ = nullptr;
    const Directive* camera_ = nullptr;
    std::string camera_exterior_;
    std::string option_lines_; // verbatim, of directives that only pbrt understands
    std::map<std::string, const Directive*> later_materials_; // v4: NamedMaterial may come first
    std::set<std::string> materials_of_plugins_; // defined by such a line; pbrt's own of that name is skipped
    std::set<std::string> made_materials_, made_media_; // ahead of their line
    int material_depth_ = 0; // of mixes made ahead
    std::map<std::string, RestageHandle> media_;
    std::map<std::string, const Directive*> later_media_; // v4: MediumInterface may come first
    std::map<std::pair<std::string, bool>, const Directive*> later_textures_; // v4: by name and "is of floats"
    std::set<std::pair<std::string, bool>> made_textures_; // ahead of their line
    int texture_depth_ = 0; // of textures made ahead
    std::map<RestageHandle, double> missing_texels_; // missing images: pbrt-v3's replacement
    bool files_are_missing_ = false; // missing Include and Import: what they define is kept by name
    std::set<RestageHandle> interfaces_; // null surfaces
    std::set<RestageHandle> zero_textures_; // constants of 0: pbrt-v4 has lamps with such an alpha
    std::set<RestageHandle> hair_;

    struct Object {
        std::vector<RestageInstance> instances;
        std::deque<std::string> names;
        bool named_by_itself = false; // its only member has its own name
    };
    std::map<std::string, Object> objects_;

    struct CurveGroup { // becomes one instance
        CurveBatch batch;
        RestageInstance instance;
        Matrix to_world, to_object;
        std::string name, mesh_name, verbatim;
        Location at;
    };
    std::deque<CurveGroup> curves_;
    std::multimap<std::string, CurveGroup*> curves_by_state_;
    std::string open_object_;
    std::map<std::string, RestageHandle> mesh_cache_; // by their source
    std::map<std::string, std::map<std::string, bool>> odd_parameters_; // of those: unused, "and misfit"
    std::map<std::string, Mesh> emitter_meshes_;
    std::map<std::string, RestageHandle> images_, materials_by_content_;
    std::map<std::pair<RestageHandle, double>, RestageHandle> scaled_textures_;
    std::map<RestageHandle, Rgb> constants_; // textures of one colour
    std::string exact_; // "=id parameter" lines: a value before it became RGB
    RestageHandle default_material_ = 0;
    std::map<RestageHandle, std::string> material_names_; // of named ones

    struct Next { // from comments, for the next thing
        std::string name, label, mesh; // label: guessed
        std::vector<std::string> members;
        bool alone = false;
        bool material_shines = false; // an area light written for other programs
    } next_;
    struct Late { // an ObjectInstance before its ObjectBegin
        const Directive* directive;
        State state;
        Next next;
    };
    std::vector<Late> late_instances_;
    std::set<std::string> later_objects_; // v4: all that the file defines
    std::string block_label_, block_name_; // for the block that begins
    bool own_name_ = false; // of the last shape: not after its material or object
    std::map<std::string, RestageHandle> groups_; // by path

    struct PendingEnvironment {
        bool set = false, has_image = false;
        RestageEnvironment value{};
        std::string name, verbatim;
        Location at;
        // As in the file, with their transforms: lights that another one replaces.
        std::vector<std::pair<std::string, std::array<Matrix, 2>>> lines;
        const Directive* from = nullptr;
        bool is_missing = false; // its picture is missing
    } environment_;
    void displace_environment(const std::string& why);
};

} // namespace restage::pbrt
