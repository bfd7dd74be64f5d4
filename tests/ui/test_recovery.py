# SPDX-License-Identifier: Apache-2.0
"""Work survives the loss of the editor: it is killed during editing, and restarted."""
import ctypes
import pathlib
import signal
import subprocess

import pytest

from desk import Desk, Editor, Timeout

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORNELL = ROOT / "scenes/cornell/cornell.pbrt"


def hide_all(editor):
    editor.key("ctrl+a", "h")
    return editor.wait(lambda s: s["counts"]["hidden"] > 0, "hidden objects")


def written_aside(editor):
    path = editor.wait(lambda s: s["recovery"] and pathlib.Path(s["recovery"]).exists(), "work to be autosaved", 15)["recovery"]
    return pathlib.Path(path)


def answer(editor, button):
    """The first frames of a starting editor may take a second, and a click in them may find the button elsewhere."""
    for _ in range(3):
        editor.click(button)
        try:
            return editor.wait(lambda s: s["modal"] == "", "the offer to go", 5)
        except Timeout:
            pass
    raise Timeout(f"{button} does nothing")


@pytest.mark.parametrize("never_saved", [False, True], ids=["opened", "never saved"])
def test_killed_in_mid_edit_and_recovered(launch, tmp_path, never_saved):
    config = tmp_path / "config"
    first = launch(*([] if never_saved else [CORNELL]), "--autosave", 0.5, config=config)
    if never_saved:
        first.key("ctrl+n")
    before = first.wait(lambda s: s["counts"]["instances"] > 0 and not s["opening"], "the scene")
    hidden = hide_all(first)["counts"]["hidden"]
    aside = written_aside(first)
    assert aside.parent == config / "recovery" and str(first.process.pid) in aside.name
    first.kill()
    assert aside.exists()

    second = launch(config=config)
    second.wait(lambda s: s["modal"] == "Unsaved work was found", "the offer to recover")
    answer(second, "recovery.recover")
    state = second.wait(lambda s: s["counts"]["hidden"] == hidden, "the recovered scene", 60)
    assert state["modified"] and state["counts"]["instances"] == before["counts"]["instances"]
    assert state["history"]["labels"] == ["Recovered changes"]
    # It is still saved, now in a file of the new process.
    own = written_aside(second)
    assert list((config / "recovery").glob("*.restage")) == [own] and own != aside
    second.key("ctrl+z")
    state = second.wait(lambda s: s["counts"]["hidden"] == 0, "undo of what was recovered")
    assert state["modified"] is False, "the base is what the file holds"
    second.key("ctrl+y")
    second.wait(lambda s: s["modified"], "redo")

    # A clean exit leaves nothing.
    second.key("ctrl+q")
    second.wait(lambda s: s["modal"] == "Unsaved changes", "the question whether to save")
    second.click("unsaved.discard")
    assert second.process.wait(20) == 0
    assert list((config / "recovery").iterdir()) == []


def test_later_offers_again_and_discard_does_not(launch, tmp_path):
    config = tmp_path / "config"
    first = launch("--autosave", 0.5, config=config)
    first.key("ctrl+n")
    first.wait(lambda s: s["counts"]["instances"] == 1, "a new scene")
    hide_all(first)
    written_aside(first)
    # Nothing of a running process is offered.
    neighbour = launch(config=config)
    assert neighbour.state()["modal"] == ""
    neighbour.close()
    first.kill()

    second = launch(config=config)
    second.wait(lambda s: s["modal"] == "Unsaved work was found", "the offer")
    answer(second, "recovery.later")
    second.key("ctrl+q")
    assert second.process.wait(20) == 0

    third = launch(config=config)
    third.wait(lambda s: s["modal"] == "Unsaved work was found", "the same offer again")
    answer(third, "recovery.discard")
    assert list((config / "recovery").iterdir()) == []


