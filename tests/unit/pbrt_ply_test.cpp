// SPDX-License-Identifier: Apache-2.0
// PLY files: every encoding gives the same mesh; broken ones give a message and never more.
#include "mesh.hpp"
#include "pbrt_writer.hpp"

#include <zlib.h>
#include <bit>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cstring>

using namespace restage::pbrt;
using restage::pbrt::test::Recorder;

namespace {

enum class Form { ascii, little, big };

template <class T>
void put(std::string& out, Form form, T value) {
    if (form == Form::ascii) {
        out += shortest(static_cast<double>(value)) + " ";
        return;
    }
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    const bool swap = (form == Form::big) == (std::endian::native == std::endian::little);
    for (std::size_t i = 0; i < sizeof(T); ++i)
        out += bytes[swap ? sizeof(T) - 1 - i : i];
}

// Two triangles and a quad over five vertices, with normals, uv, and things to skip.
std::string sample(Form form, const std::string& index_name = "vertex_indices") {
    const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    std::string out =
        std::string("ply\nformat ") + names[static_cast<int>(form)] +
        " 1.0\ncomment made by a test\nelement vertex 6\nproperty double x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float "
        "t\n"
        "element extra 2\nproperty list uchar short stuff\n"
        "element face 3\nproperty uchar flags\nproperty list uchar int " +
        index_name + "\nend_header\n";
    for (int i = 0; i < 6; ++i) {
        put(out, form, double(i % 3));
        put(out, form, float(i / 3));
        put(out, form, 0.5f);
        put(out, form, std::uint8_t(7));
        for (const float n : {0.f, 0.f, 1.f})
            put(out, form, n);
        put(out, form, float(i) / 8);
        put(out, form, 0.25f);
        if (form == Form::ascii) out += "\n";
    }
    for (int i = 0; i < 2; ++i) {
        put(out, form, std::uint8_t(i));
        for (int k = 0; k < i; ++k)
            put(out, form, std::int16_t(-5));
    }
    const std::vector<std::vector<int>> faces = {{0, 1, 3}, {1, 4, 3}, {1, 2, 5, 4}};
    for (const auto& face : faces) {
        put(out, form, std::uint8_t(1));
        put(out, form, static_cast<std::uint8_t>(face.size()));
        for (const int v : face)
            put(out, form, v);
        if (form == Form::ascii) out += "\n";
    }
    return out;
}

std::string failure(const std::string& bytes) {
    try {
        read_ply("m.ply", bytes, {});
    } catch (const ImportError& error) {
        return error.message;
    }
    return "";
}

std::string gzip(const std::string& plain) {
    std::string out(plain.size() + 200, '\0');
    z_stream s{};
    REQUIRE(deflateInit2(&s, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY) == Z_OK);
    s.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(plain.data()));
    s.avail_in = static_cast<uInt>(plain.size());
    s.next_out = reinterpret_cast<Bytef*>(out.data());
    s.avail_out = static_cast<uInt>(out.size());
    REQUIRE(deflate(&s, Z_FINISH) == Z_STREAM_END);
    out.resize(s.total_out);
    deflateEnd(&s);
    return out;
}

} // namespace

TEST_CASE("pbrt ply: ascii and both byte orders", "[pbrt]") {
    for (const Form form : {Form::ascii, Form::little, Form::big}) {
        const Mesh mesh = read_ply("m.ply", sample(form, form == Form::big ? "vertex_index" : "vertex_indices"), {});
        CHECK(mesh.vertex_count() == 6);
        CHECK(mesh.positions[3 * 5] == 2.f);
        CHECK(mesh.positions[3 * 5 + 1] == 1.f);
        CHECK(mesh.positions[3 * 5 + 2] == 0.5f);
        CHECK(mesh.normals[2] == 1.f);
        CHECK(mesh.uvs[2 * 5] == 0.625f);
        CHECK(mesh.uvs[2 * 5 + 1] == 0.25f);
        CHECK(mesh.indices == std::vector<std::uint32_t>{0, 1, 3, 1, 4, 3, 1, 2, 5, 1, 5, 4});
        CHECK_FALSE(mesh.has_bent_quads);
    }
}

