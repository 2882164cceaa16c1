"""Films of the page's own pictures, whose true values are known, and clicks in them."""

import base64
import io
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from drawn import Numbers, cos
from films import write_film
from page.web.modules import load_kernel
from PIL import Image

from symtop_ros.base.arrays import Real
from symtop_ros.page.web.join import read_texts
from symtop_ros.physics import Motion, State, Top
from symtop_ros.run.simulation.fields import TABLE
from symtop_ros.run.simulation.run_file import RunEvent, write_run

SIZE = 640, 480  # px of a film
IX = 2.0**-10  # kg m^2
SCATTER = 1.0  # px of a click
RATES = {30: 4.0, 120: 2.5}  # frames a second, and s of a film
MOST = 150  # frames that are clicked, evenly: 20 to 200 on the page


def _make_motion(weight: float, p: float, ratio: float, theta: float, phi_dot: float) -> Motion:
    """Return the motion with some Mgl/Ix, p_psi/Ix and Iz/Ix."""
    psi_dot = p / ratio - phi_dot * cos(theta)
    top = Top(IX, ratio * IX, weight * IX)
    return Motion(top, State.from_euler(theta=theta, phi_dot=phi_dot, psi_dot=psi_dot))


MOTIONS = {
    "slow": _make_motion(60.0, 19.0, 0.5, 0.625, 1.5),
    "middle": _make_motion(90.0, 26.0, 0.25, 0.5, 1.25),
    "disc": _make_motion(140.0, 30.0, 1.5, 0.75, 2.0),
}
# Eight lengths of the axis away, 30 degrees above the pivot. The page draws 960 lines, of which the
# middle ones are the film: a telephoto lens.
EYE = (4.5, -5.25, 4.0)
# A frame of the scene at each time, with the true places of the ball and the pivot in it.
DRAW = """async ([run, fields, layers, times, eye, [width, height]]) => {
  document.body.innerHTML = `<canvas id="picture" style="display: block; width: ${2 * width}px;
    height: ${2 * height}px"></canvas><div id="labels"></div><ul id="legend"></ul>
    <select id="unit"></select>`;
  const { LocalTop } = await import("/run/local.js");
  const { Scene } = await import("/scene/scene.js");
  const top = new LocalTop(kernel, { run_fields: fields, layers });
  top.load(run);
  const scene = new Scene(top);
  scene.begin();
  scene.camera.place(eye, [0, 0, 0]);
  const film = Object.assign(document.createElement("canvas"), { width, height });
  const context = film.getContext("2d");
  const see = (point) => {
    const { x, y } = scene.camera.project(point);
    return [x - width / 2, y - height / 2];
  };
  const frames = times.map((time) => {
    top.time = Math.round(1e9 * time);
    scene.draw(top.state, []);
    context.fillStyle = "white";
    context.fillRect(0, 0, width, height);
    context.drawImage(scene.painter.canvas, -width / 2, -height / 2);
    return [film.toDataURL("image/png").split(",")[1], see(top.state.toWorld([0, 0, 1]))];
  });
  return [frames, see([0, 0, 0])];
}"""


