// SPDX-License-Identifier: Apache-2.0
// The effect of each directive on the graphics state, and dispatch to the functions that build things. The stack of
// states is in build_scopes.cpp.
#include "builder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace restage::pbrt {

namespace {

std::optional<ColorSpace> color_space_named(const std::string& name) {
    static const std::map<std::string, ColorSpace> names = {{"srgb", ColorSpace::srgb},
                                                            {"dci-p3", ColorSpace::dci_p3},
                                                            {"rec2020", ColorSpace::rec2020},
                                                            {"aces2065-1", ColorSpace::aces2065_1}};
    const auto found = names.find(name);
    return found == names.end() ? std::nullopt : std::optional(found->second);
}

} // namespace

bool Builder::run(SceneFile& scene) {
    for (const Slip& slip : scene.slips) {
        if (slip.only_v3 && !import_.v3()) throw ImportError{slip.at, slip.what + ": " + slip.note};
        import_.warned(slip.at, slip.what, slip.note);
    }
    files_are_missing_ = scene.has_missing_file;
    for (const Directive& directive : scene.directives) {
        if (import_.v3()) break; // v4 looks names up when the file has been read
        if (directive.verb == Verb::make_named_material &&
            (!directive.params.has("plugin") || is_for_plugin(directive)))
            later_materials_.emplace(directive.name, &directive);
        if (directive.verb == Verb::object_begin) later_objects_.insert(directive.name);
        if (directive.verb == Verb::make_named_medium) later_media_.emplace(directive.name, &directive);
        if (directive.verb == Verb::texture)
            later_textures_.emplace(std::pair(directive.name, directive.second == "float"), &directive);
    }
    for (const Directive& directive : scene.directives)
        if (directive.verb == Verb::film) film_ = &directive; // a camera before it may use its size
    std::size_t done = 0;
    for (Directive& directive : scene.directives) {
        ++done;
        if (done % 16 == 0 &&
            !import_.out.progress(import_.out.ctx,
                                  static_cast<float>(done) / static_cast<float>(scene.directives.size()), "reading"))
            return false;
        directive.params.lenient = import_.v3();
        directive.params.keep_last();
        for (Param& param : directive.params.params)
            param.color_space = state_.color_space;
        if (directive.verb != Verb::shape && directive.verb != Verb::film)
            import_.make_files_absolute(directive.params, // pictures are the host's to read
                                        directive.verb != Verb::texture && directive.verb != Verb::light_source);
        step(directive);
        if (directive.verb == Verb::shape) directive.params = {}; // no longer needed: the host has its copy
    }
    finish(scene);
    return true;
}

void Builder::finish(const SceneFile& scene) {
    if (!scene.has_world_begin)
        throw ImportError{scene.end,
                          "there is no WorldBegin: this file is not a whole scene; open the file that includes it" +
                              std::string(scene.has_missing_file ? ", or find the files that it includes" : "")};
    for (; import_.v3() && !stack_.empty(); stack_.pop_back()) { // api.cpp, pbrtWorldEnd
        const Directive& opened = *stack_.back().opened;
        import_.warned(opened.at, opened.word, "is not closed; it is at the end of the file");
        if (opened.verb == Verb::object_begin) end_object();
    }
    if (!stack_.empty()) {
        const Directive& opened = *stack_.back().opened;
        throw ImportError{scene.end, "the file ends inside the " + opened.word + " of line " +
                                         std::to_string(opened.at.line) + "; close it or restore the rest of the file"};
    }
    if (import_.v3() && !scene.has_world_end)
        import_.warned(scene.end, "WorldEnd", "missing; the file may have been cut short");
    flush_curves();
    later_objects_.clear();
    for (Late& late : std::exchange(late_instances_, {})) {
        state_ = std::move(late.state);
        next_ = std::move(late.next);
        object_instance(*late.directive);
    }
    film_and_settings();
    flush_environment();
}

