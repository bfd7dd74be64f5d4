// SPDX-License-Identifier: Apache-2.0
// Variants of a document's file (KHR_materials_variants of glTF) as looks: what differs are the materials of objects.
#pragma once

#include "document/session.hpp"

#include <span>
#include <string>
#include <vector>

namespace restage::document {

struct Variant {
    std::string name;
    scene::Scene scene; // the file as imported with this variant
};

std::vector<std::string> variants_of(const Session&); // names, or numbers from 1; empty: the file has none
// Reads the file once for each. [worker]
Result<std::vector<Variant>> read_variants(const Base&, std::span<const std::string> names, const plugin::Registry&,
                                           const ReadOptions& = {});
// A look for each variant: the document as it is now, with the materials of the variant on those objects for which it
// has others than the file as it was opened. One undo step; returns the names of the looks.
Result<std::vector<std::string>> looks_from_variants(Session&, std::span<const Variant>);

} // namespace restage::document
