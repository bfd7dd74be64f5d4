// SPDX-License-Identifier: Apache-2.0
#include "check/report.hpp"

#include "check/subject.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace restage::check {

using nlohmann::ordered_json;

namespace {

std::string figure(const Figure& f) {
    const std::string number = std::abs(f.value) < 1e6 && f.value == std::floor(f.value)
                                   ? fmt::format("{:.0f}", f.value)
                                   : fmt::format("{:.3g}", f.value);
    return f.name + " " + number + (f.unit.empty() ? "" : " " + f.unit);
}

std::string figures(const StepResult& s) {
    std::string text;
    for (const Figure& f : s.figures)
        text += (text.empty() ? "" : ", ") + figure(f);
    return text;
}

std::string indented(const std::string& text, const std::string& by) {
    std::string out;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        out += (at ? "\n" + by : "") + text.substr(at, end - at);
        at = end + 1;
    }
    return out;
}

std::string xml(const std::string& text) {
    std::string out;
    for (const char c : text)
        out += c == '&'    ? "&amp;"
               : c == '<'  ? "&lt;"
               : c == '>'  ? "&gt;"
               : c == '"'  ? "&quot;"
               : c == '\n' ? "&#10;"
                           : std::string(1, static_cast<unsigned char>(c) < 32 ? ' ' : c);
    return out;
}

} // namespace

ordered_json to_json(const StepResult& s) {
    ordered_json figures = ordered_json::array();
    for (const Figure& f : s.figures)
        figures.push_back({{"name", f.name},
                           {"value", std::isfinite(f.value) ? ordered_json(f.value) : ordered_json(nullptr)},
                           {"unit", f.unit}});
    return {{"step", s.step},      {"of", s.of},       {"verdict", to_string(s.verdict)},
            {"text", s.text},      {"cause", s.cause}, {"figures", figures},
            {"seconds", s.seconds}};
}

StepResult step_from_json(const ordered_json& j) {
    StepResult s;
    s.step = j.value("step", ""), s.of = j.value("of", ""), s.text = j.value("text", "");
    s.cause = j.value("cause", ""), s.seconds = j.value("seconds", 0.0);
    const std::string verdict = j.value("verdict", "fail");
    s.verdict = verdict == "pass" ? Verdict::pass : verdict == "skipped" ? Verdict::skipped : Verdict::fail;
    if (j.contains("figures") && j["figures"].is_array())
        for (const auto& f : j["figures"])
            s.figures.push_back({f.value("name", ""),
                                 f.contains("value") && f["value"].is_number() ? f["value"].get<double>() : NAN,
                                 f.value("unit", "")});
    return s;
}

ordered_json to_json(const PluginReport& r) {
    ordered_json steps = ordered_json::array();
    for (const StepResult& s : r.steps)
        steps.push_back(to_json(s));
    ordered_json pictures = ordered_json::array();
    for (const auto& p : r.pictures)
        pictures.push_back(p.string());
    return {{"id", r.id},
            {"kind", r.kind},
            {"version", r.version},
            {"folder", r.folder.string()},
            {"verdict", r.passed() ? "pass" : "fail"},
            {"seed", r.seed},
            {"mode", r.quick ? "quick" : "full"},
            {"seconds", r.seconds},
            {"unable", r.unable},
            {"steps", steps},
            {"pictures", pictures}};
}

std::string headline(const PluginReport& r) {
    return fmt::format("{}{} ({}seed {}{})", r.id, r.version.empty() ? "" : " " + r.version,
                       r.kind.empty() ? "" : r.kind + ", ", r.seed, r.quick ? ", quick" : "");
}

std::string text_of(const StepResult& s, const PluginReport& r) {
    const std::string name = s.of.empty() || s.of == r.id.substr(r.id.rfind('.') + 1) ? s.step : s.step + " of " + s.of;
    if (s.verdict == Verdict::skipped) return fmt::format("  skip  {:<12} {}\n", name, s.text);
    const std::string measured = figures(s);
    if (s.verdict == Verdict::pass) {
        std::string line = fmt::format("  pass  {:<12} {}", name, measured);
        if (!s.text.empty())
            line += (measured.empty() ? "" : "\n                     ") + indented(s.text, std::string(21, ' '));
        return line + "\n";
    }
    std::string out = fmt::format("  FAIL  {:<12} {}\n", name, indented(s.text, "        "));
    if (!measured.empty()) out += "        measured: " + measured + "\n";
    if (!s.cause.empty()) out += "        usually: " + s.cause + "\n";
    out += fmt::format("        again: restage check {} --only {} --seed {}{}\n", r.folder.string(), s.step, r.seed,
                       r.quick ? " --quick" : "");
    return out;
}