TEST_CASE("pbrt ply: gzip, one mesh for one file, two instances", "[pbrt]") {
    const test::Folder folder;
    folder.file("m.ply", sample(Form::little));
    folder.file("z.ply.gz", gzip(sample(Form::big)));
    const std::string scene = folder.file("s.pbrt",
                                          "WorldBegin\nShape \"plymesh\" \"string filename\" \"m.ply\"\n"
                                          "Translate 1 0 0 Shape \"plymesh\" \"string filename\" \"m.ply\"\n"
                                          "Shape \"plymesh\" \"string filename\" \"z.ply.gz\"\n");
    Recorder r;
    REQUIRE(r.load_file(scene) == 1);
    REQUIRE(r.meshes.size() == 2);
    REQUIRE(r.instances.size() == 3);
    CHECK(r.instances[0].raw.mesh == r.instances[1].raw.mesh);
    CHECK(r.instances[1].raw.object_to_world[12] == 1);
    CHECK(std::filesystem::path(r.meshes[0].source_file).is_absolute());
    CHECK(r.meshes[1].positions == r.meshes[0].positions);
    CHECK(r.meshes[1].indices == r.meshes[0].indices);
    CHECK(r.meshes[1].name == "z");
}

TEST_CASE("pbrt ply: bent polygons and normals without direction", "[pbrt]") {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";
    Mesh mesh = read_ply("m.ply", head + "0 0 0 0 0 0\n1 0 0 nan 0 0\n1 1 1 0 0 1\n0 1 0 0 0 1\n4 0 1 2 3\n", {});
    CHECK(mesh.has_bent_quads);
    CHECK(repair_normals(mesh) == 2);
    for (std::size_t i = 0; i < 4; ++i) {
        const float* n = mesh.normals.data() + 3 * i;
        CHECK(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] > 0.5f);
        CHECK(n[2] > 0); // up, as the faces
    }
    CHECK(repair_normals(mesh) == 0);
}

TEST_CASE("pbrt ply: broken files", "[pbrt]") {
    using Catch::Matchers::ContainsSubstring;
    const std::string good = sample(Form::little);
    REQUIRE(failure(good).empty());
    CHECK_THAT(failure(""), ContainsSubstring("header"));
    CHECK_THAT(failure("plx\n"), ContainsSubstring("not a PLY"));
    CHECK_THAT(failure("ply\nformat ascii 1.0\n"), ContainsSubstring("header does not end"));
    CHECK_THAT(failure("ply\nformat hex 1.0\nend_header\n"), ContainsSubstring("'hex'"));
    CHECK_THAT(failure("ply\nend_header\n"), ContainsSubstring("no format"));
    CHECK_THAT(failure("ply\nformat ascii 1.0\nend_header\n"), ContainsSubstring("no vertices"));
    CHECK_THAT(failure("ply\nformat ascii 1.0\nelement vertex 99999999999999999999\nend_header\n"),
               ContainsSubstring("not readable"));
    CHECK_THAT(failure("ply\nformat ascii 1.0\nelement vertex -1\nend_header\n"), ContainsSubstring("not readable"));
    CHECK_THAT(failure("ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nend_header\n"),
               ContainsSubstring("unknown type"));
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    for (const char* form : {"ascii", "binary_little_endian"})
        CHECK_THAT(failure(std::string("ply\nformat ") + form + " 1.0\nelement vertex 1000000000\n" + xyz +
                           "end_header\n0 0 0\n"),
                   ContainsSubstring("truncated"));
    const std::string three = "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz;
    const std::string list = "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0\n";
    CHECK(failure(three + list + "3 0 1 2").empty());
    CHECK_THAT(failure(three + list + "3 0 1 3\n"), ContainsSubstring("vertex 3 of 3"));
    CHECK_THAT(failure(three + list + "3 0 1 -2\n"), ContainsSubstring("vertex -2"));
    CHECK_THAT(failure(three + list + "3 0 1 1000000000\n"), ContainsSubstring("vertex 1000000000"));
    CHECK_THAT(failure(three + list + "200 0 1 2\n"), ContainsSubstring("truncated"));
    CHECK_THAT(failure(three + list + "-3 0 1 2\n"), ContainsSubstring("-3 entries"));
    CHECK_THAT(failure(three + list + "3 0 1 x\n"), ContainsSubstring("not a number"));
    CHECK_THAT(
        failure(three + "element face 1\nproperty list uchar int faces\nend_header\n0 0 0 1 0 0 0 1 0\n3 0 1 2\n"),
        ContainsSubstring("vertex_indices"));
    CHECK_THAT(failure(three + "end_header\n0 0 0 1 0 0 nan 1 0\n"), ContainsSubstring("vertex 2 is not finite"));
    CHECK_THAT(failure(three + "end_header\n0 0 0 1 0 0 0 1 0\n"), ContainsSubstring("no faces"));
    // Truncated at each byte: a message or, after the last face, the whole mesh; never a crash.
    for (std::size_t n = 0; n < good.size(); ++n) {
        INFO(n);
        CHECK_FALSE(failure(good.substr(0, n)).empty());
    }
    // Each byte inverted: any result, but no crash.
    for (std::size_t n = 0; n < good.size(); ++n) {
        std::string damaged = good;
        damaged[n] = static_cast<char>(~damaged[n]);
        failure(damaged);
    }
}
