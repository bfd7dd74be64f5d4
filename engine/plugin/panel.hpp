// SPDX-License-Identifier: Apache-2.0
// Panels of plugins (restage/action.h): the widgets of an inspector, and functions for panels only. [main]
#pragma once

#include "plugin/inspector.hpp"
#include "plugin/registry.hpp"

namespace restage::plugin {

class PanelWidgets : public Widgets {
  public:
    virtual bool run(const char* action) = 0; // false: not started
    virtual std::uint32_t selected() = 0;     // number of selected objects

  protected:
    ~PanelWidgets() = default;
};

// An exception in the plugin becomes an error; groups that it has begun stay open.
Result<> draw_panel(const PanelEntry&, PanelWidgets&);

} // namespace restage::plugin