def unsaved(launch, config):
    """An editor whose first edit was autosaved soon, and whose second one is only in memory."""
    editor = launch(CORNELL, "--autosave", 3600, config=config)
    editor.wait(lambda s: s["counts"]["instances"] > 0 and not s["opening"], "the scene")
    hidden = hide_all(editor)["counts"]["hidden"]
    aside = written_aside(editor)  # a few seconds after the first edit, not an hour
    before = aside.read_text()
    editor.key("alt+h")
    editor.wait(lambda s: s["counts"]["hidden"] == 0, "all shown")
    hide_all(editor)
    editor.wait(lambda s: s["history"]["position"] == 3, "the third edit")
    return editor, aside, before, hidden


def offered_with(launch, config, hidden):
    second = launch(config=config)
    second.wait(lambda s: s["modal"] == "Unsaved work was found", "the offer to recover")
    answer(second, "recovery.recover")
    second.wait(lambda s: s["counts"]["hidden"] == hidden, "the recovered scene", 60)


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_ended_by_a_signal_loses_nothing(launch, tmp_path, name):
    config = tmp_path / "config"
    editor, aside, before, hidden = unsaved(launch, config)
    number = getattr(signal, name)
    editor.process.send_signal(number)
    assert editor.process.wait(60) == 128 + number
    assert aside.read_text() != before and '"changes": "3"' in aside.read_text()
    assert name in editor.output()


def test_ended_by_a_signal_with_nothing_to_save_leaves_nothing(launch, tmp_path):
    config = tmp_path / "config"
    editor = launch(CORNELL, config=config)
    editor.wait(lambda s: s["counts"]["instances"] > 0 and not s["opening"], "the scene")
    editor.process.send_signal(signal.SIGTERM)
    assert editor.process.wait(60) == 128 + signal.SIGTERM
    assert not (config / "recovery").exists() or list((config / "recovery").iterdir()) == []


def test_a_lost_display_loses_nothing(binary, tmp_path):
    """The X server is killed, as in a crash of the desktop."""
    own = Desk(tmp_path / "screen")
    running = []

    def start(*arguments, config, **more):
        running.append(Editor(own, binary, *arguments, config=config, probe=tmp_path / "probe.json", **more))
        return running[-1]

    try:
        editor, aside, before, hidden = unsaved(start, tmp_path / "config")
        own.server.kill()
        assert editor.process.wait(60) == 1
        assert aside.read_text() != before and '"changes": "3"' in aside.read_text()
    finally:
        for editor in running:
            editor.close()
        own.close()


class ClientMessage(ctypes.Structure):  # XClientMessageEvent
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p),
                ("window", ctypes.c_ulong), ("message_type", ctypes.c_ulong), ("format", ctypes.c_int), ("data", ctypes.c_long * 5),
                ("rest_of_XEvent", ctypes.c_long * 24)]


def ask_to_close(display, window):
    """Like a window manager: WM_DELETE_WINDOW."""
    x = ctypes.CDLL("libX11.so.6")
    x.XOpenDisplay.restype = ctypes.c_void_p
    x.XInternAtom.restype = ctypes.c_ulong
    server = ctypes.c_void_p(x.XOpenDisplay(display.encode()))
    atom = lambda name: x.XInternAtom(server, name, 0)
    event = ClientMessage(type=33, window=window, message_type=atom(b"WM_PROTOCOLS"), format=32)
    event.data[0] = atom(b"WM_DELETE_WINDOW")
    x.XSendEvent(server, ctypes.c_ulong(window), 0, ctypes.c_long(0), ctypes.byref(event))
    x.XSync(server, 0)
    x.XCloseDisplay(server)


def test_a_close_request_autosaves_before_it_is_answered(launch, desk, tmp_path):
    """At the end of its session a desktop requests windows to close, and does not wait long."""
    editor, aside, before, hidden = unsaved(launch, tmp_path / "config")
    found = subprocess.run(["xdotool", "search", "--name", "Restage"], env=desk.environment, check=True, capture_output=True, text=True)
    ask_to_close(desk.display, int(found.stdout.split()[-1]))
    editor.wait(lambda s: s["modal"] == "Unsaved changes", "the question")
    assert '"changes": "3"' in aside.read_text()
    editor.kill()
    offered_with(launch, tmp_path / "config", hidden)
