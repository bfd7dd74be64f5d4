// SPDX-License-Identifier: Apache-2.0
#include "io/options.hpp"

#include <charconv>

namespace restage::io {

using namespace scene;

namespace {

std::string known_options(model::ParamTable table) {
    std::string list;
    for (const model::Param& option : table) {
        list += (list.empty() ? "" : ", ") + option.id;
        if (option.type == model::ParamType::choice) list += "=" + choices_text(option);
    }
    return list.empty() ? "it has no options" : "there are: " + list;
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
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
        return fail("\"" + assignment + "\" is no option; write name=value");
    const std::string id = assignment.substr(0, equals), text = assignment.substr(equals + 1);
    const model::Param* option = find_param(table, id);
    if (!option) return check_option(who, table, id, {});
    Value value{.type = option->type};
    if (option->type == model::ParamType::choice || option->type == model::ParamType::text) {
        value.text = text;
    } else if (option->type == model::ParamType::boolean) {
        if (text != "true" && text != "false")
            return fail("option \"" + id + "\": \"" + text + "\" is neither true nor false");
        value.i = text == "true";
    } else if (option->type == model::ParamType::integer) {
        const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value.i);
        if (code != std::errc() || end != text.data() + text.size())
            return fail("option \"" + id + "\": \"" + text + "\" is not a whole number");
    } else {
        const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value.v[0]);
        if (code != std::errc() || end != text.data() + text.size())
            return fail("option \"" + id + "\": \"" + text + "\" is not a number");
    }
    RESTAGE_CHECK(check_option(who, table, id, value));
    values.set(id, std::move(value));
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
    return set_option("importer \"" + importer.format + "\"", importer.options, assignment, values);
}

} // namespace restage::io
