#!/usr/bin/env python3
"""`in_chromium.py COMMAND [FOLDER]`: packs, opens the reports in Chromium, and holds what is drawn and picked against
what follows from spheres.csv. Pictures of all pages go to FOLDER. Exits 77 where Chromium or python3-pil is missing."""

import csv
import io
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import time

import browser as chromium

try:
    from PIL import Image, ImageChops
except ImportError:
    sys.exit(print("skipped: install python3-pil") or 77)
if not chromium.executable():
    sys.exit(print("skipped: install chromium") or 77)

COMMAND = pathlib.Path(sys.argv[1]).resolve()
DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
VIEW = 'document.querySelector(".bernal-view").bernal'
PERIODIC = """unit = "mm"
[container]
kind = "periodic"
[spheres]
count = 1500
radius = { distribution = "lognormal", median = 1.0, sigma = 0.3, basis = "number" }
"""
# Far from the origin, in nanometres of a metre: digits are what is tested.
FAR = """unit = "m"
[container]
kind = "box"
corner = [1e-3, -2e-3, 5e-4]
size = [1e-6, 1e-6, 1e-6]
[spheres]
count = 300
diameter = 1e-7
"""
FULL = """unit = "mm"
[container]
kind = "sphere"
radius = 5.0
[spheres]
count = 5000
diameter = 2.0
"""


def check(holds, what):
    if not holds:
        raise AssertionError(what)


def packed(folder, name, scene, code=0):
    """The folder of a result."""
    if not isinstance(scene, pathlib.Path):
        file = folder / f"{name}.toml"
        file.write_text(scene)
        scene = file
    extra = ["--unit", "mm", "--diameter", "5"] if scene.suffix == ".stl" else []
    done = subprocess.run([COMMAND, "pack", scene, "-o", folder / name, "--quiet", *extra], capture_output=True, text=True)
    check(done.returncode == code, f"{name}: exit {done.returncode}, not {code}: {done.stderr}")
    return folder / name


def spheres_of(result):
    rows = list(csv.reader(line for line in (result / "spheres.csv").open() if not line.startswith("#")))
    return [[float(x) for x in row] for row in rows[1:]]


def without_spheres(result, folder):
    """The report of a run that placed none in the same container: what unit tests find in such a page."""
    folder.mkdir()
    page = (result / "report.html").read_text()
    head, rest = page.split('class="bernal-data">')
    data, tail = rest.split("</script>", 1)
    data = json.loads(data) | {"count": 0, "shown": 0, "columns": [], "spheres": {"centers": "", "radii": ""}}
    (folder / "report.html").write_text(head + 'class="bernal-data">' + json.dumps(data) + "</script>" + tail)
    (folder / "spheres.csv").write_text("# unit: mm\nx,y,z,r\n")
    return folder


