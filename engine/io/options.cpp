// SPDX-License-Identifier: Apache-2.0
#include "io/options.hpp"

#include <fmt/format.h>
#include <charconv>

namespace restage::io {

using namespace scene;

namespace {

std::string range_text(const model::Param& option) { // "y|z"; "" where there is no short one
    switch (option.type) {
        case ParamType::choice:
            return choices_text(option);
        case ParamType::boolean:
            return "true|false";
        case ParamType::number:
            return "NUMBER";
        case ParamType::integer:
            return "WHOLE NUMBER";
        default:
            return "TEXT";
    }
}

std::string known_options(model::ParamTable table) {
    std::string list;
    for (const model::Param& option : table)
        list += (list.empty() ? "" : ", ") + option.id + "=" + range_text(option);
    return list.empty() ? "it has no options" : "known: " + list;
}

std::string called(const model::Importer& importer) { return "importer \"" + importer.format + "\""; }

struct Assignment {
    std::string id, text;
};

Result<Assignment> split(const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
        return fail("\"" + assignment + "\" is not an option; write name=value");
    return Assignment{assignment.substr(0, equals), assignment.substr(equals + 1)};
}

Result<Value> parse(const model::Param& option, const std::string& text) {
    Value value{.type = option.type};
    const auto number = [&](auto& out, const char* what) -> Result<Value> {
        const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), out);
        if (code != std::errc() || end != text.data() + text.size())
            return fail("option \"" + option.id + "\": \"" + text + "\" is not a " + what);
        return value;
    };
    if (value.has_text()) {
        value.text = text;
        return value;
    }
    if (option.type == ParamType::integer) return number(value.i, "whole number");
    if (option.type != ParamType::boolean) return number(value.v[0], "number");
    if (text != "true" && text != "false")
        return fail("option \"" + option.id + "\": \"" + text + "\" is neither true nor false");
    value.i = text == "true";
    return value;
}

} // namespace

Result<> check_option(const std::string& who, model::ParamTable table, const std::string& id, const Value& value) {
    const model::Param* option = find_param(table, id);
    if (!option) return fail(who + ": there is no option \"" + id + "\"; " + known_options(table));
    if (const std::string why = misfit(*option, value); !why.empty())
        return fail(who + ": option \"" + id + "\"" + why);
    return {};
}

Result<> set_option(const std::string& who, model::ParamTable table, const std::string& assignment, ParamSet& values) {
    RESTAGE_TRY(const Assignment given, split(assignment));
    const model::Param* option = find_param(table, given.id);
    if (!option) return check_option(who, table, given.id, {});
    RESTAGE_TRY(Value value, parse(*option, given.text));
    RESTAGE_CHECK(check_option(who, table, given.id, value));
    values.set(given.id, std::move(value));
    return {};
}

ParamSet all_options(model::ParamTable table, const ParamSet& values) {
    ParamSet all;
    for (const model::Param& option : table) {
        const Value* given = values.find(option.id);
        all.set(option.id, given ? *given : default_value(option));
    }
    return all;
}

Result<> set_option(const model::Importer& importer, const std::string& assignment, ParamSet& values) {
    return set_option(called(importer), importer.options, assignment, values);
}

Result<> set_text_option(const std::string& assignment, ParamSet& values) {
    RESTAGE_TRY(Assignment given, split(assignment));
    values.set(given.id, Value{.type = ParamType::text, .text = std::move(given.text)});
    return {};
}

std::string option_text(const Value& value) {
    if (value.has_text()) return value.text;
    if (value.type == ParamType::boolean) return value.i != 0 ? "true" : "false";
    return value.is_whole() ? fmt::format("{}", value.i) : fmt::format("{}", value.v[0]);
}

Result<Value> fitting_option(const model::Importer& importer, const std::string& id, const Value& given) {
    Value value = given;
    if (const model::Param* option = find_param(importer.options, id); option && option->type != given.type) {
        if (given.type == ParamType::text) {
            RESTAGE_TRY(value, parse(*option, given.text));
        } else if (given.type == ParamType::integer && option->type == ParamType::number) {
            value = Value::number(static_cast<float>(given.i));
        } else if (given.type == ParamType::choice && value.has_text() && option->type == ParamType::text) {
            value.type = option->type;
        } else {
            return fail(called(importer) + ": option \"" + id + "\" cannot be " + option_text(given) + "; " +
                        known_options(importer.options));
        }
    }
    RESTAGE_CHECK(check_option(called(importer), importer.options, id, value));
    return value;
}

Result<ParamSet> fitting_options(const model::Importer& importer, const ParamSet& given) {
    ParamSet values;
    for (const auto& [id, value] : given.entries()) {
        RESTAGE_TRY(Value fitting, fitting_option(importer, id, value));
        values.set(id, std::move(fitting));
    }
    return values;
}

} // namespace restage::io
