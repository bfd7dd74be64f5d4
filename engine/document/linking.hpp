// SPDX-License-Identifier: Apache-2.0
// Links of an open document (scene/links.hpp). Each function is one undo step.
#pragma once

#include "document/session.hpp"
#include "scene/links.hpp"

#include <optional>
#include <string>

namespace restage::document {

// Shows the objects of a file, which was read, in place: like Session::insert, but they stay the file's. Returns the
// group that is the link. Lights and sky of the file are left out.
Result<scene::Merged> link(Session&, const io::ImportedScene&, const std::string& file,
                           const std::optional<Session::Stand>& = {});
// How a link's file is read.
ReadOptions reading_of(const scene::LinkSource&, const plugin::Registry&);
// The link's objects as its file, read again, has them now, in its place.
Result<> reload_link(Session&, scene::Id<scene::Group>, const io::ImportedScene&);

} // namespace restage::document