@dataclass(frozen=True, eq=False)
class PageFilm:
    """A film of the page: its file, the times of its frames, and true places.

    Attributes
    ----------
    path : Path
    motion : Motion
    times : (n,) array
    balls : (n, 2) array
        px to the right and down.
    pivot : (2,) array
    """

    path: Path
    motion: Motion
    times: Real
    balls: Real
    pivot: Real

    def click(self, seed: int) -> dict[str, Any]:
        """Return places with scatter: of the ball in even steps of frames, and of the pivot."""
        step = -(-len(self.times) // MOST)
        frames = np.arange(0, len(self.times), step)
        noise = SCATTER * Numbers(seed).normals(len(frames) + 1, 2)
        balls = self.balls[frames] + noise[1:]
        return {
            "frames": frames.tolist(),
            "balls": balls.tolist(),
            "true": self.balls[frames].tolist(),
            "pivot": (self.pivot + noise[0]).tolist(),
        }


def find_truth(motion: Motion) -> dict[str, float]:
    """Return the numbers of a motion that the trial reads, by their names in the table."""
    momentum = motion.top.Iz * motion.start.angular_velocity[2] / motion.top.Ix
    return {
        "p_psi/Ix": float(momentum),
        "Mgl/Ix": motion.top.Mgl / motion.top.Ix,
        "mean precession": float(motion.mean_precession_rate),
    }


def list_times(rate: int, seconds: float) -> list[float]:
    """Return the times of frames: a film of WebM has whole milliseconds."""
    return [round(1000 * k / rate) / 1000 for k in range(round(rate * seconds))]


def draw_film(tab: Any, path: Path, motion: Motion, rate: int, seconds: float) -> PageFilm:
    """Draw a motion by the page's own scene, in a tab of its modules, and write it as a film."""
    load_kernel(tab)
    times = list_times(rate, seconds)
    end = round(1e9 * times[-1])
    run = write_run([RunEvent("start", 0, motion, {})], end)
    frames, pivot = tab.evaluate(DRAW, [run, TABLE, {"handle": True}, times, EYE, SIZE])
    pictures = (
        np.asarray(Image.open(io.BytesIO(base64.b64decode(p))).convert("RGB")) for p, _ in frames
    )
    write_film(path, pictures, times)
    places = np.array([place for _, place in frames])
    return PageFilm(path, motion, np.array(times), places, np.array(pivot))


# What a hand does on the page, by the events of a pointer. `given` are the arguments.
HAND = """
const wait = async (holds, most = 2400) => {
  for (let k = 0; k < most && !holds(); k += 1) await new Promise((done) => setTimeout(done, 25));
  if (!holds()) throw new Error(`${holds} does not hold: ${find("refusal").textContent}`);
};
const find = (id) => document.getElementById(id);
const say = (id) => find(id).textContent;
const picture = find("film-picture");
const press = (place, [width, height]) => {
  const box = picture.getBoundingClientRect();
  const scale = Math.min(box.width / width, box.height / height);
  const clientX = box.left + box.width / 2 + scale * (place[0] - width / 2);
  const clientY = box.top + box.height / 2 + scale * (place[1] - height / 2);
  for (const kind of ["pointerdown", "pointerup"])
    picture.dispatchEvent(new PointerEvent(kind, { clientX, clientY, bubbles: true }));
};
// Colours of what is seen around a place of the film; marks may cover some of it.
const NEAR = [[0, 0], [-4, 0], [4, 0], [0, -4], [0, 4]];
const look = (place, [width, height]) => {
  const copy = Object.assign(document.createElement("canvas"), { width: 1, height: 1 });
  const context = copy.getContext("2d", { willReadFrequently: true });
  const scale = Math.min(picture.width / width, picture.height / height);
  return NEAR.map(([right, down]) => {
    const x = picture.width / 2 + scale * (place[0] + right - width / 2);
    const y = picture.height / 2 + scale * (place[1] + down - height / 2);
    context.drawImage(picture, -Math.floor(x), -Math.floor(y));
    return [...context.getImageData(0, 0, 1, 1).data];
  });
};
"""
OPEN = f"""{HAND}
const [data, name, pivot, count, size] = given;
const bytes = Uint8Array.from(atob(data), (each) => each.charCodeAt(0));
const dataTransfer = new DataTransfer();
dataTransfer.items.add(new File([bytes], name));
document.dispatchEvent(new DragEvent("drop", {{ dataTransfer, cancelable: true }}));
const isRead = () => say("measured-name").includes(name + ":");
await wait(() => isRead() || !find("replace").hidden);
if (!isRead()) find("replace-film").click(); // the clicks in the film before
await wait(isRead);
await wait(() => say("film-clock").startsWith("frame 1 of"));
find("wanted-frames").value = count; // the next frame follows a click
find("wanted-frames").dispatchEvent(new Event("input", {{ bubbles: true }}));
press(pivot, size);
return say("measured-name");
"""
CLICK = f"""{HAND}
const [frames, balls, exact, size] = given;
const found = [];
for (const [k, frame] of frames.entries()) {{
  find("film-line").value = frame;
  find("film-line").dispatchEvent(new Event("input"));
  await wait(() => say("film-clock").startsWith(`frame ${{frame + 1}} of`));
  await new Promise((done) => setTimeout(done, 0));
  found.push([say("film-clock"), look(exact[k], size)]);
  press(balls[k], size);
}}
return found;
"""
FIT = f"""{HAND}
const [isNear, size] = given;
const {{ width, height }} = picture.getBoundingClientRect();
const scale = Math.min(width / size[0], height / size[1]);
find("near-camera").checked = isNear;
find("near-camera").dispatchEvent(new Event("input", {{ bubbles: true }}));
find("fitted").replaceChildren();
find("fit-record").click();
await wait(() => find("fitted-shown") || say("refusal"), 3600);
const rows = [...document.querySelectorAll("#fitted-numbers tbody tr")];
return {{
  refusal: say("refusal"),
  scale,
  shown: find("fitted-shown")?.dataset.text,
  verdict: find("fitted-verdict")?.dataset.text,
  table: rows.map((row) => [...row.children].map((each) => each.dataset.text)),
  points: window.symtop.run().points,
  command: find("fit-command").value,
}};
"""
CHUNK = 50  # frames that are clicked by one script, which has its time


def measure_film(run: Any, film: PageFilm, seed: int, is_near: bool = True) -> Mapping[str, Any]:
    """Open a film on a page that runs scripts, click in it, fit; return what the page says."""
    clicks, size = film.click(seed), list(SIZE)
    data = base64.b64encode(film.path.read_bytes()).decode()
    said = run(OPEN, data, film.path.name, clicks["pivot"], len(clicks["frames"]), size)
    seen = []
    for begin in range(0, len(clicks["frames"]), CHUNK):
        part = slice(begin, begin + CHUNK)
        seen += run(CLICK, *(clicks[name][part] for name in ("frames", "balls", "true")), size)
    return {"said": said, "seen": seen, "clicks": clicks, **run(FIT, is_near, size)}


def make_label(name: str) -> str:
    """Return the name of a number in the table of the page."""
    return read_texts("en").get(f"fitted.name.{name}", name)


def find_allowed(count: int) -> tuple[float, float]:
    """Return limits of the root mean square of normal numbers, each passed once in 1000 draws.

    By Wilson and Hilferty the cube root of chi^2/n is nearly normal.
    """
    part = 2 / (9 * count)
    low, high = ((1 - part + side * 3.09 * math.sqrt(part)) ** 1.5 for side in (-1, 1))
    return low, high
