// SPDX-License-Identifier: Apache-2.0
// The grammar of pbrt-v3 and v4 in one table: https://pbrt.org/fileformat-v3, https://pbrt.org/fileformat-v4.
#include "directives.hpp"
#include "lexer.hpp"

#include <algorithm>
#include <unordered_map>

namespace restage::pbrt {

namespace {

enum class Shape { bare, numbers, matrix, name, name_params, texture, medium_interface, option, keyword };

struct Rule {
    Verb verb;
    Shape shape;
    int count = 0; // of numbers
};

const std::unordered_map<std::string_view, Rule>& rules() {
    static const std::unordered_map<std::string_view, Rule> table = {
        {"Accelerator", {Verb::accelerator, Shape::name_params}},
        {"ActiveTransform", {Verb::active_transform, Shape::keyword}},
        {"AreaLightSource", {Verb::area_light_source, Shape::name_params}},
        {"Attribute", {Verb::attribute, Shape::name_params}},
        {"AttributeBegin", {Verb::attribute_begin, Shape::bare}},
        {"AttributeEnd", {Verb::attribute_end, Shape::bare}},
        {"Camera", {Verb::camera, Shape::name_params}},
        {"ColorSpace", {Verb::color_space, Shape::name}},
        {"ConcatTransform", {Verb::concat_transform, Shape::matrix}},
        {"CoordSysTransform", {Verb::coord_sys_transform, Shape::name}},
        {"CoordinateSystem", {Verb::coordinate_system, Shape::name}},
        {"Film", {Verb::film, Shape::name_params}},
        {"Identity", {Verb::identity, Shape::bare}},
        {"Import", {Verb::import_begin, Shape::name}},
        {"Include", {Verb::import_begin, Shape::name}},
        {"Integrator", {Verb::integrator, Shape::name_params}},
        {"LightSource", {Verb::light_source, Shape::name_params}},
        {"LookAt", {Verb::look_at, Shape::numbers, 9}},
        {"MakeNamedMaterial", {Verb::make_named_material, Shape::name_params}},
        {"MakeNamedMedium", {Verb::make_named_medium, Shape::name_params}},
        {"Material", {Verb::material, Shape::name_params}},
        {"MediumInterface", {Verb::medium_interface, Shape::medium_interface}},
        {"NamedMaterial", {Verb::named_material, Shape::name}},
        {"ObjectBegin", {Verb::object_begin, Shape::name}},
        {"ObjectEnd", {Verb::object_end, Shape::bare}},
        {"ObjectInstance", {Verb::object_instance, Shape::name}},
        {"Option", {Verb::option, Shape::option}},
        {"PixelFilter", {Verb::pixel_filter, Shape::name_params}},
        {"ReverseOrientation", {Verb::reverse_orientation, Shape::bare}},
        {"Rotate", {Verb::rotate, Shape::numbers, 4}},
        {"Sampler", {Verb::sampler, Shape::name_params}},
        {"Scale", {Verb::scale, Shape::numbers, 3}},
        {"Shape", {Verb::shape, Shape::name_params}},
        {"SurfaceIntegrator", {Verb::integrator, Shape::name_params}},
        {"Texture", {Verb::texture, Shape::texture}},
        {"Transform", {Verb::transform, Shape::matrix}},
        {"TransformBegin", {Verb::transform_begin, Shape::bare}},
        {"TransformEnd", {Verb::transform_end, Shape::bare}},
        {"TransformTimes", {Verb::transform_times, Shape::numbers, 2}},
        {"Translate", {Verb::translate, Shape::numbers, 3}},
        {"WorldBegin", {Verb::world_begin, Shape::bare}},
        {"WorldEnd", {Verb::world_end, Shape::bare}},
        // pbrt-v1 and v2, still in use.
        {"SearchPath", {Verb::ignored, Shape::name}},
        {"Exterior", {Verb::ignored, Shape::name_params}},
        {"Interior", {Verb::ignored, Shape::name_params}},
        {"Renderer", {Verb::ignored, Shape::name_params}},
        {"Volume", {Verb::ignored, Shape::name_params}},
        {"VolumeIntegrator", {Verb::ignored, Shape::name_params}},
    };
    return table;
}

class Parser {
  public:
    Parser(Sources& sources, std::filesystem::path folder, const std::function<bool()>& goes_on)
        : sources_(sources), folder_(std::move(folder)), goes_on_(goes_on), lexer_(sources) {}

