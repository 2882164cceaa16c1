"""Time of a frame of the page, and of a kick until it is drawn, in Chromium.

PYTHONPATH=.:test python test/web/frame_cost.py prints them for some scenes. Computing is what the
page's own script does in a frame: states, sentences, charts and the commands for the scene; the
drawing itself is the graphics card's. Without one, software draws on the same processors, so that
the times are printed once more without the commands that draw. A kick counts from the event of its
key to the end of the frame that draws it, when the browser has all of its picture.
"""

import itertools
import statistics
import tempfile
from pathlib import Path

from browser import running_browser
from web.opened import Opened

from symtop_ros.web.join import write_file

SCENES = "hurry_slow", "cusps", "looping", "friction"
FRAMES, KICKS = 120, 15
WARM = 3000  # ms after which the browser has compiled what runs often
# Times the callbacks of each frame; a kick ends with the first that begins after it.
MEASURE = """
window.frames_ms = [];
let kicked = null, last = 0;
const requestOwn = window.requestAnimationFrame.bind(window);
window.requestAnimationFrame = (draw) => requestOwn((now) => {
  const begin = performance.now();
  draw(now);
  const end = performance.now();
  if (now !== last) window.frames_ms.push(0);
  last = now;
  window.frames_ms[window.frames_ms.length - 1] += end - begin;
  if (kicked) kicked(end);
  kicked = null;
});
window.kick_ms = () => new Promise((done) => {
  const begin = performance.now();
  document.dispatchEvent(new KeyboardEvent("keydown", { key: "h" }));
  kicked = (end) => done(end - begin);
});
"""
# What a graphics card does costs the page nothing, as far as that can be had without one.
LEAVE_OUT = """
for (const name of ["drawArrays", "drawElements", "bufferData", "bufferSubData", "bindVertexArray",
  "bindBuffer", "uniform1f", "uniform3fv", "uniform4fv", "uniformMatrix3fv", "uniformMatrix4fv",
  "depthMask", "clear", "clearColor", "enable", "disable", "viewport", "useProgram"]) {
  WebGL2RenderingContext.prototype[name] = () => {};
}
"""
WAYS = {"drawn by software": "", "not drawn": LEAVE_OUT}


def measure(browser, path, scene, script):
    """Return the times of frames and of kicks in ms."""
    page = Opened(browser, path, f"#scene={scene}", script=script)
    page.tab.wait_for_timeout(WARM)
    page.tab.evaluate("window.frames_ms = [0]")
    page.until(lambda: page.tab.evaluate("window.frames_ms.length") >= FRAMES)
    frames = page.tab.evaluate("window.frames_ms")
    kicks = []
    for _ in range(KICKS):
        kicks.append(page.tab.evaluate("window.kick_ms()"))
        page.tab.click("text=Reset")
    page.context.close()
    return frames, kicks


def main():
    with tempfile.TemporaryDirectory() as folder, running_browser() as browser:
        path = Path(folder, "top.html")
        path.write_text(write_file(), encoding="utf-8")
        for name, scene in itertools.product(WAYS, SCENES):
            script = WAYS[name] + MEASURE
            frames, kicks = (sorted(times) for times in measure(browser, path, scene, script))
            print(
                f"{name:17} {scene:12} a frame {statistics.median(frames):5.2f} ms, 95 % below "
                f"{frames[int(0.95 * len(frames))]:5.2f} ms; a kick until it is drawn "
                f"{statistics.median(kicks):5.1f} ms, at most {kicks[-1]:5.1f} ms"
            )


if __name__ == "__main__":
    main()