// A missing Include or Import. Before WorldBegin it can only contain settings; after it, it keeps its
// place.
void Builder::missing_file(const Directive& d) {
    import_.lost(d.at, d.word + " " + quote(d.name), d.third + ": " + d.second + "; its place is kept");
    const std::string line = d.word + " " + quote(d.name);
    if (world_)
        placeholder(d, std::filesystem::path(d.name).filename().string(), line, d.second);
    else
        option_lines_ += line + "\n";
}

bool Builder::in_world(const Directive& directive) {
    if (world_) return true;
    if (import_.v3()) { // VERIFY_WORLD of api.cpp
        import_.lost(directive.at, directive.word, "it must come after WorldBegin; left out, as pbrt does");
        return false;
    }
    throw ImportError{directive.at, directive.word + " must come after WorldBegin"};
}

// As in_world, for directives that v4 here also allows before WorldBegin.
bool Builder::in_world_v3(const Directive& d) { return !import_.v3() || d.ours || in_world(d); }

const Matrix& Builder::ctm(const Directive& directive) {
    if (!(state_.ctm[0] == state_.ctm[1]))
        import_.approximated(directive.at, directive.word + " in motion",
                             "stands still where it is when the shutter opens; its motion is not written back");
    return state_.ctm[0];
}

Names& Builder::writable_names() {
    // v3: copied if an enclosing block shares it. v4: there is only one.
    if (import_.v3() && state_.names.use_count() > 1) state_.names = std::make_shared<Names>(*state_.names);
    return *state_.names;
}

void Builder::add_attributes(Directive& directive, const char* target) {
    const auto found = state_.attributes.find(target);
    if (found == state_.attributes.end()) return;
    // In front, so that the directive's own parameters win.
    auto& own = directive.params.params;
    own.insert(own.begin(), found->second.params.begin(), found->second.params.end());
    directive.params.keep_last();
}

void Builder::option_step(Directive& d) {
    if (world_ && d.verb != Verb::option && import_.v3()) { // VERIFY_OPTIONS of api.cpp
        import_.lost(d.at, d.word, "it must come before WorldBegin; left out, as pbrt does");
        return;
    }
    if (world_ && d.verb != Verb::option)
        throw ImportError{d.at, d.word + " must come before WorldBegin; move it there"};
    switch (d.verb) {
        case Verb::film:
            film_ = &d;
            break;
        case Verb::pixel_filter:
            filter_ = &d;
            break;
        case Verb::sampler:
            sampler_ = &d;
            break;
        case Verb::integrator:
            integrator_ = &d;
            break;
        case Verb::camera:
            if (d.ours) { // an additional, inactive one
                camera(d);
                break;
            }
            camera_ = &d;
            coordinate_systems_["camera"] = {inverse(state_.ctm[0]).value_or(Matrix{}),
                                             inverse(state_.ctm[1]).value_or(Matrix{})};
            camera_exterior_ = state_.exterior;
            camera(d);
            break;
        case Verb::option:
            option_lines_ += "Option " + quote(d.name) + " " + d.second + "\n";
            if (d.second == "true" && (d.name.ends_with("forcediffuse") || d.name.ends_with("disablepixeljitter") ||
                                       d.name.ends_with("disabletexturefiltering")))
                import_.approximated(d.at, "Option " + quote(d.name), "it is not followed; written back as it is");
            else
                import_.kept(d.at, "Option " + quote(d.name), "pbrt's own; written back as it is");
            break;
        default: // Accelerator, TransformTimes: no effect on the picture
            if (d.verb == Verb::accelerator && !pbrt_has(d.verb, d.name, import_.v3())) {
                import_.warned(d.at, "Accelerator " + quote(d.name), "pbrt has none of that name; left out");
                break;
            }
            option_lines_ += d.word;
            if (!d.name.empty()) option_lines_ += " " + quote(d.name);
            for (const double value : d.numbers)
                option_lines_ += " " + shortest(value);
            if (!d.params.params.empty()) option_lines_ += " " + to_text(d.params, " ");
            option_lines_ += "\n";
    }
}

