# SPDX-License-Identifier: Apache-2.0
"""For all tests written in Python."""
import signal

# A suite started in the background (nohup, a shell's &) has these ignored, and children inherit that.
for name, usual in (("SIGINT", signal.default_int_handler), ("SIGHUP", signal.SIG_DFL)):
    if hasattr(signal, name) and signal.getsignal(getattr(signal, name)) is signal.SIG_IGN:
        signal.signal(getattr(signal, name), usual)