std::string verdict_line(const PluginReport& r) {
    int counts[3] = {};
    for (const StepResult& s : r.steps)
        ++counts[static_cast<int>(s.verdict)];
    std::string text = r.passed() ? "passed: " : counts[1] || r.unable.empty() ? "FAILED: " : "NOT CHECKED: ";
    text += fmt::format("{} passed", counts[0]);
    if (counts[1]) text += fmt::format(", {} failed", counts[1]);
    if (counts[2]) text += fmt::format(", {} skipped", counts[2]);
    return text + fmt::format(", {:.1f} s", r.seconds);
}

std::string junit(std::span<const PluginReport> reports) {
    std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"restage check\">\n";
    for (const PluginReport& r : reports) {
        int failures = 0, skipped = 0;
        for (const StepResult& s : r.steps)
            failures += s.verdict == Verdict::fail, skipped += s.verdict == Verdict::skipped;
        out += fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\" time=\"{:.3f}\">\n",
                           xml(r.id), r.steps.size(), failures, skipped, r.seconds);
        for (const StepResult& s : r.steps) {
            out += fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", xml(r.id),
                               xml(s.of.empty() ? s.step : s.of + ": " + s.step), s.seconds);
            if (s.verdict == Verdict::pass)
                out += "/>\n";
            else if (s.verdict == Verdict::skipped)
                out += fmt::format("><skipped message=\"{}\"/></testcase>\n", xml(s.text));
            else
                out += fmt::format("><failure message=\"{}\">usually: {} (seed {})</failure></testcase>\n", xml(s.text),
                                   xml(s.cause), r.seed);
        }
        out += "  </testsuite>\n";
    }
    return out + "</testsuites>\n";
}

std::string markdown(std::span<const PluginReport> reports) {
    const auto cell = [](const PluginReport& r, const char* step, const std::string& of) -> std::string {
        for (const StepResult& s : r.steps)
            if (s.step == step && (s.of.empty() || s.of == of))
                return s.verdict == Verdict::pass ? "pass" : s.verdict == Verdict::fail ? "**FAIL**" : "-";
        return "";
    };
    std::string out =
        "# Conformance\n\nWritten by `restage check --markdown`; do not edit. What each step tests is below "
        "the table; `-` is a step that does not apply.\n\n## Materials\n\n| material |";
    std::vector<const Step*> steps;
    for (const auto* list : {&plugin_steps(), &material_steps()})
        for (const Step& s : *list)
            steps.push_back(&s), out += fmt::format(" {} |", s.name);
    out += " time [s] |\n|---|" + std::string();
    for (std::size_t i = 0; i <= steps.size(); ++i)
        out += "---|";
    out += "\n";
    std::vector<const std::vector<Step>*> other_steps;
    for (const auto* list : all_steps())
        if (list != &material_steps()) other_steps.push_back(list);
    std::string others, details;
    for (const PluginReport& r : reports) {
        std::vector<std::string> tables;
        for (const StepResult& s : r.steps)
            if (!s.of.empty() && std::find(tables.begin(), tables.end(), s.of) == tables.end()) tables.push_back(s.of);
        if (tables.empty()) tables.push_back(r.id);
        for (const std::string& of : tables) {
            if (!r.kind.starts_with("material")) {
                others += fmt::format("| {} | {} |", of, r.kind);
                for (const auto* list : other_steps)
                    for (const Step& step : *list)
                        others += fmt::format(" {} |", cell(r, step.name, of));
                others += "\n";
                continue;
            }
            out += fmt::format("| {} |", of);
            for (const Step* s : steps)
                out += fmt::format(" {} |", cell(r, s->name, of));
            out += fmt::format(" {:.0f} |\n", r.seconds);
        }
        details += fmt::format("\n### {} {}\n\nSeed {}, {} mode, {:.1f} s.\n\n", r.id, r.version, r.seed,
                               r.quick ? "quick" : "full", r.seconds);
        for (const StepResult& s : r.steps) {
            const std::string measured = figures(s);
            details += fmt::format("- {}{}: {}{}{}\n", s.step, s.of.empty() || tables.size() == 1 ? "" : " of " + s.of,
                                   to_string(s.verdict), measured.empty() ? "" : "; " + measured,
                                   s.text.empty() ? "" : "; " + indented(s.text, "  "));
        }
    }
    if (!others.empty()) {
        std::string names, line;
        for (const auto* list : other_steps)
            for (const Step& step : *list)
                names += fmt::format(" {} |", step.name), line += "---|";
        out += "\n## Other plugins\n\n| plugin | kind |" + names + "\n|---|---|" + line + "\n" + others;
    }
    out += "\n## Steps\n\n";
    for (const auto* list : all_steps())
        for (const Step& s : *list)
            out += fmt::format("- **{}**: {}\n", s.name, s.tests);
    return out + "\n## Figures\n" + details;
}

} // namespace restage::check
