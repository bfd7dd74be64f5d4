// SPDX-License-Identifier: Apache-2.0
// A scene writer that keeps what the pbrt importer pushes, for its tests.
#pragma once

#include "load.hpp"
#include "temporary_folder.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace restage::pbrt::test {

struct Value {
    std::uint32_t type = 0, ref = 0;
    std::array<float, 4> v{};
    std::string text;
};
using ValueMap = std::map<std::string, Value>;

struct MeshRecord {
    std::string name, source_file, primitive;
    std::vector<float> positions, normals, uvs;
    std::vector<std::uint32_t> indices;
};
struct Named {
    std::string name, type, verbatim, path;
    ValueMap values;
    std::uint32_t image = 0, encoding = 0;
    float gamma = 0;
    bool is_float = false;
};
struct InstanceRecord {
    std::string name, verbatim;
    RestageInstance raw{};
};
struct ReportLine {
    int fate;
    std::string file;
    std::uint32_t line;
    std::string what, note;
};

class Recorder {
  public:
    std::vector<MeshRecord> meshes;
    std::vector<Named> images, textures, materials, media, groups, lights, cameras;
    std::vector<RestageMedium> raw_media;
    std::vector<InstanceRecord> instances;
    std::vector<RestageLight> raw_lights;
    std::vector<RestageCamera> raw_cameras;
    std::vector<RestageEnvironment> environments;
    RestageHandle camera_medium = 0;
    RestageFilm film{};
    std::string film_filter, film_name, settings_text;
    RestageSettings settings{};
    std::vector<ReportLine> lines;
    struct {
        bool set = false;
        std::string file, message;
        std::uint32_t line = 0, column = 0;
    } error;
    int progress_calls = 0, stop_after = -1;

    RestageSceneWriter1 table();
    int load_file(const std::string& path) {
        RestageSceneWriter1 writer = table();
        return restage::pbrt::load(path.c_str(), &writer);
    }
    // Writes `text` into a new folder and loads it.
    int load_text(const std::string& text, const std::string& name = "scene.pbrt");
    std::string all_reports() const {
        std::string out;
        for (const ReportLine& line : lines)
            out +=
                std::to_string(line.fate) + " " + std::to_string(line.line) + " " + line.what + ": " + line.note + "\n";
        return out;
    }
    bool reports(const std::string& part) const { return all_reports().find(part) != std::string::npos; }
};

// A folder that is removed after the test.
class Folder {
  public:
    std::string file(const std::string& name, const std::string& bytes) const;
    const std::filesystem::path& path() const { return folder_.path(); }

  private:
    restage::test::TemporaryFolder folder_;
};

} // namespace restage::pbrt::test