    std::optional<SceneFile> run() {
        lexer_.push(0);
        std::size_t taken = 0;
        while (true) {
            if (++taken % 4096 == 0 && !goes_on_()) return std::nullopt;
            const Token token = lexer_.next();
            if (token.kind == TokenKind::end_of_file) {
                scene_.end = token.at;
                if (!imports_.empty() && imports_.back() == lexer_.depth()) {
                    imports_.pop_back();
                    scene_.directives.push_back({.verb = Verb::import_end, .at = token.at, .word = "end of Import"});
                }
                lexer_.pop();
                if (lexer_.depth() == 0) {
                    for (Slip& slip : lexer_.take_slips())
                        scene_.slips.push_back(std::move(slip));
                    return std::move(scene_);
                }
                continue;
            }
            directive(token);
        }
    }

  private:
    void directive(const Token& token) {
        if (token.kind != TokenKind::word)
            throw ImportError{token.at, std::string("expected a directive such as Shape or AttributeBegin, found ") +
                                            (token.kind == TokenKind::text ? "the string " + quote(token.text)
                                                                           : "'" + std::string(token.text) + "'") +
                                            "; is a quote or bracket before it missing?"};
        const auto found = rules().find(token.text);
        if (found == rules().end()) unknown(token);
        Directive out{.verb = found->second.verb, .at = token.at, .word = std::string(token.text)};
        out.ours = token.ours;
        out.comments = std::exchange(carried_, {});
        for (const std::string_view comment : lexer_.take_comments())
            out.comments.push_back(comment);
        switch (found->second.shape) {
            case Shape::bare:
                break;
            case Shape::numbers:
                out.numbers = numbers(out.word, found->second.count, false);
                break;
            case Shape::matrix:
                out.numbers = numbers(out.word, 16, true);
                break;
            case Shape::name:
                out.name = text(out.word);
                break;
            case Shape::name_params:
                out.name = text(out.word);
                out.params = params();
                break;
            case Shape::texture:
                out.name = text("Texture");
                out.second = text("Texture (value type: \"float\" or \"spectrum\")");
                out.third = text("Texture (class, as \"imagemap\")");
                out.params = params();
                break;
            case Shape::medium_interface:
                out.name = text(out.word);
                out.second = lexer_.peek().kind == TokenKind::text ? std::string(lexer_.next().text) : out.name;
                break;
            case Shape::option: {
                out.name = text(out.word);
                const Token value = lexer_.next();
                if (value.kind != TokenKind::word && value.kind != TokenKind::text)
                    throw ImportError{value.at, "Option " + quote(out.name) + " needs a value"};
                out.second = value.kind == TokenKind::text ? quote(value.text) : std::string(value.text);
                break;
            }
            case Shape::keyword: {
                const Token value = lexer_.next();
                out.name = std::string(value.text);
                if (out.name != "All" && out.name != "StartTime" && out.name != "EndTime")
                    throw ImportError{value.at, "ActiveTransform takes All, StartTime or EndTime"};
                break;
            }
        }
        if (out.word == "Include" || out.word == "Import") {
            include(std::move(out));
            return;
        }
        scene_.has_world_begin |= out.verb == Verb::world_begin;
        scene_.has_world_end |= out.verb == Verb::world_end;
        scene_.directives.push_back(std::move(out));
    }

    [[noreturn]] static void unknown(const Token& token) {
        std::string printable;
        for (const char c : token.text.substr(0, 60))
            printable += static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126 ? '?' : c;
        std::string best;
        for (const auto& [word, rule] : rules()) { // the same letters in another case: the usual typo
            if (word.size() != token.text.size()) continue;
            if (std::equal(word.begin(), word.end(), token.text.begin(), [](char a, char b) {
                    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
                }))
                best = word;
        }
        throw ImportError{token.at,
                          "'" + printable + "' is no directive of pbrt" +
                              (best.empty() ? "; is a quote or bracket before it missing?" : "; write " + best)};
    }

    std::string text(const std::string& what) {
        const Token token = lexer_.next();
        if (token.kind != TokenKind::text) throw ImportError{token.at, what + " needs a \"string\" here"};
        return std::string(token.text);
    }

    std::vector<double> numbers(const std::string& what, int count, bool brackets) {
        std::vector<double> out(static_cast<std::size_t>(count));
        const bool opened = brackets && lexer_.peek().kind == TokenKind::open;
        if (opened) lexer_.next();
        for (double& value : out)
            if (!lexer_.number(value))
                throw ImportError{lexer_.here(), what + " needs " + std::to_string(count) + " numbers"};
        if (opened && lexer_.next().kind != TokenKind::close)
            throw ImportError{lexer_.here(), what + " takes " + std::to_string(count) + " numbers; close it with ']'"};
        return out;
    }

    ParamList params() {
        ParamList list;
        while (lexer_.peek().kind == TokenKind::text)
            list.params.push_back(param(lexer_.next()));
        return list;
    }

