// SPDX-License-Identifier: Apache-2.0
// Instances. Shared things are written once: identical groups become instances of one object, and so
// do single instances of one mesh and material. Emitters are written one by one: pbrt does not instance them.
#include "exporter.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace restage::pbrt_out {

namespace {

constexpr std::string_view missing = "missing "; // the prefix of a placeholder's primitive (scene/placeholder.hpp)
bool is_missing(const RestageMesh& mesh) { return std::string_view(mesh.primitive).starts_with(missing); }

constexpr std::uint32_t most_inline_triangles = 100;

// Everything but the transform; equal = may share an object.
std::string signature(const RestageInstance& i) {
    std::string key = std::to_string(i.mesh) + " " + std::to_string(i.material) + " " +
                      std::to_string(i.alpha_texture) + " " + number(i.alpha) + " " + std::to_string(i.flags);
    if (i.has_medium_interface) key += " " + std::to_string(i.interior) + "|" + std::to_string(i.exterior);
    return key + " " + i.origin->format + i.origin->verbatim;
}

bool shareable(const RestageInstance& i) { return !(i.flags & (RESTAGE_INSTANCE_EMITS | RESTAGE_INSTANCE_HIDDEN)); }

std::string mesh_name_of(const std::string& file) { // as in the importer
    std::string stem = std::filesystem::path(file).stem().string();
    if (stem.ends_with(".ply")) stem.resize(stem.size() - 4);
    return stem;
}

bool close(const std::array<double, 16>& a, const std::array<double, 16>& b) {
    double size = 0, difference = 0;
    for (std::size_t i = 0; i < 16; ++i) {
        size = std::max(size, std::abs(a[i]));
        difference = std::max(difference, std::abs(a[i] - b[i]));
    }
    return difference <= 1e-12 * std::max(size, 1.0);
}

} // namespace

void Exporter::transform(const double m[16], const char* indent) {
    if (is_identity(m)) return;
    std::string line = std::string(indent) + "Transform [";
    for (int i = 0; i < 16; ++i)
        line += " " + number(m[i]);
    text_ += line + " ]\n";
}

void Exporter::plan_objects() {
    std::set<RestageHandle> unfit;
    const std::uint32_t instances = in_.count(in_.ctx, RESTAGE_KIND_INSTANCE),
                        groups = in_.count(in_.ctx, RESTAGE_KIND_GROUP);
    RestageInstance i{};
    for (RestageHandle h = 1; h <= instances; ++h)
        if (in_.instance(in_.ctx, h, &i) && i.group) {
            members_[i.group].push_back(h);
            if (!shareable(i)) unfit.insert(i.group);
        }
    // pbrt's objects are one level deep: a group of groups is written only as comments.
    for (RestageHandle g = 1; g <= groups; ++g)
        if (RestageGroup group{}; in_.group(in_.ctx, g, &group)) {
            group_names_[g] = unique_name("group", group.name);
            if (group.parent) unfit.insert(group.parent);
        }

    // Groups: the same things at the same places relative to the first.
    struct Made {
        std::string name;
        std::vector<std::array<double, 16>> relative;
    };
    std::map<std::string, std::vector<Made>> made; // by contents
    for (const auto& [group, handles] : members_) {
        if (unfit.count(group)) continue;
        std::string key;
        std::vector<std::array<double, 16>> relative;
        RestageInstance first{};
        in_.instance(in_.ctx, handles[0], &first);
        const auto from_first = inverse(first.object_to_world);
        if (!from_first) continue;
        for (const RestageHandle h : handles) {
            in_.instance(in_.ctx, h, &i);
            key += signature(i) + "\n";
            relative.push_back(multiply(from_first->data(), i.object_to_world));
        }
        auto& alike = made[key];
        const auto same = std::find_if(alike.begin(), alike.end(), [&](const Made& m) {
            return std::equal(m.relative.begin(), m.relative.end(), relative.begin(), relative.end(), close);
        });
        if (same != alike.end()) {
            object_of_[group] = same->name;
            continue;
        }
        RestageGroup g{};
        in_.group(in_.ctx, group, &g);
        const std::string name = unique_name("object", g.name);
        alike.push_back({name, std::move(relative)});
        objects_[name] = handles;
        object_of_[group] = name;
    }

    // Single instances that differ only in their transform.
    std::map<std::string, std::vector<RestageHandle>> alone;
    for (RestageHandle h = 1; h <= instances; ++h)
        if (in_.instance(in_.ctx, h, &i) && shareable(i) && !object_of_.count(i.group))
            if (RestageMesh mesh{}; in_.mesh(in_.ctx, i.mesh, &mesh) &&
                                    (!*mesh.primitive || std::strchr(mesh.primitive, '\n')) &&
                                    inverse(i.object_to_world))
                alone[signature(i)].push_back(h);
    std::map<RestageHandle, const std::vector<RestageHandle>*> in_order; // of the first of each
    for (const auto& [key, handles] : alone)
        if (handles.size() > 1) in_order[handles[0]] = &handles;
    for (const auto& [first, handles] : in_order) {
        in_.instance(in_.ctx, first, &i);
        const std::string name = unique_name("object", i.name);
        objects_[name] = {first};
        for (const RestageHandle h : *handles)
            object_of_instance_[h] = name;
    }
}

