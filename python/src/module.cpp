// SPDX-License-Identifier: Apache-2.0
// The module restage._core; the package restage (python/restage) gives its contents their public names.
#include "base/version.hpp"
#include "camera_moves.hpp"
#include "collections.hpp"
#include "picture.hpp"

NB_MODULE(_core, m) {
    using namespace restage::python;
    m.doc() = "Restage's engine for Python; import restage instead.";
    nb::exception<Failure> error(m, "Error", PyExc_RuntimeError);
    error.doc() = "A failure, as one sentence: what, where (file:line:column), what to do about it.";
    nb::exception<Stopped>(m, "Cancelled", error).doc() = "A callback returned False: the call was cancelled.";
    m.def("version", &restage::version, "Restage's version. For the package itself, whose __version__ it is.");
    m.def("set_home", &Host::set_home, "folder"_a, "Where lib/restage and share/restage are. For the package itself.");
    m.def("home", &Host::home, "Where they are.");
    nb::set_leak_warnings(false); // sessions in globals exist until the process ends

    bind_plugins(m);
    bind_textures(m);
    bind_materials(m);
    auto object = bind_things(m);
    bind_lights(m);
    bind_collections(m);
    bind_picture(m);
    nb::class_<Workspace> session(
        m, "Session",
        "An open scene, like the one in the editor's window. Find things, change them (each change is one undo "
        "step),\n"
        "render, write. Close it, or use `with restage.open(...) as session`, to free the renderer.");
    bind_session(m, session);
    bind_add_texture(session);
    bind_geometry(session, object);
    bind_actions(m, session);
    bind_render(m, session);
    bind_sky(session);
    bind_camera_moves(m, session);
    bind_looks(session);
    bind_bsdf(m);
}