    Param param(const Token& declaration) {
        Param out;
        out.at = declaration.at;
        lexer_.forget_comments(); // between parameters they are not labels
        const std::string_view blanks = " \t";
        const std::string_view all = declaration.text;
        const auto begin = all.find_first_not_of(blanks);
        const auto end = begin == all.npos ? begin : all.find_first_of(blanks, begin);
        const auto name = end == all.npos ? end : all.find_first_not_of(blanks, end);
        if (name == all.npos)
            throw ImportError{declaration.at,
                              "expected a parameter as \"float radius\" (type and name), found " + quote(all)};
        out.type = all.substr(begin, end - begin);
        out.name = all.substr(name, std::min(all.find_first_of(blanks, name), all.size()) - name);
        if (lexer_.peek().kind == TokenKind::open) {
            const Location opened = lexer_.next().at;
            while (true) {
                double value = 0;
                while (lexer_.number(value))
                    out.numbers.push_back(value);
                const Token token = lexer_.next();
                if (token.kind == TokenKind::close) {
                    lexer_.forget_comments();
                    break;
                }
                if (token.kind == TokenKind::end_of_file || token.kind == TokenKind::open)
                    throw ImportError{token.at, "the '[' of line " + std::to_string(opened.line) + " for " +
                                                    quote(all) +
                                                    " is not closed; add ']' or restore the rest of the file"};
                add(out, token);
            }
        } else {
            const Token token = lexer_.next();
            if (token.kind == TokenKind::end_of_file || token.kind == TokenKind::close)
                throw ImportError{token.at, "parameter " + quote(all) + " has no value"};
            add(out, token);
        }
        if (out.type == "bool") as_bools(out);
        const int kinds = !out.numbers.empty() + !out.strings.empty() + !out.bools.empty();
        if (kinds > 1)
            throw ImportError{out.at, "parameter " + quote(all) + " mixes numbers, strings or booleans; give one kind"};
        return out;
    }

    void add(Param& param, const Token& token) {
        if (token.kind == TokenKind::text)
            param.strings.emplace_back(token.text);
        else if (token.text == "true" || token.text == "false")
            param.bools.push_back(token.text == "true");
        else
            param.numbers.push_back(lexer_.number_in(token));
    }

    void as_bools(Param& param) { // v3 writes "true", v4 writes true
        for (const std::string& text : param.strings) {
            if (text != "true" && text != "false")
                scene_.slips.push_back({param.at, "\"bool " + param.name + "\"",
                                        "it is " + quote(text) + ", which pbrt reads as false; write true or false",
                                        true});
            param.bools.push_back(text == "true");
        }
        param.strings.clear();
    }

    void include(Directive directive) {
        constexpr std::size_t deepest = 64;
        const bool import = directive.word == "Import";
        namespace fs = std::filesystem;
        fs::path path = fs::path(directive.name);
        std::error_code code;
        if (path.is_relative()) { // pbrt: in the main file's folder; here also in the including file's
            const fs::path beside = fs::path(sources_.name(directive.at.file)).parent_path() / path;
            path = folder_ / path;
            if (!fs::exists(path, code) && fs::exists(beside, code)) path = beside;
        }
        const fs::path real = fs::weakly_canonical(path, code);
        const std::string name = (code ? path : real).string();
        if (lexer_.is_open(name))
            throw ImportError{directive.at,
                              directive.word + " " + quote(directive.name) +
                                  " goes in a circle: that file is being read already; remove one of them"};
        if (lexer_.depth() >= deepest)
            throw ImportError{directive.at, "files include each other more than 64 deep; flatten them"};
        std::string reason;
        auto bytes = FileBytes::open(name, reason);
        if (!bytes) {
            directive.verb = Verb::missing_file;
            directive.second = name;
            directive.third = reason;
            scene_.has_missing_file = true;
            scene_.directives.push_back(std::move(directive));
            return;
        }
        if (import) {
            scene_.directives.push_back(std::move(directive));
            imports_.push_back(lexer_.depth() + 1);
        } else {
            carried_ = std::move(directive.comments);
        }
        lexer_.push(sources_.add(name, std::move(*bytes)), !import);
    }

    Sources& sources_;
    std::filesystem::path folder_;
    const std::function<bool()>& goes_on_;
    Lexer lexer_;
    SceneFile scene_;
    std::vector<std::string_view> carried_; // before an Include: they describe its contents
    std::vector<std::size_t> imports_; // depths of the frames that Import opened
};

} // namespace

bool is_directive(std::string_view word) { return rules().count(word) > 0; }

std::optional<SceneFile> parse(Sources& sources, const std::filesystem::path& folder,
                               const std::function<bool()>& goes_on) {
    return Parser(sources, folder, goes_on).run();
}

} // namespace restage::pbrt