// Outermost first; stops at a cycle.
std::vector<std::string> Exporter::group_path(RestageHandle group) {
    std::vector<std::string> path;
    for (RestageGroup g{}; group && in_.group(in_.ctx, group, &g) && path.size() < 100; group = g.parent) {
        path.insert(path.begin(), group_names_[group]);
        written_groups_.insert(group);
    }
    return path;
}

void Exporter::groups_of_nothing() {
    for (const auto& [group, name] : group_names_)
        if (!written_groups_.count(group)) {
            text_ += "\nAttributeBegin\n";
            mark("    ", "group", group_path(group));
            text_ += "AttributeEnd\n";
        }
}

void Exporter::shapes() {
    plan_objects();
    const std::uint32_t instances = in_.count(in_.ctx, RESTAGE_KIND_INSTANCE);
    RestageInstance i{};
    std::map<RestageHandle, std::string> first_of; // instance -> object to write before it
    for (const auto& [name, handles] : objects_) {
        first_of[handles[0]] = name;
        for (const RestageHandle h : handles)
            if (in_.instance(in_.ctx, h, &i)) ++mesh_uses_[i.mesh];
    }
    for (RestageHandle h = 1; h <= instances; ++h)
        if (in_.instance(in_.ctx, h, &i) && !object_of_.count(i.group) && !object_of_instance_.count(h))
            ++mesh_uses_[i.mesh];

    std::set<RestageHandle> placed_groups;
    for (RestageHandle h = 1; h <= instances; ++h) {
        if (!in_.instance(in_.ctx, h, &i)) continue;
        if (h % 64 == 0 &&
            !in_.progress(in_.ctx, 0.3f + 0.6f * static_cast<float>(h) / static_cast<float>(instances), "shapes"))
            return;
        if (i.flags & RESTAGE_INSTANCE_HIDDEN) { // it would be visible in pbrt
            text_ += "\n";
            const std::size_t start = text_.size();
            write_instance(h, "", nullptr);
            only_for_us(start);
            continue;
        }
        const auto grouped = object_of_.find(i.group);
        const auto shared = object_of_instance_.find(h);
        if (grouped == object_of_.end() && shared == object_of_instance_.end()) {
            text_ += "\n";
            write_instance(h, "", nullptr);
            continue;
        }
        if (const auto first = first_of.find(h); first != first_of.end())
            write_object(first->second, objects_[first->second]);
        const bool by_group = grouped != object_of_.end();
        if (by_group && !placed_groups.insert(i.group).second) continue; // the group was placed with its first member
        const std::string& object = by_group ? grouped->second : shared->second;
        text_ += "\nAttributeBegin\n";
        if (by_group) {
            RestageGroup group{};
            in_.group(in_.ctx, i.group, &group);
            written_groups_.insert(i.group);
            mark("    ", "name", {group_names_[i.group]});
            if (group.parent) mark("    ", "group", group_path(group.parent));
            const auto names = [&](const std::vector<RestageHandle>& handles) {
                std::vector<std::string> out;
                for (const RestageHandle member : handles)
                    if (RestageInstance m{}; in_.instance(in_.ctx, member, &m)) out.emplace_back(m.name);
                return out;
            };
            if (const auto own = names(members_[i.group]); own != names(objects_[object])) mark("    ", "names", own);
        } else {
            mark("    ", "alone", {i.name});
            if (i.group) mark("    ", "group", group_path(i.group));
        }
        transform(i.object_to_world, "    ");
        text_ += "    ObjectInstance " + quote(object) + "\nAttributeEnd\n";
    }
    groups_of_nothing();
}

