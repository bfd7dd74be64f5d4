// SPDX-License-Identifier: Apache-2.0
// Steps for the GLSL as text and as code: it compiles, its names are prefixed, and its cost.
#include "check/steps.hpp"

#include "base/file.hpp"
#include "render/material_composer.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <set>

namespace restage::check {

namespace fs = std::filesystem;

namespace {

bool has_glsl(const Subject& s) { return s.table().has_code(); }
const char* const no_glsl = "has no GLSL";

double seconds_since(std::chrono::steady_clock::time_point t) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - t).count();
}

Result<gpu::Spirv> compile(Subject& s, render::ColorMode color = render::ColorMode::rgb) {
    render::MaterialType type;
    type.type = s.table().type;
    type.plugin = {&s.table(), s.folder};
    RESTAGE_TRY(const gpu::ShaderCompiler* const compiler, s.compiler());
    return compiler->compile(render::compose_material(type, "check_lab.glsl", gpu::ShaderStage::compute, color));
}

struct Definition {
    std::string name;
    std::size_t line;
};

// Comments become spaces; line numbers are kept.
std::string without_comments(const std::string& text) {
    std::string out = text;
    for (std::size_t i = 0; i + 1 < out.size(); ++i) {
        const bool line = out.compare(i, 2, "//") == 0, block = out.compare(i, 2, "/*") == 0;
        if (!line && !block) continue;
        std::size_t end = line ? out.find('\n', i) : out.find("*/", i + 2);
        end = end == std::string::npos ? out.size() : end + (line ? 0 : 2);
        for (; i < end; ++i)
            if (out[i] != '\n') out[i] = ' ';
        --i;
    }
    return out;
}

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

std::string last_word(std::string_view text) {
    std::size_t end = text.size();
    while (end > 0 && !is_word(text[end - 1]))
        --end;
    std::size_t begin = end;
    while (begin > 0 && is_word(text[begin - 1]))
        --begin;
    return std::string(text.substr(begin, end - begin));
}

// What a file defines outside of braces: functions, structs, constants, macros. `forbidden` receives lines that declare
// what is reserved for the host.
std::vector<Definition> definitions(const std::string& source, std::vector<Definition>& forbidden) {
    const std::string text = without_comments(source);
    std::vector<Definition> found;
    std::string statement;
    std::size_t line = 1, begun = 1;
    int depth = 0;
    const auto take = [&](bool body) {
        const std::string first = statement.substr(0, statement.find_first_of(" \t\n("));
        for (const char* word : {"layout", "uniform", "buffer", "shared", "in", "out"})
            if (first == word) forbidden.push_back({first, begun});
        const std::size_t paren = statement.find('('), equals = statement.find('=');
        if (first == "struct")
            found.push_back({last_word(statement), begun});
        else if (paren != std::string::npos && paren < equals)
            found.push_back({last_word(std::string_view(statement).substr(0, paren)), begun});
        else if (equals != std::string::npos || body)
            found.push_back({last_word(std::string_view(statement).substr(0, statement.find_first_of("=["))), begun});
        else if (!first.empty() && first != "precision")
            found.push_back({last_word(statement.substr(0, statement.find('['))), begun});
        statement.clear();
    };
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '\n') ++line;
        if (c == '#' && depth == 0 && statement.empty()) { // a directive, with continued lines
            std::size_t end = i;
            do
                end = text.find('\n', end + 1);
            while (end != std::string::npos && text[end - 1] == '\\');
            const std::string directive = text.substr(i, end == std::string::npos ? end : end - i);
            if (const std::size_t at = directive.find("define"); at < 4) { // not npos
                const std::size_t name = directive.find_first_not_of(" \t", at + 6);
                std::size_t stop = name;
                while (stop < directive.size() && is_word(directive[stop]))
                    ++stop;
                if (name != std::string::npos) found.push_back({directive.substr(name, stop - name), line});
            }
            line += static_cast<std::size_t>(std::count(directive.begin(), directive.end(), '\n'));
            if (end == std::string::npos) break;
            i = end - 1;
        } else if (c == '{') {
            if (depth++ == 0) {
                // An initialiser's braces belong to their statement.
                const std::size_t equals = statement.find('=');
                if (equals == std::string::npos || statement.substr(0, equals).find('(') != std::string::npos)
                    take(true);
            }
        } else if (c == '}') {
            depth = std::max(0, depth - 1);
        } else if (depth == 0 && c == ';') {
            if (!statement.empty()) take(false);
        } else if (depth == 0 && (!statement.empty() || !std::isspace(static_cast<unsigned char>(c)))) {
            if (statement.empty()) begun = line;
            statement += c;
        }
    }
    return found;
}

} // namespace

