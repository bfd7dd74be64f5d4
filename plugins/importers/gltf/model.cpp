// SPDX-License-Identifier: Apache-2.0
#include "model.hpp"

#include "common/file.hpp"
#include "common/json_depth.hpp"
#include "common/report.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

namespace restage::gltf {

namespace fs = std::filesystem;

namespace {

bool is_picture(const std::string& path) {
    for (const char* extension : {"png", "jpg", "jpeg", "webp", "ktx2", "ktx", "dds", "gif", "bmp", "tga", "basis"})
        if (has_extension(path.c_str(), extension)) return true;
    return false;
}

// The name in the scene file, and the length, of a buffer in a separate file; by tinygltf's name for it.
struct BufferFiles {
    struct Buffer {
        fs::path path;
        std::size_t length = 0;
    };
    fs::path folder;
    std::map<std::string, Buffer> by_name;

    // tinygltf puts the folder, or the current one, before the name.
    const Buffer* find(const std::string& path) const {
        const std::string before = folder.string() + "/";
        const auto it = by_name.find(path.starts_with(before) ? path.substr(before.size()) : path);
        return it == by_name.end() ? nullptr : &it->second;
    }
};

// Decodes URIs as tinygltf does, so that its queries map to the right file.
std::string tinygltf_name(const std::string& uri) {
    std::string plus = uri;
    std::replace(plus.begin(), plus.end(), '+', ' ');
    std::string result;
    const auto digit = [](unsigned char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : 0;
    };
    for (std::size_t i = 0; i < plus.size(); ++i) {
        if (plus[i] != '%' || plus.size() <= i + 2) {
            result += plus[i];
            continue;
        }
        result += static_cast<char>(digit(static_cast<unsigned char>(plus[i + 1])) << 4 |
                                    digit(static_cast<unsigned char>(plus[i + 2])));
        i += 2;
    }
    return result;
}

// Only the buffers of the JSON; everything else is skipped.
BufferFiles buffer_files(const fs::path& folder, std::string_view text) {
    BufferFiles files;
    files.folder = folder;
    using Event = nlohmann::json::parse_event_t;
    const auto keep = [](int depth, Event event, nlohmann::json& parsed) {
        return !(depth == 1 && event == Event::key && parsed != "buffers");
    };
    const nlohmann::json root = nlohmann::json::parse(text, keep, false);
    if (!root.is_object() || !root.contains("buffers") || !root["buffers"].is_array()) return files;
    for (const auto& buffer : root["buffers"]) {
        if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
        const auto uri = buffer["uri"].get<std::string>();
        if (uri.starts_with("data:")) continue;
        const bool sized = buffer.contains("byteLength") && buffer["byteLength"].is_number_unsigned();
        files.by_name[tinygltf_name(uri)] = {find_named(folder, uri),
                                             sized ? buffer["byteLength"].get<std::size_t>() : 0};
    }
    return files;
}

// tinygltf's file access: buffers are read here, pictures are hidden. A buffer may be longer than declared
// (glTF 2.0, 3.6.1.1); the excess is cut, as tinygltf does not allow it.
tinygltf::FsCallbacks file_access(BufferFiles& files) {
    return {.FileExists =
                [](const std::string& path, void* user) {
                    const auto& own = *static_cast<const BufferFiles*>(user);
                    const auto* buffer = own.find(path);
                    std::error_code code;
                    return buffer && !is_picture(path) && fs::is_regular_file(buffer->path, code);
                },
            .ExpandFilePath = [](const std::string& path, void*) { return path; },
            .ReadWholeFile =
                [](std::vector<unsigned char>* bytes, std::string* error, const std::string& path, void* user) {
                    const auto& own = *static_cast<const BufferFiles*>(user);
                    const auto* buffer = own.find(path);
                    std::string reason = "the file names no such buffer";
                    const auto read = buffer ? read_file(buffer->path, reason) : std::nullopt;
                    if (read) {
                        const std::size_t size = buffer->length ? std::min(buffer->length, read->size()) : read->size();
                        bytes->assign(read->begin(), read->begin() + static_cast<std::ptrdiff_t>(size));
                    }
                    if (!read && error) *error += path + ": " + reason;
                    return read.has_value();
                },
            .WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                                 void*) { return false; },
            .user_data = &files};
}

// Pictures in data URIs are kept as they are; those in buffer views are looked up later, with checks missing here.
bool keep_picture(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
    if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

// "parse error at line 3, column 5: ..." of the JSON reader.
[[noreturn]] void fail(std::string message, bool binary) {
    std::uint32_t line = 0, column = 0;
    int end = 0;
    if (const auto place = message.find("at line "); !binary && place != message.npos) {
        if (std::sscanf(message.c_str() + place, "at line %u, column %u: %n", &line, &column, &end) == 2 && end > 0)
            message.erase(0, place + static_cast<std::size_t>(end));
        else
            line = column = 0;
    }
    while (!message.empty() && std::strchr("\n\r ", message.back()))
        message.pop_back();
    std::replace(message.begin(), message.end(), '\n', ' ');
    throw ImportError{message.empty() ? "the file cannot be parsed" : message, line, column, {}};
}

void check_header(std::string_view bytes) { // of a GLB: magic, version, length, then chunks of length, type, data
    const auto word = [&](std::size_t at) {
        std::uint32_t value = 0; // little-endian, like the supported machines
        std::memcpy(&value, bytes.data() + at, 4);
        return value;
    };
    if (bytes.size() < 20) throw ImportError{"byte " + std::to_string(bytes.size()) + ": the GLB header ends early"};
    if (word(4) != 2)
        throw ImportError{"byte 4: this is GLB version " + std::to_string(word(4)) + "; version 2 is read"};
    if (word(8) > bytes.size())
        throw ImportError{"byte 8: the file is cut: " + std::to_string(word(8)) + " bytes declared, " +
                          std::to_string(bytes.size()) + " found"};
    std::size_t at = 12;
    while (at + 8 <= bytes.size() && at < word(8)) {
        if (word(at) > bytes.size() - at - 8)
            throw ImportError{"byte " + std::to_string(at) + ": a chunk of " + std::to_string(word(at)) +
                              " bytes reaches past the end of the file"};
        at += 8 + word(at);
    }
}

// The first chunk of a GLB with a valid header.
std::string_view json_of(std::string_view bytes) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    return bytes.substr(20, length);
}

// tinygltf converts JSON to its own values recursively. Of a GLB only the first chunk is JSON.
void check_depth(std::string_view bytes, bool binary) {
    constexpr std::size_t most = 256; // glTF's own depth is about 10; extensions and extras add theirs
    const std::string_view json = binary ? json_of(bytes) : bytes;
    const auto at = too_deep_json(json, most);
    if (!at) return;
    const std::string what = "JSON nested more than " + std::to_string(most) + " deep is not read";
    if (binary) throw ImportError{"byte " + std::to_string(20 + *at) + ": " + what};
    const std::string_view before = json.substr(0, *at);
    const std::size_t line = before.rfind('\n');
    throw ImportError{what, static_cast<std::uint32_t>(1 + std::count(before.begin(), before.end(), '\n')),
                      static_cast<std::uint32_t>(before.size() - (line == before.npos ? 0 : line + 1) + 1)};
}

} // namespace