void Exporter::write_object(const std::string& name, const std::vector<RestageHandle>& members) {
    RestageInstance first{};
    in_.instance(in_.ctx, members[0], &first);
    text_ += "\nObjectBegin " + quote(name) + "\n";
    for (const RestageHandle h : members)
        write_instance(h, "    ", first.object_to_world);
    text_ += "ObjectEnd\n";
}

// `relative_to`: the place that belongs to the object's instances instead; null = none.
void Exporter::write_instance(RestageHandle handle, const char* indent, const double* relative_to) {
    RestageInstance i{};
    in_.instance(in_.ctx, handle, &i);
    const std::string what = std::string("instance \"") + i.name + "\"", deep = std::string(indent) + "    ";
    const Kept k = kept(*i.origin, what);
    RestageMaterialDesc surface{};
    const bool none = in_.material(in_.ctx, i.material, &surface) && std::string_view(surface.type) == "interface";
    // pbrt-v4's surfaces without a material do not emit, but those of alpha 0 do, which let rays pass as well.
    const bool lamp_of_nothing = !v3() && none && (i.flags & RESTAGE_INSTANCE_EMITS) && !i.has_medium_interface;
    if (lamp_of_nothing) {
        i.alpha = 0;
        i.alpha_texture = 0;
        i.flags = (i.flags | RESTAGE_INSTANCE_EMITS_UNSEEN) & ~std::uint32_t{RESTAGE_INSTANCE_ALPHA_MASK};
        approximated(
            std::string("the light of \"") + i.name + "\"",
            "pbrt-v4's surfaces without a material do not emit: one of alpha 0 is written, which emits, and is "
            "invisible");
    }
    const auto shape_text = shape_lines(i.mesh, i, k); // may write files and textures first
    const bool many = shape_text.size() > 1; // then the name is the block's
    if (many) mark(indent, "name", {i.name});
    RestageMesh mesh{};
    in_.mesh(in_.ctx, i.mesh, &mesh);
    // v3 scopes names to attribute blocks, but names defined by a missing file must be visible outside of its block.
    const bool open = v3() && std::string_view(mesh.primitive).starts_with("missing Include") &&
                      !(i.flags & (RESTAGE_INSTANCE_EMITS | RESTAGE_INSTANCE_REVERSE_ORIENTATION)) &&
                      !i.has_medium_interface && !relative_to;
    const char* block = open ? "Transform" : "Attribute";
    text_ += std::string(indent) + block + "Begin\n";
    if (!many) mark(deep.c_str(), "name", {i.name});
    if (i.group && !relative_to) mark(deep.c_str(), "group", group_path(i.group));
    const auto file = meshes_.find(i.mesh);
    const std::string implied = file == meshes_.end() ? i.name : mesh_name_of(file->second);
    if (mesh.name != implied) mark(deep.c_str(), "mesh", {mesh.name});
    comment(k.foreign, deep.c_str());
    if (i.flags & RESTAGE_INSTANCE_REVERSE_ORIENTATION) text_ += deep + "ReverseOrientation\n";
    if (!relative_to) {
        transform(i.object_to_world, deep.c_str());
    } else if (!std::equal(relative_to, relative_to + 16, i.object_to_world)) {
        transform(multiply(inverse(relative_to)->data(), i.object_to_world).data(), deep.c_str());
    }
    if (i.has_medium_interface)
        text_ += deep + "MediumInterface " + quote(medium(i.interior)) + " " + quote(medium(i.exterior)) + "\n";
    if (i.flags & RESTAGE_INSTANCE_EMITS) {
        if (!v3() && none && !lamp_of_nothing)
            report(RESTAGE_DROPPED, std::string("the light of \"") + i.name + "\"",
                   "pbrt-v4's surfaces without a material do not emit");
        Params light;
        light.add_rgb("L", {i.emission[0], i.emission[1], i.emission[2]});
        if (i.flags & RESTAGE_INSTANCE_EMITS_BY_MATERIAL) { // our importer takes it from the material
            RestageMaterialDesc m{};
            if (in_.material(in_.ctx, i.material, &m)) mark(deep.c_str(), "emission", {m.type});
        } else if (put_exact(light, k, "emission", i.emission, what) && light.has("filename")) {
            light.remove("L");
        }
        if (i.flags & RESTAGE_INSTANCE_TWO_SIDED) flag(light, "twosided", true);
        text_ += deep + "AreaLightSource \"diffuse\" " + finished(light, what) + "\n";
    }
    text_ += deep + (lamp_of_nothing ? "Material \"diffuse\"" : "NamedMaterial " + quote(material(i.material))) + "\n";
    for (const std::string& line : shape_text)
        text_ += deep + line + "\n";
    text_ += std::string(indent) + block + "End\n";
}