class Shown:
    """A report in the window."""

    def __init__(self, page, result):
        self.page = page
        page.open(result / "report.html")
        page.run('document.querySelector(".bernal-view").scrollIntoView({block: "center"})')
        page.settle()
        box = page.run(f"(() => {{ const b = {VIEW}.canvas.getBoundingClientRect();"
                       "return [b.left, b.top, b.width, b.height]; })()")
        self.left, self.top, self.width, self.height = box
        self.spheres = spheres_of(result)

    def act(self, script):
        self.page.run(f"(() => {{ const view = {VIEW}; {script} }})()")
        self.page.settle()

    def picture(self):
        """The pixels of the stage, as the window has them."""
        shot = self.page.call("Page.captureScreenshot", format="png",
                              clip={"x": self.left, "y": self.top + self.page.run("window.scrollY"),
                                    "width": self.width, "height": self.height, "scale": 1})
        return Image.open(io.BytesIO(chromium.base64.b64decode(shot["data"]))).convert("RGB")

    def background(self):
        return tuple(self.page.run(f"Array.from({VIEW}.theme.background, (x) => Math.round(255 * x))"))

    def camera(self):
        return self.page.run(f"(() => {{ const v = {VIEW}, c = v.camera; return {{ right: [...c.right], up: [...c.up],"
                             "eye: [...c.eye], target: [...c.target], half: c.half, origin: v.data.origin,"
                             "scale: v.data.scale, cut: [...v.cut] }; })()")

    def expected(self, x, y, camera):
        """(index, margin) of what is seen at a pixel: of lines of sight that pass nearer than `margin` pixels to where
        another thing is seen nobody can tell. From spheres.csv, in double precision."""
        unit = 2 * camera["half"] / self.height  # of a pixel
        sx, sy = (x - self.width / 2) * unit, (self.height / 2 - y) * unit
        dot = lambda a, b: sum(p * q for p, q in zip(a, b))
        n, d = camera["cut"][:3], camera["cut"][3]
        slope = dot(n, camera["eye"])
        start = [t + sx * r + sy * u for t, r, u in zip(camera["target"], camera["right"], camera["up"])]
        best, nearest, margin = None, -math.inf, math.inf
        heights = []
        for index, row in enumerate(self.spheres):
            *center, r = row
            center += [0] * (3 - len(center))
            c = [(p - o) / camera["scale"] - s for p, o, s in zip(center, camera["origin"], start)]
            r /= camera["scale"]
            height = dot(c, camera["eye"])
            off = math.sqrt(max(0, dot(c, c) - height * height))
            margin_here = abs(off - r) / unit
            if off >= r:
                margin = min(margin, margin_here)
                continue
            half = math.sqrt(r * r - off * off)
            at = height + half
            if any(n):
                room = (d - dot(n, start)) - slope * at  # of the cut, before the surface
                if room < 0:
                    if slope <= 0:
                        continue
                    at = (d - dot(n, start)) / slope
                    if not height - half <= at <= height + half:
                        margin = min(margin, abs(at - height - half) / unit, abs(at - height + half) / unit)
                        continue
            margin = min(margin, margin_here)
            heights.append(at)
            if at > nearest:
                best, nearest = index, at
        return best, margin

    def card(self):
        text = self.page.run('(() => { const c = document.querySelector(".bernal-card");'
                             'return c.hidden ? "" : c.querySelector("b").textContent; })()')
        return int(text.split()[1].rstrip(",")) if text else None


def differing(one, other):
    """The share of pixels that are not the same."""
    mask = ImageChops.difference(one, other).convert("L").point(lambda v: 255 if v > 12 else 0)
    return mask.histogram()[255] / (one.width * one.height)


def test_pixels(shown, name, samples=300):
    """Where a line of sight meets a sphere there is one, elsewhere the background."""
    shown.act("view.show('walls', false); view.show('lines', false); view.select(null);")
    shown.page.run('document.querySelectorAll(".bernal-key, .bernal-labels, .bernal-note").forEach('
                   '(e) => { e.style.visibility = "hidden"; })')
    picture, camera, background = shown.picture(), shown.camera(), shown.background()
    draw = random.Random(name)
    met = missed = 0
    while met + missed < samples or min(met, missed) < 20:
        x, y = draw.randrange(12, int(shown.width) - 12), draw.randrange(12, int(shown.height) - 12)
        index, margin = shown.expected(x + 0.5, y + 0.5, camera)
        if margin < 1.5:
            continue
        is_background = max(abs(a - b) for a, b in zip(picture.getpixel((x, y)), background)) <= 2
        check(is_background == (index is None), f"{name}: pixel {x}, {y} with sphere {index}: {picture.getpixel((x, y))}")
        met, missed = met + (index is not None), missed + (index is None)
    shown.page.run('document.querySelectorAll(".bernal-key, .bernal-labels, .bernal-note").forEach('
                   '(e) => { e.style.visibility = ""; })')
    return met


def test_clicks(shown, name, wanted=15):
    """A click tells the number of the sphere that is there."""
    camera, draw, told = shown.camera(), random.Random(name), 0
    for _ in range(3000):
        x, y = draw.randrange(220, int(shown.width) - 320), draw.randrange(20, int(shown.height) - 130)
        index, margin = shown.expected(x, y, camera)
        if margin < 1 or index is None:
            continue
        shown.page.click(shown.left + x, shown.top + y)
        check(shown.card() == index, f"{name}: a click at {x}, {y} tells {shown.card()}, not {index}")
        told += 1
        if told == wanted:
            return
    raise AssertionError(f"{name}: only {told} spheres could be clicked")


