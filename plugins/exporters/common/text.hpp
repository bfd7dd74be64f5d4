// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace restage::exporters {

std::string number(float); // the shortest text that reads back the same
std::string number(double);
std::string plain_name(std::string_view); // fit for a comment and a file: no quotes, slashes or control characters
std::vector<std::string> lines(std::string_view text); // without empty ones

} // namespace restage::exporters
