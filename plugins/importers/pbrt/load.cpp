// SPDX-License-Identifier: Apache-2.0
#include "load.hpp"

#include "builder.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <new>

namespace restage::pbrt {

int probe(const char* path, const void* head, std::size_t head_size) {
    if (!path) return 0;
    std::string name = path;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (name.ends_with(".pbrt")) return 100;
    if (name.ends_with(".pbrt.gz")) return 100;
    if (!head) return 0;
    // Any other extension: count the directives that start a line.
    const std::string_view text(static_cast<const char*>(head), head_size);
    if (text.find('\0') != text.npos) return 0;
    int found = 0;
    for (const char* word : {"WorldBegin", "Film \"", "Camera \"", "Integrator \"", "Sampler \"", "LookAt ",
                             "AttributeBegin", "PixelFilter \"", "Shape \"", "MakeNamedMaterial \""}) {
        const auto at = text.find(word);
        if (at != text.npos && (at == 0 || std::strchr("\n\r \t", text[at - 1]))) ++found;
    }
    return std::min(found * 20, 80);
}

int load(const char* path, const RestageSceneWriter1* out) {
    if (!path || !out) return 0;
    Sources sources;
    std::optional<Import> import;
    try {
        std::error_code code;
        std::filesystem::path full = std::filesystem::weakly_canonical(path, code);
        if (code) full = path;
        std::string reason;
        auto bytes = FileBytes::open(full, reason);
        if (!bytes) {
            out->error(out->ctx, path, 0, 0, ("the scene file cannot be read: " + reason).c_str());
            return 0;
        }
        sources.add(full.string(), std::move(*bytes));
        const std::filesystem::path folder = full.parent_path();
        const auto goes_on = [&] { return out->progress(out->ctx, 0, "parsing") != 0; };
        auto scene = parse(sources, folder, goes_on);
        if (!scene) return 0;
        std::string evidence;
        const Version version = detect_version(*scene, sources, evidence);
        import.emplace(*out, sources, folder, version);
        import->kept({}, version == Version::v3 ? "read as pbrt-v3" : "read as pbrt-v4", evidence);
        Builder builder(*import);
        const bool done = builder.run(*scene);
        import->flush_report();
        return done ? 1 : 0;
    } catch (const ImportError& error) {
        if (import) import->flush_report();
        out->error(out->ctx, sources.name(error.at.file).c_str(), error.at.line, error.at.column,
                   error.message.c_str());
    } catch (const std::bad_alloc&) {
        out->error(out->ctx, path, 0, 0, "out of memory while reading the scene; close other programs or simplify it");
    } catch (const std::exception& error) {
        out->error(out->ctx, path, 0, 0,
                   (std::string("the importer failed (a bug, please report it): ") + error.what()).c_str());
    }
    return 0;
}

} // namespace restage::pbrt