def test_colours(shown, name, expected):
    """Every choice of colours looks different, and has a key."""
    keys = shown.page.run(f"{VIEW}.data.columns.map((c) => c.key)")
    check(keys == expected, f"{name}: colours by {keys}")
    pictures = []
    for key in keys:
        shown.act(f"view.colourBy('{key}');")
        pictures.append(shown.picture())
        title = shown.page.run('document.querySelector(".bernal-key b").textContent')
        check(title.startswith(shown.page.run(f"{VIEW}.state.column.title")), f"{name}: the key says {title}")
    for one, other, key in zip(pictures, pictures[1:], keys[1:]):
        check(differing(one, other) > 0.01, f"{name}: by {key} nothing changes")
    shown.act("view.colourBy('radius');")


def test_cut(shown, name):
    before = shown.picture()
    for axis in range(3):
        shown.act(f"view.cutAcross({axis});")
        check(differing(before, shown.picture()) > 0.02, f"{name}: a cut across {'xyz'[axis]} changes nothing")
        test_pixels(shown, f"{name} cut {axis}", 120)
        test_clicks(shown, f"{name} cut {axis}", 6)
    shown.act("view.cutAcross(-1);")


def test_keys(shown, name, flat=False):
    page = shown.page
    page.run(f"{VIEW}.canvas.focus()")
    state = lambda: page.run(f"(() => {{ const v = {VIEW}; return [v.camera.azimuth, v.camera.elevation, v.camera.half,"
                             "v.camera.target[0], v.state.column.key, v.state.cutAxis, v.state.lines,"
                             "v.panel.keys.hidden, v.state.selected]; })()")
    first = state()
    for key, place in [("ArrowLeft", 3 if flat else 0), ("+", 2), ("m", 4), ("o", 6), ("?", 7)] + ([] if flat else [("c", 5)]):
        before = state()
        page.key(key)
        check(state()[place] != before[place], f"{name}: the key {key} does nothing")
    page.key("Escape")
    check(state()[7], f"{name}: Escape does not close the list of keys")
    page.key("0")
    check(abs(state()[2] / first[2] - 1) < 1e-6, f"{name}: 0 does not lead back")
    page.key("o")
    if not flat:
        page.key("c"), page.key("c"), page.key("c")
        before = state()
        page.drag((shown.left + 300, shown.top + 100), (shown.left + 380, shown.top + 140))
        check(state()[0] != before[0] and state()[1] != before[1], f"{name}: dragging does not turn")
    before = state()
    page.mouse("mouseWheel", shown.left + 300, shown.top + 200, deltaX=0, deltaY=-120)
    page.settle(0.2)
    check(state()[2] < before[2], f"{name}: the wheel does not bring it nearer")
    page.key("0")
    page.settle()


def wait(page, condition, what, seconds=60):
    end = time.monotonic() + seconds
    while not page.run(condition):
        check(time.monotonic() < end, what)
        page.settle(0.1)


def test_lost_context(shown, name):
    page = shown.page
    shown.act("view.select(null);")
    page.settle(1.5)
    before = shown.picture()
    shown.act("window.loser = view.renderer.gl.getExtension('WEBGL_lose_context'); window.loser.loseContext();")
    wait(page, f"{VIEW}.lost", f"{name}: does not notice that the graphics processor is away")
    frames = page.run(f"(() => {{ window.loser.restoreContext(); return {VIEW}.frames; }})()")
    wait(page, f"!{VIEW}.lost && {VIEW}.frames > {frames}", f"{name}: does not draw when the graphics processor is back")
    page.settle(1.5)
    share = differing(before, shown.picture())
    check(share < 0.01, f"{name}: {share:.3f} of the pixels differ after the graphics processor was away")


def still_is_seen(page, result):
    """Whether the picture is there and the view is not."""
    page.open(result / "report.html")
    box = 'document.querySelector("%s").getBoundingClientRect().height'
    answer = page.call("Runtime.evaluate", expression=f"[{box % '.picture svg'}, {box % '.bernal-view'}]",
                       returnByValue=True)["result"]["value"]
    return answer[0] > 100 and answer[1] == 0


