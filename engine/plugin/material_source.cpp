// SPDX-License-Identifier: Apache-2.0
#include "plugin/material_source.hpp"

#include "base/file.hpp"

#include <cstring>

namespace restage::plugin {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_glsl = 16 << 20;
constexpr int deepest_folder = 4;

// Numbers and texts of a table, one after the other: what two tables must share to be the same.
class Digest {
  public:
    void text(const char* t) { hash_ = hash64(t ? std::string_view(t) : std::string_view("\1"), hash_ + 1); }
    template <class T>
    void number(T v) {
        hash_ = hash64(&v, sizeof v, hash_);
    }
    std::uint64_t value() const { return hash_; }

  private:
    std::uint64_t hash_ = 0;
};

} // namespace

Result<std::shared_ptr<const FileTexts>> read_glsl(const fs::path& folder) {
    auto texts = std::make_shared<FileTexts>();
    std::size_t size = 0;
    std::error_code code;
    fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied, code), end;
    for (; !code && it != end; it.increment(code)) {
        std::error_code ignored;
        if (it.depth() >= deepest_folder) it.disable_recursion_pending();
        if (it->path().extension() != ".glsl" || !it->is_regular_file(ignored)) continue;
        RESTAGE_TRY(std::string text, read_file(it->path()));
        size += text.size();
        if (size > most_glsl) return fail(folder.string() + ": more than 16 MiB of GLSL are not believable");
        texts->emplace(fs::absolute(it->path(), ignored).lexically_normal(), std::move(text));
    }
    return std::shared_ptr<const FileTexts>(std::move(texts));
}

const char* MaterialSource::keep(const char* text) { return text ? strings_.emplace_back(text).c_str() : nullptr; }

MaterialSource::MaterialSource(const RestageMaterial1& table, fs::path folder, std::shared_ptr<const FileTexts> glsl,
                               std::shared_ptr<TableReader> table_reader, const RestageEmission1* emission)
    : folder_(std::move(folder)),
      glsl_(std::move(glsl)),
      table_reader_(std::move(table_reader)),
      params_(table.params, table.params + table.param_count) {
    table_.size = sizeof table_;
    table_.flags = table.flags;
    table_.type = keep(table.type);
    table_.label = keep(table.label);
    table_.prefix = keep(table.prefix);
    table_.glsl_file = keep(table.glsl_file);
    table_.tooltip = keep(table.tooltip ? table.tooltip : "");
    Digest digest;
    digest.number(table_.flags);
    for (const char* text : {table_.type, table_.label, table_.prefix, table_.glsl_file, table_.tooltip})
        digest.text(text);
    for (RestageParam& p : params_) {
        p.id = keep(p.id);
        p.label = keep(p.label);
        p.unit = keep(p.unit ? p.unit : "");
        p.choices = keep(p.choices);
        p.tooltip = keep(p.tooltip ? p.tooltip : "");
        for (const char* text : {p.id, p.label, p.unit, p.choices, p.tooltip})
            digest.text(text);
        for (const std::uint32_t n : {p.type, p.flags})
            digest.number(n);
        for (const float v : {p.min, p.max, p.def[0], p.def[1], p.def[2], p.def[3]})
            digest.number(v);
        if (p.type == RESTAGE_TABLE && p.choices && *p.choices)
            p.choices = keep((folder_ / p.choices).lexically_normal().string().c_str());
    }
    if (emission) {
        emission_ = RestageEmission1{.size = sizeof *emission,
                                     .reserved = 0,
                                     .type = table_.type,
                                     .radiance = keep(emission->radiance),
                                     .scale = keep(emission->scale),
                                     .two_sided = keep(emission->two_sided)};
        for (const char* text : {emission_->radiance, emission_->scale, emission_->two_sided})
            digest.text(text);
    }
    table_.params = params_.data();
    table_.param_count = static_cast<std::uint32_t>(params_.size());
    for (const auto& [path, text] : *glsl_) {
        digest.text(path.lexically_relative(folder_).generic_string().c_str());
        digest.text(text.c_str());
    }
    revision_ = digest.value();
}

} // namespace restage::plugin
