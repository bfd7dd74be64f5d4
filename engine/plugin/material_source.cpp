// SPDX-License-Identifier: Apache-2.0
#include "plugin/material_source.hpp"

#include "base/file.hpp"
#include "plugin/table_digest.hpp"

namespace restage::plugin {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_glsl = 16 << 20;
constexpr int deepest_folder = 4;

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
        if (size > most_glsl) return fail(folder.string() + ": more than 16 MiB of GLSL are implausible");
        texts->emplace(fs::absolute(it->path(), ignored).lexically_normal(), std::move(text));
    }
    return std::shared_ptr<const FileTexts>(std::move(texts));
}

MaterialSource::MaterialSource(model::Material material, fs::path folder, std::shared_ptr<const FileTexts> glsl,
                               std::shared_ptr<TableReader> table_reader)
    : material_(std::move(material)),
      folder_(std::move(folder)),
      glsl_(std::move(glsl)),
      table_reader_(std::move(table_reader)) {
    Digest digest;
    const model::Material& m = material_;
    for (const std::string& text : {m.type, m.label, m.prefix, m.glsl_file, m.tooltip})
        digest.text(text);
    for (const bool flag : {m.stochastic, m.lossless, m.transmissive, m.nonreciprocal, m.null_surface, m.mix, m.tangent,
                            m.additive, m.site, m.emission.has_value()})
        digest.number(flag);
    for (model::Param& p : material_.params) {
        digest.param(p);
        if (!p.file.empty()) p.file = (folder_ / p.file).lexically_normal().string();
    }
    if (m.emission)
        for (const std::string& text : {m.emission->radiance, m.emission->scale, m.emission->two_sided})
            digest.text(text);
    digest.files(*glsl_, folder_);
    revision_ = digest.value();
}

} // namespace restage::plugin