def main():
    pictures = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else pathlib.Path(tempfile.mkdtemp())
    pictures.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        part = packed(folder, "part", DATA / "meshes" / "lib3mf_helix.stl")
        box = packed(folder, "box", PERIODIC)
        far = packed(folder, "far", FAR)
        discs = packed(folder, "discs", DATA / "scenes" / "discs_in_polygon.toml")
        five = packed(folder, "five", DATA / "scenes" / "fly_five_dimensions.toml")
        full = packed(folder, "full", FULL, 3)
        empty = without_spheres(full, folder / "empty")

        with chromium.Browser() as page:
            for name, result, columns in [("part", part, ["radius", "contacts", "gap", "wall", "local"]),
                                          ("box", box, ["radius", "contacts", "gap", "local"]),
                                          ("far", far, ["radius", "contacts", "gap", "wall", "local"]),
                                          ("discs", discs, ["radius", "contacts", "gap", "wall", "local"])]:
                shown = Shown(page, result)
                flat = name == "discs"
                page.screenshot(pictures / f"{name}.png")
                check(test_pixels(shown, name) > 20, f"{name}: nothing is drawn")
                test_clicks(shown, name)
                page.screenshot(pictures / f"{name}_card.png")
                page.run(f"{VIEW}.select(null)")
                test_colours(shown, name, columns)
                if not flat:
                    test_cut(shown, name)
                test_keys(shown, name, flat)
                test_lost_context(shown, name)
                if name == "box":
                    before = shown.picture()
                    shown.act("view.show('images', true);")
                    check(differing(before, shown.picture()) > 0.05, "images change nothing")
                    shown.act("view.cutAcross(1);")
                    page.screenshot(pictures / "box_images.png")
                if name == "part":
                    before = shown.picture()
                    shown.act("view.show('walls', true); view.show('lines', true);")
                    check(differing(before, shown.picture()) > 0.002, "the container is not seen")
                    shown.act("view.cutAcross(1);")
                    page.screenshot(pictures / "part_cut.png")
                complaints = page.complaints()
                check(complaints == [], f"{name}: the console says {complaints}")
                print(f"{name}: as it should be, {len(shown.spheres)} spheres", flush=True)

            for name, result in [("full", full), ("empty", empty)]:
                shown = Shown(page, result)
                picture, background = shown.picture(), Image.new("RGB", (int(shown.width), int(shown.height)))
                background.paste(shown.background(), (0, 0, *background.size))
                check(differing(picture.resize(background.size), background) > 0.001, f"{name}: nothing is drawn")
                note = page.run('document.querySelector(".bernal-note").textContent')
                check((note == "no spheres") == (name == "empty"), f"{name}: the note says {note}")
                page.screenshot(pictures / f"{name}.png")
                check(page.complaints() == [], f"{name}: the console says {page.complaints()}")

            page.open(five / "report.html")
            check(page.run('document.querySelector(".bernal-view, script") === null'), "five dimensions have a view")
            check(page.run('document.querySelectorAll(".chart").length > 0'), "five dimensions have no plots")
            page.screenshot(pictures / "five.png")

            page.open(part / "report.html")
            page.call("Emulation.setEmulatedMedia", media="print")
            check(page.run('getComputedStyle(document.querySelector(".bernal-view")).display') == "none",
                  "the view is printed")

        with chromium.Browser(width=390, height=844, dark=True) as page:  # a telephone, at night
            shown = Shown(page, part)
            page.screenshot(pictures / "narrow_dark.png")
            check(sum(shown.background()) < 200, "dark is not dark")
            check(page.run("document.documentElement.scrollWidth <= innerWidth"), "the page is wider than the window")
        with chromium.Browser(graphics=False) as page:
            check(still_is_seen(page, part), "without WebGL the picture is not seen alone")
        with chromium.Browser(script=False) as page:
            check(still_is_seen(page, part), "without JavaScript the picture is not seen alone")
    print(f"pictures are in {pictures}")


main()