std::string decode_uri(std::string_view uri) {
    std::string result;
    const auto digit = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
            result += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
            i += 2;
        } else {
            result += uri[i];
        }
    }
    return result;
}

fs::path find_named(const fs::path& folder, const std::string& uri) {
    std::error_code code;
    const fs::path decoded = find_file(folder, decode_uri(uri));
    if (fs::exists(decoded, code)) return decoded;
    const fs::path raw = find_file(folder, uri);
    return fs::exists(raw, code) ? raw : decoded;
}

tinygltf::Model parse_model(const fs::path& path, std::string_view bytes, const RestageSceneWriter1& out) {
    if (!out.progress(out.ctx, 0.02f, "reading the scene")) throw Cancelled{};
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(keep_picture, nullptr);
    tinygltf::Model model;
    std::string errors, warnings;
    const std::string folder = path.parent_path().string();
    if (bytes.size() > 0xffffffffu) throw ImportError{"the file is larger than 4 GiB, which glTF does not allow"};
    const bool binary = bytes.starts_with("glTF");
    if (binary) check_header(bytes);
    if (bytes.find_first_not_of(" \t\r\n") == bytes.npos) throw ImportError{"the file is empty"};
    check_depth(bytes, binary);
    BufferFiles files = buffer_files(path.parent_path(), binary ? json_of(bytes) : bytes);
    reader.SetFsCallbacks(file_access(files));
    const auto size = static_cast<unsigned>(bytes.size());
    const bool read =
        binary
            ? reader.LoadBinaryFromMemory(&model, &errors, &warnings,
                                          reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
            : reader.LoadASCIIFromString(&model, &errors, &warnings,
                                         bytes.data(), // NOLINT(bugprone-suspicious-stringview-data-usage): with size
                                         size, folder);
    for (const std::string& name : model.extensionsRequired) // reported even if it made the rest unreadable
        if (name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression")
            throw ImportError{"its geometry is compressed (" + name +
                              "), which is not read; save it without compression"};
    if (!read) fail(errors, binary);
    if (!model.asset.version.empty() && model.asset.version[0] != '2')
        throw ImportError{"this is glTF " + model.asset.version + "; version 2 is read: convert it"};
    const std::string& least = model.asset.minVersion; // glTF 2.0, 3.2
    if (!least.empty() && least != "2.0" && least != "2")
        throw ImportError{"it is for programs that read glTF " + least + " (asset.minVersion); version 2.0 is read"};
    for (const auto& [name, buffer] : files.by_name)
        tell_file_read(out, buffer.path.string());
    return model;
}

} // namespace restage::gltf