void Builder::step(Directive& d) {
    read_comments(d);
    switch (d.verb) {
        case Verb::identity:
        case Verb::translate:
        case Verb::scale:
        case Verb::rotate:
        case Verb::look_at:
        case Verb::transform:
        case Verb::concat_transform:
            transform_step(d);
            break;
        case Verb::coordinate_system:
            coordinate_systems_[d.name] = {state_.ctm[0], state_.ctm[1]};
            break;
        case Verb::coord_sys_transform:
            if (const auto found = coordinate_systems_.find(d.name); found != coordinate_systems_.end()) {
                state_.ctm[0] = found->second[0];
                state_.ctm[1] = found->second[1];
            } else {
                import_.warned(d.at, "CoordSysTransform " + quote(d.name),
                               "no CoordinateSystem has that name; left out, as pbrt does");
            }
            break;
        case Verb::active_transform:
            state_.active = d.name == "All" ? 3 : d.name == "StartTime" ? 1 : 2;
            break;
        case Verb::reverse_orientation:
            if (!in_world_v3(d)) break;
            state_.reverse_orientation = !state_.reverse_orientation;
            break;
        case Verb::color_space:
            if (const auto space = color_space_named(d.name))
                state_.color_space = *space;
            else
                import_.warned(d.at, "ColorSpace " + quote(d.name),
                               "pbrt knows srgb, dci-p3, rec2020, aces2065-1; the previous one stays");
            break;
        case Verb::attribute:
            if (d.name != "shape" && d.name != "light" && d.name != "material" && d.name != "medium" &&
                d.name != "texture")
                import_.warned(d.at, "Attribute " + quote(d.name),
                               "pbrt has attributes of shape, light, material, medium and texture only, and stops");
            for (Param& param : d.params.params) {
                param.from_attribute = true;
                state_.attributes[d.name].params.push_back(param);
            }
            break;
        case Verb::accelerator:
        case Verb::camera:
        case Verb::film:
        case Verb::integrator:
        case Verb::option:
        case Verb::pixel_filter:
        case Verb::sampler:
        case Verb::transform_times:
            option_step(d);
            break;
        case Verb::missing_file:
            missing_file(d);
            break;
        case Verb::ignored:
            import_.dropped(d.at, d.word + " " + quote(d.name), "of pbrt-v1 and v2; nothing replaces it");
            break;
        case Verb::world_begin:
            if (world_ && import_.v3()) {
                import_.warned(d.at, "WorldBegin", "a second one; left out, as pbrt does");
                break;
            }
            if (world_) throw ImportError{d.at, "a second WorldBegin; remove it"};
            if (!stack_.empty())
                throw ImportError{d.at, "WorldBegin inside " + stack_.back().opened->word + "; close that first"};
            world_ = true;
            state_.ctm[0] = state_.ctm[1] = Matrix{};
            state_.active = 3;
            coordinate_systems_["world"] = {Matrix{}, Matrix{}};
            break;
        case Verb::world_end:
            break;
        case Verb::attribute_begin:
        case Verb::transform_begin:
        case Verb::import_begin:
            if (d.verb != Verb::import_begin && !in_world_v3(d)) break;
            push(d);
            if (!block_label_.empty()) state_.label = std::exchange(block_label_, {});
            if (!block_name_.empty()) state_.name = std::exchange(block_name_, {});
            break;
        case Verb::attribute_end:
        case Verb::import_end:
            if (d.verb != Verb::import_end && !in_world_v3(d)) break;
            pop(d, false);
            break;
        case Verb::transform_end:
            if (!in_world_v3(d)) break;
            pop(d, import_.v3());
            break;
        case Verb::object_begin:
            if (!in_world(d)) break;
            if (!open_object_.empty() && import_.v3()) { // api.cpp, pbrtObjectBegin: the new one is open now
                import_.warned(d.at, "ObjectBegin " + quote(d.name),
                               "inside an object; what follows is of this one, as in pbrt");
                end_object();
            }
            if (!open_object_.empty())
                throw ImportError{
                    d.at, "ObjectBegin inside an object; close " + quote(open_object_) + " with ObjectEnd first"};
            flush_curves(); // those are of the world
            push(d);
            open_object_ = d.name.empty() ? " " : d.name;
            objects_[open_object_] = {};
            break;
        case Verb::object_end:
            if (!in_world(d)) break;
            if (open_object_.empty() && import_.v3()) { // it still closes the block
                import_.warned(d.at, d.word, "without an ObjectBegin before it");
                if (stack_.empty()) break;
            }
            pop(d, false);
            if (!open_object_.empty()) end_object();
            break;
        case Verb::object_instance:
            object_instance(d);
            break;
        case Verb::medium_interface:
            state_.interior = d.name;
            state_.exterior = d.second;
            break;
        case Verb::make_named_medium:
            if (!import_.v3() && later_media_.erase(d.name) == 0) { // created ahead, or duplicate
                if (made_media_.erase(d.name) == 0)
                    import_.lost(d.at, "medium " + quote(d.name), "that name exists already; the first one counts");
                break;
            }
            add_attributes(d, "medium");
            medium(d);
            break;
        case Verb::texture:
            if (!in_world_v3(d)) break;
            if (later_textures_.erase({d.name, d.second == "float"}) == 0 &&
                made_textures_.erase({d.name, d.second == "float"}) > 0)
                break; // made ahead
            add_attributes(d, "texture");
            texture(d);
            break;
        case Verb::make_named_material: {
            if (!in_world_v3(d)) break;
            add_attributes(d, "material");
            if (d.params.has("plugin")) {
                if (!is_for_plugin(d)) break; // pbrt's own of that name follows
                materials_of_plugins_.insert(d.name);
            } else if (materials_of_plugins_.erase(d.name) > 0) {
                break;
            }
            if (later_materials_.erase(d.name) == 0 && !import_.v3() && state_.names->materials.count(d.name)) {
                if (made_materials_.erase(d.name) == 0)
                    import_.lost(d.at, "material " + quote(d.name), "that name exists already; the first one counts");
                break; // made ahead
            }
            if (import_.v3() && state_.names->materials.count(d.name))
                import_.warned(d.at, "material " + quote(d.name), "is defined again; from here on this one counts");
            if (import_.v3() && !d.params.has("type") && !d.params.has("plugin"))
                import_.warned(d.at, "material " + quote(d.name),
                               "it has no \"string type\"; it is a null surface, as in pbrt");
            const RestageHandle handle = material(d, d.name, d.params.string("type", ""));
            writable_names().materials[d.name] = handle;
            writable_names().material_sources[d.name] = &d;
            break;
        }
        case Verb::named_material:
            if (!in_world_v3(d)) break;
            if (import_.v3() && !state_.names->materials.count(d.name) && !files_are_missing_) {
                import_.warned(d.at, "NamedMaterial " + quote(d.name),
                               "no material has that name; the previous one stays");
                break;
            }
            state_.material = named_material(d, d.name);
            if (const auto source = state_.names->material_sources.find(d.name);
                source != state_.names->material_sources.end())
                state_.material_from = source->second;
            else
                state_.material_from = nullptr;
            break;
        case Verb::material:
            if (!in_world(d)) break;
            add_attributes(d, "material");
            state_.material = material(d, "", d.name);
            state_.material_from = &d;
            break;
        case Verb::area_light_source:
            if (!in_world(d)) break;
            add_attributes(d, "light");
            state_.area_light = d.name.empty() || d.name == "none" || next_.material_shines ? nullptr : &d;
            break;
        case Verb::light_source:
            if (!in_world(d)) break;
            add_attributes(d, "light");
            light(d);
            break;
        case Verb::shape:
            if (!in_world(d)) break;
            add_attributes(d, "shape");
            shape(d);
            break;
    }
}

} // namespace restage::pbrt
