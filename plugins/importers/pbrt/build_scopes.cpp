// SPDX-License-Identifier: Apache-2.0
// The graphics state and its scopes. v3: TransformBegin saves only the transform, and names are scoped to attribute
// blocks; v4: TransformBegin is AttributeBegin, and names are global (pbrt-v4 file format, "Attributes").
#include "builder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace restage::pbrt {

namespace {
constexpr std::size_t deepest_nesting = 1000;
}

void Builder::push(const Directive& directive) {
    if (stack_.size() >= deepest_nesting)
        throw ImportError{directive.at, "blocks are nested more than 1000 deep; an End is missing somewhere before"};
    stack_.push_back({state_, &directive});
}

void Builder::pop(const Directive& directive, bool only_transform) {
    const auto matches = [&](const Directive& opened) {
        switch (directive.verb) {
            case Verb::attribute_end:
                return opened.verb == Verb::attribute_begin || (!import_.v3() && opened.verb == Verb::transform_begin);
            case Verb::transform_end:
                return opened.verb == Verb::transform_begin || (!import_.v3() && opened.verb == Verb::attribute_begin);
            case Verb::object_end:
                return opened.verb == Verb::object_begin;
            default:
                return opened.verb == Verb::import_begin;
        }
    };
    if (stack_.empty() && directive.verb != Verb::object_end) {
        import_.warned(directive.at, directive.word, "without a Begin before it; left out, as pbrt does");
        return;
    }
    if (stack_.empty()) throw ImportError{directive.at, directive.word + " without a Begin before it; remove it"};
    Saved& top = stack_.back();
    if (import_.v3() && !matches(*top.opened) && directive.verb != Verb::object_end &&
        top.opened->verb != Verb::object_begin && top.opened->verb != Verb::import_begin)
        return pop_v3(directive);
    const bool of_import = top.opened->verb == Verb::import_begin || directive.verb == Verb::import_end;
    if (!matches(*top.opened) && import_.v3() && !of_import) // ObjectBegin and ObjectEnd are also an attribute block
        import_.warned(directive.at, directive.word,
                       "closes the " + top.opened->word + " of line " + std::to_string(top.opened->at.line) +
                           "; the Begins and Ends do not match, and pbrt goes on");
    else if (!matches(*top.opened))
        throw ImportError{directive.at, directive.word + " closes the " + top.opened->word + " of line " +
                                            std::to_string(top.opened->at.line) + "; the Begins and Ends do not match"};
    auto names = state_.names;
    if (only_transform) {
        state_.ctm[0] = top.state.ctm[0];
        state_.ctm[1] = top.state.ctm[1];
        state_.active = top.state.active;
        state_.label = std::move(top.state.label);
        state_.name = std::move(top.state.name);
        state_.group = top.state.group;
    } else {
        state_ = std::move(top.state);
    }
    if (!import_.v3()) state_.names = std::move(names);
    stack_.pop_back();
}

// pbrt-v3 keeps two stacks: AttributeBegin puts onto both, TransformBegin onto that of transforms. A mismatched End
// pops its own stack.
void Builder::pop_v3(const Directive& directive) {
    Saved& top = stack_.back();
    import_.warned(directive.at, directive.word,
                   "closes the " + top.opened->word + " of line " + std::to_string(top.opened->at.line) +
                       "; the Begins and Ends do not match, and pbrt goes on");
    if (directive.verb == Verb::transform_end) { // the attributes stay open
        state_.ctm[0] = top.state.ctm[0];
        state_.ctm[1] = top.state.ctm[1];
        state_.active = top.state.active;
        return;
    }
    const auto attributes = std::find_if(
        stack_.rbegin(), stack_.rend(), [](const Saved& saved) { return saved.opened->verb == Verb::attribute_begin; });
    if (attributes == stack_.rend()) return;
    const Matrix ctm[2] = {top.state.ctm[0], top.state.ctm[1]};
    const unsigned active = top.state.active;
    const Matrix below[2] = {attributes->state.ctm[0], attributes->state.ctm[1]};
    const Directive* inner = top.opened;
    state_ = attributes->state;
    state_.ctm[0] = ctm[0];
    state_.ctm[1] = ctm[1];
    state_.active = active;
    // The transform of the AttributeBegin remains.
    attributes->opened = inner;
    attributes->state.ctm[0] = below[0];
    attributes->state.ctm[1] = below[1];
    stack_.pop_back();
}

void Builder::transform_step(const Directive& d) {
    const std::vector<double>& v = d.numbers;
    Matrix by;
    switch (d.verb) {
        case Verb::translate:
            by = translation({v[0], v[1], v[2]});
            break;
        case Verb::scale:
            by = scaling({v[0], v[1], v[2]});
            break;
        case Verb::rotate:
            by = rotation(v[0], {v[1], v[2], v[3]});
            break;
        case Verb::look_at: {
            const auto view = look_at({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]});
            if (!view && import_.v3()) { // transform.cpp
                import_.warned(d.at, "LookAt", "eye and target are the same, or up points along the view; left out");
                return;
            }
            if (!view)
                throw ImportError{d.at,
                                  "LookAt: eye and target are the same, or up points along the view; move one of them"};
            by = *view;
            break;
        }
        case Verb::transform:
        case Verb::concat_transform:
            std::copy(v.begin(), v.end(), by.m.begin());
            break;
        default:
            break;
    }
    for (unsigned i = 0; i < 2; ++i) {
        if (!(state_.active & (1u << i))) continue;
        const bool replaces = d.verb == Verb::transform || d.verb == Verb::identity;
        state_.ctm[i] = replaces ? by : state_.ctm[i] * by;
        for (const double value : state_.ctm[i].m)
            if (!(std::abs(value) < 1e150))
                throw ImportError{d.at, "the transformation overflows here; check its numbers"};
    }
}

} // namespace restage::pbrt
