// SPDX-License-Identifier: Apache-2.0
// The glslang front end and the SPIR-V optimiser behind ShaderCompiler.
#include "gpu/compiler.hpp"

#include "base/file.hpp"
#include "gpu/includes.hpp"
#include "gpu/spirv_cache.hpp"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <glslang/build_info.h>
#include <spirv-tools/libspirv.h>
#include <spirv-tools/optimizer.hpp>

#include <cctype>
#include <mutex>
#include <string_view>

namespace restage::gpu {

namespace {

constexpr std::size_t max_cache_entries = 2000;

EShLanguage language_of(ShaderStage stage) {
    switch (stage) {
        case ShaderStage::compute:
            return EShLangCompute;
        case ShaderStage::raygen:
            return EShLangRayGen;
        case ShaderStage::closest_hit:
            return EShLangClosestHit;
        case ShaderStage::any_hit:
            return EShLangAnyHit;
        case ShaderStage::intersection:
            return EShLangIntersect;
        case ShaderStage::miss:
            return EShLangMiss;
        case ShaderStage::callable:
            return EShLangCallable;
    }
    return EShLangCompute;
}

std::string preamble_of(const ShaderSource& source) {
    std::string text;
    for (const auto& [name, value] : source.defines)
        text += "#define " + name + " " + value + "\n";
    return text;
}

std::string hex(std::uint64_t value) {
    std::string text(16, '0');
    for (std::size_t i = 0; i < 16; ++i)
        text[15 - i] = "0123456789abcdef"[(value >> (4 * i)) & 15];
    return text;
}

std::string key_of(const ShaderSource& source, const ExpandedSource& expanded, const ShaderCompilerOptions& options) {
    std::string head = "vulkan1.3 glslang " + std::to_string(GLSLANG_VERSION_MAJOR) + "." +
                       std::to_string(GLSLANG_VERSION_MINOR) + "." + std::to_string(GLSLANG_VERSION_PATCH) + " " +
                       spvSoftwareVersionString() + " stage " + std::to_string(static_cast<int>(source.stage)) +
                       (options.optimize ? " optimised" : "") + (options.debug_info ? " debug" : "") + "\n";
    if (options.debug_info)
        for (const std::string& name : expanded.names)
            head += name + "\n";
    head += preamble_of(source);
    const auto seed = [&](std::uint64_t s) { return hash64(expanded.text, hash64(head, s)); };
    return hex(seed(0)) + hex(seed(1));
}

// "ERROR: 2:14: 'x' : undeclared identifier" -> "oak.glsl:14: 'x' : undeclared identifier".
std::string rewrite_line(std::string_view line, const std::vector<std::string>& names) {
    for (std::string_view kind : {"ERROR: ", "WARNING: "}) {
        if (!line.starts_with(kind)) continue;
        std::string_view rest = line.substr(kind.size());
        std::size_t number = 0, i = 0;
        while (i < rest.size() && std::isdigit(static_cast<unsigned char>(rest[i])))
            number = number * 10 + static_cast<std::size_t>(rest[i++] - '0');
        const std::string word = kind == "WARNING: " ? "warning: " : "";
        if (i == 0 || i >= rest.size() || rest[i] != ':' || number >= names.size()) // no location: a link error
            return names.front() + ": " + word + std::string(rest);
        rest.remove_prefix(i + 1);
        const auto end = rest.find(": ");
        if (end == std::string_view::npos) return names[number] + ":" + std::string(rest);
        return names[number] + ":" + std::string(rest.substr(0, end)) + ": " + word + std::string(rest.substr(end + 2));
    }
    return std::string(line);
}

std::string rewrite_log(std::string_view log, const ExpandedSource& expanded) {
    std::string text;
    while (!log.empty()) {
        const auto end = std::min(log.find('\n'), log.size());
        const std::string_view line = log.substr(0, end);
        log.remove_prefix(std::min(end + 1, log.size()));
        const bool summary = line.find("compilation errors.  No code generated.") != std::string_view::npos ||
                             line.find("compilation terminated") != std::string_view::npos;
        if (line.empty() || summary) continue;
        text += (text.empty() ? "" : "\n") + rewrite_line(line, expanded.names);
    }
    for (std::size_t i = 0; i < expanded.errors.size(); ++i) {
        const std::string code = "'#error' : RESTAGE_SOURCE_ERROR_" + std::to_string(i) + "_";
        if (const auto at = text.find(code); at != std::string::npos) text.replace(at, code.size(), expanded.errors[i]);
    }
    return text;
}

// glslang keeps every function of every include, and drivers translate all of it before discarding it. These few
// passes cost 20 ms per kernel once and save a quarter of pipeline creation at each start (measured on lavapipe
// with six composed materials: 490 -> 370 ms); the full set of performance passes costs 300 ms per kernel for 30 ms
// more, and neither makes code run or compile faster there.
void optimise(std::vector<std::uint32_t>& words, bool keep_debug_info) {
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    if (!keep_debug_info) optimizer.RegisterPass(spvtools::CreateStripDebugInfoPass());
    optimizer.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateLocalAccessChainConvertPass())
        .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass());
    spvtools::OptimizerOptions options;
    options.set_run_validator(false);
    std::vector<std::uint32_t> better;
    if (optimizer.Run(words.data(), words.size(), &better, options)) words = std::move(better);
}

} // namespace

ShaderCompiler::ShaderCompiler(ShaderCompilerOptions options) : options_(std::move(options)) {
    static std::once_flag once;
    std::call_once(once, [] { glslang::InitializeProcess(); }); // its tables last as long as the process
    SpirvCache(options_.cache_dir).trim(max_cache_entries);
}
ShaderCompiler::~ShaderCompiler() = default;
ShaderCompiler::ShaderCompiler(ShaderCompiler&&) noexcept = default;
ShaderCompiler& ShaderCompiler::operator=(ShaderCompiler&&) noexcept = default;

Result<Spirv> ShaderCompiler::compile(const ShaderSource& source) const {
    ExpandedSource expanded = expand_includes(source, options_.include_dirs);
    Spirv spirv{.name = source.name,
                .stage = source.stage,
                .key = key_of(source, expanded, options_),
                .files = std::move(expanded.files)};
    const SpirvCache cache(options_.cache_dir);
    if (auto words = cache.load(spirv.key)) {
        spirv.words = std::move(*words);
        spirv.from_cache = true;
        return spirv;
    }

    const EShLanguage language = language_of(source.stage);
    const auto messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules |
                                                   (options_.debug_info ? EShMsgDebugInfo : EShMsgDefault));
    const std::string preamble = preamble_of(source);
    const char* const text = expanded.text.c_str();
    const int length = static_cast<int>(expanded.text.size());
    const char* const name = source.name.c_str();
    glslang::TShader shader(language);
    shader.setStringsWithLengthsAndNames(&text, &length, options_.debug_info ? &name : nullptr, 1);
    shader.setPreamble(preamble.c_str());
    shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
    if (!shader.parse(GetDefaultResources(), 460, false, messages))
        return fail(rewrite_log(shader.getInfoLog(), expanded));
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(messages)) return fail(rewrite_log(program.getInfoLog(), expanded));

    glslang::SpvOptions options;
    options.generateDebugInfo = options_.debug_info;
    options.disableOptimizer = true; // we run our own passes below
    glslang::GlslangToSpv(*program.getIntermediate(language), spirv.words, &options);
    if (spirv.words.empty()) return fail(source.name + ": the compiler produced no SPIR-V");
    if (options_.optimize) optimise(spirv.words, options_.debug_info);
    cache.store(spirv.key, spirv.words);
    return spirv;
}

} // namespace restage::gpu
