// SPDX-License-Identifier: Apache-2.0
#include "exporter.hpp"

#include "common/text.hpp"

namespace restage::mitsuba_out {

void Exporter::report(RestageFate fate, const std::string& what, const std::string& note) {
    if (reported_.insert(std::to_string(fate) + what + '\n' + note).second)
        in_.report(in_.ctx, fate, what.c_str(), note.c_str());
}

void Exporter::report_kept(const RestageOrigin& origin, const std::string& what) {
    for (const std::string& line : lines(origin.verbatim))
        dropped(what, line + " of " + origin.format + " has no meaning in Mitsuba");
}

// Mitsuba reserves '.' and a '_' at the beginning, and takes '$' for a parameter.
std::string Exporter::unique_id(const char* kind, const std::string& name) {
    std::string base = kind;
    if (!name.empty()) base += "-" + name;
    for (char& c : base) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
        if (!plain) c = '_';
    }
    std::string id = base;
    for (unsigned i = 2; !ids_.insert(id).second; ++i)
        id = base + "_" + std::to_string(i);
    return id;
}

bool Exporter::run(const std::string& scene_name) {
    const auto go_on = [&](float done, const char* what) { return in_.progress(in_.ctx, done, what) != 0; };
    if (!go_on(0, "settings")) return false;
    integrator();
    sensor();
    environment();
    for (RestageHandle h = 1; h <= in_.count(in_.ctx, RESTAGE_KIND_LIGHT); ++h)
        light(h);
    if (!go_on(0.1f, "shapes") || !shapes()) return false; // with the materials and textures that they use
    if (!go_on(0.9f, "writing")) return false;
    std::string text =
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<!-- written by Restage -->\n<scene version=\"3.0.0\">\n";
    for (const Xml* part : {&head_, &textures_, &materials_, &lights_, &shapes_})
        text += part->text();
    out_.write(scene_name, text + "</scene>\n");
    return true;
}

} // namespace restage::mitsuba_out