std::string Exporter::ply_file(RestageHandle handle, const RestageMesh& mesh) {
    if (const auto it = meshes_.find(handle); it != meshes_.end()) return it->second;
    std::string& file = meshes_[handle];
    std::error_code code;
    const std::filesystem::path source = mesh.source_file;
    const std::string ending = source.filename().string();
    const bool is_ply = ending.ends_with(".ply") || ending.ends_with(".ply.gz");
    if (is_ply && std::filesystem::exists(source, code)) {
        if (const std::string inside = out_.inside(source); !inside.empty())
            return file = inside; // already next to the scene
        if (!options_.write_meshes) {
            file = places_.how() == Files::absolute ? "" : source.lexically_relative(out_.folder()).generic_string();
            return file = file.empty() ? source.generic_string() : file;
        }
    }
    return file = places_.of_mesh(mesh);
}

// Alpha differs between the versions: v3's is a mask, for triangles only, and makes parts of lamps invisible; v4's
// is the fraction of rays stopped, and dims lamps, unless it is 0 everywhere.
void Exporter::report_alpha(const RestageInstance& i, const std::string& type) {
    if (!i.alpha_texture && i.alpha >= 1) return;
    const std::string what = std::string("alpha of \"") + i.name + "\"";
    const bool mask = (i.flags & RESTAGE_INSTANCE_ALPHA_MASK) != 0, whole = !i.alpha_texture && i.alpha > 0;
    const bool lamp = (i.flags & RESTAGE_INSTANCE_EMITS) != 0;
    const bool unseen = (i.flags & RESTAGE_INSTANCE_EMITS_UNSEEN) != 0;
    if (v3()) {
        if (type != "trianglemesh" && type != "plymesh") {
            if (!(mask && whole)) approximated(what, "pbrt-v3 has it for triangles only; this shape is opaque there");
            return;
        }
        if (!mask && (i.alpha_texture || i.alpha > 0)) approximated(what, "in pbrt-v3 any alpha above 0 is opaque");
        if (lamp && !unseen) approximated(what, "pbrt-v3's lamps also emit where alpha makes holes");
        return;
    }
    if (mask && i.alpha_texture)
        approximated(what, "a mask becomes a fraction: pbrt-v4 lets rays pass where alpha is between 0 and 1");
    RestageTexture t{};
    const bool zero = i.alpha_texture ? in_.texture(in_.ctx, i.alpha_texture, &t) &&
                                            std::string_view(t.type) == "constant" && average(i.alpha_texture)[0] <= 0
                                      : i.alpha <= 0;
    if (lamp && unseen && !zero && !(mask && whole))
        approximated(what, "pbrt-v4's lamps do not emit where alpha makes holes");
    if (lamp && !unseen && !i.alpha_texture && i.alpha <= 0)
        approximated(what, "a lamp of alpha 0 emits in pbrt-v4, unseen");
}

