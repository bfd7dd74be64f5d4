// @LABEL@: writes the triangles of a scene as text, after the manner of Wavefront's OBJ, in world space.
// <restage/scene_io.h> states the requirements of an exporter; `restage check` tests them.
#include <restage/scene_io.h>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

namespace {

// The options: one widget each in the editor, --set NAME=VALUE on the command line.
constexpr RestageParam options[] = {
    RESTAGE_BOOL_PARAM("hidden", "Hidden objects", 0, 0, "Hidden objects are written, too."),
};

// The values of the table, in its order; all are present.
struct Options {
    bool hidden;

    explicit Options(const RestageValue* values) : hidden(RESTAGE_AT(RestageValue, values, 0).i != 0) {}
};

class Writing {
  public:
    Writing(std::ostream& file, const RestageSceneReader1& in, Options options)
        : file_(file), in_(in), options_(options) {}

    bool run() {
        const uint32_t count = in_.count(in_.ctx, RESTAGE_KIND_INSTANCE);
        for (RestageHandle handle = 1; handle <= count; ++handle) {
            RestageInstance instance{};
            if (!in_.instance(in_.ctx, handle, &instance)) continue; // a hole: it was removed
            if (options_.hidden || !(instance.flags & RESTAGE_INSTANCE_HIDDEN)) object(instance);
            // 0 means: stop.
            if (!in_.progress(in_.ctx, float(handle) / float(count), "writing")) return false;
        }
        const uint32_t lights = in_.count(in_.ctx, RESTAGE_KIND_LIGHT);
        if (lights > 0) // what the format cannot hold is reported, not dropped silently
            in_.report(in_.ctx, RESTAGE_DROPPED, (std::to_string(lights) + " lights").c_str(), "the format has none");
        return true;
    }

  private:
    void object(const RestageInstance& instance) {
        RestageMesh mesh{};
        if (!in_.mesh(in_.ctx, instance.mesh, &mesh)) return;
        file_ << "o " << line_of(instance.name) << '\n';
        for (uint32_t i = 0; i < mesh.vertex_count; ++i)
            vertex(mesh.positions + 3 * size_t(i), instance.object_to_world);
        for (uint32_t i = 0; i < mesh.triangle_count; ++i) {
            file_ << 'f';
            for (int corner = 0; corner < 3; ++corner)
                file_ << ' ' << first_ + mesh.indices[3 * size_t(i) + corner];
            file_ << '\n';
        }
        first_ += mesh.vertex_count;
    }

    void vertex(const float* p, const double* m) { // m: columns
        file_ << 'v';
        for (int row = 0; row < 3; ++row)
            number(m[row] * p[0] + m[row + 4] * p[1] + m[row + 8] * p[2] + m[row + 12]);
        file_ << '\n';
    }

    // The shortest text that reads back as the same float, in every locale.
    void number(double x) {
        char text[32];
        file_ << ' ' << std::string_view(text, size_t(std::to_chars(text, text + sizeof text, float(x)).ptr - text));
    }

    static std::string line_of(std::string name) { // a name may contain anything
        for (char& c : name)
            if (c == '\n' || c == '\r') c = ' ';
        return name;
    }

    std::ostream& file_;
    const RestageSceneReader1& in_;
    const Options options_;
    uint64_t first_ = 1; // vertices count from 1, through the whole file
};

// Writes to a temporary file first: an existing file stays until the new one is complete.
bool write(const std::filesystem::path& path, const RestageSceneReader1& in, Options options) {
    std::filesystem::path part = path;
    part += ".part";
    std::ofstream file(part, std::ios::binary);
    std::error_code code;
    bool done = file.is_open() && Writing(file, in, options).run();
    file.close();
    if (done && file) std::filesystem::rename(part, path, code);
    if (!file || code) {
        const std::string why = code ? code.message() : std::strerror(errno);
        in.error(in.ctx, path.string().c_str(), ("cannot be written: " + why).c_str());
        done = false;
    }
    if (!done) std::filesystem::remove(part, code);
    return done;
}

int save(const char* path, const RestageSceneReader1* in, const RestageValue* values, uint32_t) {
    try {
        return write(std::u8string(path, path + std::strlen(path)), *in, Options(values));
    } catch (const std::exception& e) { // none may leave the plugin
        in->error(in->ctx, path, e.what());
        return 0;
    }
}

constexpr RestageExporter1 exporter{
    .format = "@NAME@",
    .label = "@LABEL@",
    .extensions = "@NAME@", // several: "one|two"
    .options = options,
    .option_count = RESTAGE_COUNT(options),
    .save = save,
};

} // namespace

RESTAGE_PLUGIN("@ID@", "0.1.0", {RESTAGE_EXPORTER1, &exporter})
