# SPDX-License-Identifier: Apache-2.0
"""Records a Desk's screen as an animated WebP. Writing it needs Pillow, which the project does not install."""
import threading
import time

import numpy as np


class Recorder:
    """Takes screenshots on a thread until stop()."""

    def __init__(self, desk, per_second=8, crop=(slice(None), slice(None))):
        """`crop`: rows and columns of the screen."""
        self.desk, self.pause, self.crop = desk, 1 / per_second, crop
        self.pictures = []  # (time [s], height x width x 3) of each change
        self.done = threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()
        while not self.pictures:
            time.sleep(0.01)

    def _run(self):
        while not self.done.wait(self.pause):
            try:
                picture = self.desk.screenshot()[self.crop].copy()
            except ValueError:  # the server was writing
                continue
            if not self.pictures or not np.array_equal(picture, self.pictures[-1][1]):
                self.pictures.append((time.monotonic(), picture))

    def stop(self):
        self.done.set()
        self.thread.join()

    def write(self, path, seconds, width, quality=55, longest=0.6):
        """In about so many seconds: no picture is shown for longer than `longest` [s] of the recording, and the rest
        is shown faster or slower alike. The last one stays for 1.5 s."""
        from PIL import Image

        times = np.array([at for at, _ in self.pictures])
        shown = np.minimum(np.diff(times), longest)
        shown *= (seconds - 1.5) / max(shown.sum(), 1e-9)
        frames, durations, late = [], [], 0.0
        for (_, picture), duration in zip(self.pictures, [*shown, 1.5]):
            late += duration
            if late < 0.08 and duration != 1.5:  # shorter than a frame of the file: it shows the next one instead
                continue
            image = Image.fromarray(picture)
            frames.append(image.resize((width, round(image.height * width / image.width)), Image.Resampling.LANCZOS))
            durations.append(round(late * 1000))
            late = 0.0
        frames[0].save(path, save_all=True, append_images=frames[1:], duration=durations, loop=0, quality=quality, method=4,
                       minimize_size=True)
