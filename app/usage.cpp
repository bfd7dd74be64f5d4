// SPDX-License-Identifier: Apache-2.0
#include "usage.hpp"

#include "commands/commands.hpp"

#include <charconv>
#include <cmath>
#include <regex>
#include <system_error>
#include <vector>

namespace restage::app {

void add_example(CLI::App& command, const char* example) {
    command.footer(std::string("Example: ") + example + "\n" + command.get_footer());
}

void forbid_empty_values(CLI::App& program) {
    std::vector<CLI::App*> commands = program.get_subcommands(nullptr);
    commands.push_back(&program);
    for (CLI::App* command : commands)
        for (CLI::Option* option : command->get_options()) {
            if (option->get_expected_min() == 0 || option->get_items_expected_max() == 0) continue; // a flag
            const bool number = option->get_type_name().find("FLOAT") != std::string::npos;
            option->check([number](const std::string& value) -> std::string {
                if (value.empty()) return "the value is empty; give one, or omit the option";
                if (!number) return "";
                double x = 0;
                const char* begin = value.c_str() + (value[0] == '+');
                const auto read = std::from_chars(begin, value.c_str() + value.size(), x); // independent of the locale
                const bool finite = std::isfinite(x) && read.ec != std::errc::result_out_of_range;
                return finite ? "" : value + " is not a finite number";
            });
        }
}

std::string usage_sentence(const CLI::App& program, const CLI::Error& error) {
    const auto chosen = program.get_subcommands();
    const std::string name = chosen.empty() ? "restage" : "restage " + chosen.front()->get_name();
    std::string text = error.what();
    std::smatch m;
    if (std::regex_match(text, m, std::regex("The following arguments? w\\S+ not expected: (.*)"))) {
        const std::string extras = m[1];
        if (std::regex_search(extras, m, std::regex("(^| )(-\\S+)")))
            text = name + " has no option " + m[2].str();
        else
            text = "\"" + extras + "\" is " + (chosen.empty() ? "not a command" : "one argument too many");
    }
    const auto rewrite = [&](const char* pattern, const char* sentence) {
        text = std::regex_replace(text, std::regex(pattern), sentence);
    };
    rewrite("Value (\\S*) not in range \\[2\\.2\\S* - 1\\.7\\S*\\]", "$1 is out of range: it must be above 0");
    rewrite("Value (\\S*) not in range \\[0 - 1\\.7\\S*\\]", "$1 is out of range: it must be 0 or more");
    rewrite("Value (\\S*) not in range \\[(\\S*) - (\\S*)\\]", "$1 is out of range: it must be from $2 to $3");
    rewrite("^(\\S+): (\\S+) not in \\{(.*)\\}$", "$1: \"$2\" is not one of $3");
    rewrite("^(\\S+): 1 required .* missing$", "$1 takes a value");
    rewrite("^(\\S+): At Most 1 required but received \\d+$", "$1 is given more than once");
    rewrite("^(\\S+): At least (\\d+) required but received (\\d+)$", "$1 takes $2 values, not $3");
    if (std::regex_match(text, m, std::regex("Could not convert: (\\S+) = (.*)"))) {
        const CLI::Option* option = chosen.empty() ? nullptr : chosen.front()->get_option_no_throw(m[1]);
        const bool whole = option && (option->get_type_name().starts_with("UINT") || m[1] == "--region");
        text = m[1].str() + ": \"" + m[2].str() + "\" is not a " +
               (whole ? "whole number from 0 to 4294967295" : "number");
    }
    return "restage: " + text + "\nTry '" + name + " --help'.\n";
}

} // namespace restage::app
