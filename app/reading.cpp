// SPDX-License-Identifier: Apache-2.0
#include "reading.hpp"

#include "progress.hpp"
#include "rendering.hpp"

namespace restage::app {

Result<document::ReadOptions> reading_with(const Context& context, ProgressBar& bar) {
    catch_interrupts();
    document::ReadOptions read{.progress = [&bar](float done, std::string_view what) {
        bar.show(done, std::string(what));
        return !interrupted();
    }};
    RESTAGE_TRY(read.isolate, isolate_options(context));
    return read;
}

} // namespace restage::app