Result<StepResult> check_glsl(Subject& s) {
    if (!has_glsl(s)) return StepResult::skip(no_glsl);
    const auto start = std::chrono::steady_clock::now();
    RESTAGE_TRY(const gpu::Spirv spirv, compile(s));
    const double seconds = seconds_since(start);
    if (const auto spectral = compile(s, render::ColorMode::spectral); !spectral)
        return StepResult::failed(spectral.error().message +
                                  "\nin spectral mode, where a colour has four components: write "
                                  "Spectrum, not vec3 or .rgb (restage/v1/spectrum.glsl)");
    return StepResult::passed({{"compile time", seconds * 1000, "ms"},
                               {"code", static_cast<double>(spirv.words.size() * 4), "bytes of SPIR-V"}});
}

Result<StepResult> check_names(Subject& s) {
    if (!has_glsl(s)) return StepResult::skip(no_glsl);
    RESTAGE_TRY(const gpu::Spirv spirv, compile(s));
    return check_names_in(s, spirv, s.table().prefix, s.table().glsl_file);
}

Result<StepResult> check_names_in(const Subject& s, const gpu::Spirv& spirv, const std::string& of,
                                  const std::string& glsl_file) {
    const std::string prefix = of + "_";
    std::size_t count = 0;
    std::error_code code;
    const fs::path folder = fs::weakly_canonical(s.folder, code);
    const fs::path main = fs::weakly_canonical(s.folder / glsl_file, code);
    std::set<fs::path> files{main};
    for (const fs::path& file : spirv.files) { // its own, not the library's
        const fs::path path = fs::weakly_canonical(file, code);
        if (path.parent_path() == main.parent_path() || path.parent_path() == folder) files.insert(path);
    }
    for (const fs::path& file : files) {
        RESTAGE_TRY(const std::string text, read_file(file));
        std::vector<Definition> forbidden;
        const auto found = definitions(text, forbidden);
        const std::string name = file.filename().string();
        for (const Definition& d : forbidden)
            return StepResult::failed(
                fmt::format("{}:{}: declares \"{}\": a plugin may not have bindings, buffers or "
                            "shared memory; its parameters arrive in {}Params",
                            name, d.line, d.name, prefix));
        for (const Definition& d : found)
            if (!d.name.starts_with(prefix))
                return StepResult::failed(fmt::format("{}:{}: \"{}\" does not start with the plugin's prefix \"{}\"",
                                                      name, d.line, d.name, prefix));
        count += found.size();
    }
    return StepResult::passed({{"names", static_cast<double>(count)}});
}

Result<StepResult> check_cost(Subject& s) {
    if (!has_glsl(s)) return StepResult::skip(no_glsl);
    RESTAGE_TRY(BsdfLab* const lab, s.lab());
    const auto first = std::chrono::steady_clock::now();
    RESTAGE_TRY(auto cold, lab->draw({}, {0.6f, 0, 0.8f}, s.options.seed, 64));
    const double cold_seconds = seconds_since(first);
    constexpr std::size_t draws = 1 << 17;
    const auto start = std::chrono::steady_clock::now();
    RESTAGE_TRY(auto warm, lab->draw({}, {0.6f, 0, 0.8f}, s.options.seed, draws));
    const double draw_seconds = seconds_since(start);
    const std::vector<Vec3> up(draws, {0, 0.6f, 0.8f});
    const auto begin = std::chrono::steady_clock::now();
    RESTAGE_TRY(auto looked, lab->look({}, {0.6f, 0, 0.8f}, up));
    return StepResult::passed({{"first dispatch", cold_seconds, "s"},
                               {"sample", 1e9 * draw_seconds / draws, "ns"},
                               {"eval and pdf", 1e9 * seconds_since(begin) / draws, "ns"}});
}

} // namespace restage::check