// Unreadable things, as they were. Shapes take the instance's properties; Include and ObjectInstance do not.
std::vector<std::string> Exporter::missing_lines(const RestageMesh& mesh, const RestageInstance& i, const Kept& k) {
    const std::string what = std::string("instance \"") + i.name + "\"";
    const bool ours = std::string_view(mesh.origin->format) == format();
    std::vector<std::string> out;
    for (const std::string& line : lines(std::string_view(mesh.primitive).substr(missing.size()))) {
        const KeptLine l = split_directive(line);
        const bool is_shape = l.word == "Shape";
        if (!ours && !(is_shape && l.name == "plymesh") && l.word != "ObjectInstance") {
            dropped(what, std::string("a placeholder of ") + mesh.origin->format + ", written as a comment: " + line);
            out.push_back("# " + line);
            continue;
        }
        if (!is_shape) {
            out.push_back(line);
            continue;
        }
        Params params;
        params.add_raw(l.rest);
        params.retype(v3());
        out.push_back(shape_line(l.name, params, i, k));
    }
    if (out.empty()) dropped(what, std::string("its original cannot be written as ") + format());
    if (*mesh.source_file)
        dropped(what, std::string("its file is missing; its name is written unchanged: ") + mesh.source_file);
    return out;
}

std::string Exporter::shape_line(const std::string& type, Params& params, const RestageInstance& i, const Kept& k) {
    const bool mask = (i.flags & RESTAGE_INSTANCE_ALPHA_MASK) != 0;
    report_alpha(i, type);
    if (i.alpha_texture)
        params.add("texture", "alpha", quote(texture(i.alpha_texture)));
    else if (i.alpha != 1 && !(mask && i.alpha > 0 && !v3()))
        params.add_float("alpha", i.alpha);
    for (const std::string& line : k.lines)
        params.add_raw(line);
    params.retype(v3());
    return "Shape " + quote(type) + " " + params.text();
}

std::vector<std::string> Exporter::shape_lines(RestageHandle handle, const RestageInstance& i, const Kept& k) {
    RestageMesh mesh{};
    if (!in_.mesh(in_.ctx, handle, &mesh))
        throw ExportError("", std::string("instance \"") + i.name + "\" has no mesh");
    if (is_missing(mesh)) return missing_lines(mesh, i, k);
    const auto finish = [&](const std::string& type, Params& params) { return shape_line(type, params, i, k); };
    std::vector<std::string> out; // the shapes that the triangles represent: one, or many curves
    for (const std::string& primitive : lines(mesh.primitive)) {
        const std::size_t space = std::min(primitive.find(' '), primitive.size());
        const std::string type = primitive.substr(0, space);
        const std::set<std::string> only_v3{"cone",        "paraboloid",   "hyperboloid",
                                            "heightfield", "heightfield2", "nurbs"};
        if (v3() ? type == "bilinearmesh" : only_v3.count(type) > 0) break; // as triangles
        Params params;
        params.add_raw(std::string_view(primitive).substr(space));
        params.retype(v3());
        out.push_back(finish(type, params));
    }
    if (!out.empty()) return out;
    if (mesh.tangents && told_mirrored_.insert(handle).second) {
        std::size_t mirrored = 0;
        for (std::uint32_t t = 0; t < mesh.triangle_count; ++t)
            mirrored += mesh.tangents[4 * std::size_t{mesh.indices[3 * std::size_t{t}]} + 3] < 0;
        if (mirrored > 0)
            approximated(std::string("mesh \"") + mesh.name + "\"",
                         "texture coordinates of " + std::to_string(mirrored) + " of its " +
                             std::to_string(mesh.triangle_count) +
                             " triangles are mirrored; pbrt turns a normal map's y over there, as it has no tangents");
    }
    Params params;
    std::string type = "plymesh";
    if (mesh.triangle_count <= most_inline_triangles && mesh_uses_[handle] <= 1) {
        type = "trianglemesh";
        const auto list = [](const auto* values, std::size_t count) {
            std::string text;
            for (std::size_t n = 0; n < count; ++n) {
                if (n > 0) text += ' ';
                if constexpr (std::is_same_v<decltype(*values), const float&>)
                    text += number(values[n]);
                else
                    text += std::to_string(values[n]);
            }
            return text;
        };
        const std::size_t vertices = mesh.vertex_count;
        params.add("integer", "indices", list(mesh.indices, std::size_t{mesh.triangle_count} * 3));
        params.add(v3() ? "point" : "point3", "P", list(mesh.positions, 3 * vertices));
        if (mesh.normals) params.add("normal", "N", list(mesh.normals, 3 * vertices));
        if (mesh.uvs) params.add(v3() ? "float" : "point2", "uv", list(mesh.uvs, 2 * vertices));
    } else {
        params.add_string("filename", ply_file(handle, mesh));
    }
    return {finish(type, params)};
}

} // namespace restage::pbrt_out
