// SPDX-License-Identifier: Apache-2.0
// Shared by all parts of an import: the host's writer, the report, the version's conventions, file lookup, and colours.
// Independent of directives.
#pragma once

#include "directives.hpp"
#include "spectrum.hpp"
#include "transform.hpp"

#include <restage/scene_io.h>
#include <deque>
#include <map>
#include <set>

namespace restage::pbrt {

// Parameter values on their way to the host. Ids and enum texts are literals.
class Values {
  public:
    void number(const char* id, double value);
    void integer(const char* id, int value);
    void boolean(const char* id, bool value);
    void color(const char* id, Rgb value);
    void choice(const char* id, const char* value);
    void table(const char* id, std::string path);
    void texture(const char* id, RestageType type, RestageHandle handle);
    void material(const char* id, RestageHandle handle);
    const RestageValue* data() const { return values_.data(); }
    std::uint32_t size() const { return static_cast<std::uint32_t>(values_.size()); }

  private:
    std::vector<RestageValue> values_;
    std::deque<std::string> paths_; // that values point to
};

enum class Role { albedo, unbounded, light };

class Import {
  public:
    Import(const RestageSceneWriter1& writer, Sources& all_sources, std::filesystem::path main_folder, Version detected)
        : out(writer), sources(all_sources), version(detected), folder_(std::move(main_folder)) {}

    const RestageSceneWriter1& out;
    Sources& sources;
    const Version version;
    bool v3() const { return version == Version::v3; }
    const char* format() const { return v3() ? "pbrt-v3" : "pbrt-v4"; }

    // A line of the report. Lines that repeat a note about the same kind of thing are folded into the first.
    void report(RestageFate fate, Location at, std::string what, std::string note);
    // The file is at fault, and pbrt would warn and continue (or stop, if a file it names is missing): `warned`:
    // something else replaces it; `lost`: nothing does.
    void warned(Location at, std::string what, std::string note) {
        report(RESTAGE_APPROXIMATED, at, std::move(what), std::move(note));
    }
    void lost(Location at, std::string what, std::string note) {
        report(RESTAGE_DROPPED, at, std::move(what), std::move(note));
    }
    void kept(Location at, std::string what, std::string note) { report(RESTAGE_KEPT, at, what, note); }
    void approximated(Location at, std::string what, std::string note) { report(RESTAGE_APPROXIMATED, at, what, note); }
    void dropped(Location at, std::string what, std::string note) { report(RESTAGE_DROPPED, at, what, note); }
    void flush_report();

    // Unused parameters, and values of the wrong kind: reported, and returned as verbatim lines. `quiet`: except
    // those that only pbrt understands.
    std::string keep_unused(const ParamList& params, const std::string& what, bool quiet = false);

    // Resolves a path: relative to the main file, else to the file that names it. Absolute; may not exist.
    std::filesystem::path resolve(const std::string& name, Location at) const;

    // Makes existing files' paths absolute: verbatim lines are written elsewhere. `tell`: also lists the files as read.
    void make_files_absolute(ParamList& params, bool tell);

    // A colour parameter in linear sRGB. nullopt: absent, a texture, or unreadable (reported).
    std::optional<Rgb> color(const ParamList& params, std::string_view name, Role role);
    Rgb color(const ParamList& params, std::string_view name, Role role, Rgb otherwise) {
        return color(params, name, role).value_or(otherwise);
    }
    // The spectrum of a parameter of type "spectrum"; nullopt if it is of another type, absent or unreadable.
    std::optional<Spectrum> spectrum(const ParamList& params, std::string_view name);
    // What a parameter gives as a spectrum, a temperature or a glass; nullopt if it is RGB. Reports nothing new.
    std::optional<Spectrum> given_spectrum(const ParamList& params, std::string_view name);

    // Of this format. `lines`: kept verbatim, except "=id text", the value `id` before it was reduced, and
    // "=* text", a line of the original thing. Lives as long as this.
    const RestageOrigin* origin(const std::string& lines = "");

  private:
    std::optional<Spectrum> spectrum(const Param& param);
    void mend_pairs(Location at, const std::string& what, std::vector<double>& numbers);
    std::optional<Spectrum> read_spectrum(const std::string& name, Location at);
    Rgb limited(Rgb color, const Param& param, Role role);

    struct OriginLines {
        std::string verbatim;
        std::deque<std::string> strings;
        std::vector<RestageOriginValue> values;
        RestageOrigin given;
    };
    std::map<std::string, OriginLines> origins_; // by their source lines

    struct Line {
        RestageFate fate;
        Location at;
        std::string what, note;
        std::size_t count = 1;
    };
    std::deque<Line> lines_;
    std::map<std::string, Line*> folded_;
    std::map<std::string, std::optional<Spectrum>> spectra_; // by path
    std::set<std::string> told_; // files listed as read
    std::filesystem::path folder_;
};

} // namespace restage::pbrt
