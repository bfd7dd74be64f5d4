// SPDX-License-Identifier: Apache-2.0
// Panels of plugins (restage/action.h): the widgets of an inspector, and what only a panel can do. [main]
#pragma once

#include "plugin/inspector.hpp"
#include "plugin/registry.hpp"

namespace restage::plugin {

class PanelWidgets : public Widgets {
  public:
    virtual bool run(const char* action) = 0; // false: not started
    virtual std::uint32_t selected() = 0;     // how many objects are

  protected:
    ~PanelWidgets() = default;
};

// An exception of the plugin becomes an error; groups it has begun stay open.
Result<> draw_panel(const PanelEntry&, PanelWidgets&);

} // namespace restage::plugin
