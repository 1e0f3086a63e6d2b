#!/usr/bin/env python3
"""How fast a view turns, and what memory it takes: `tests/view/frames.py out/report.html [WIDTHxHEIGHT]`.

Turns the view for some seconds, as a hand would, and prints the frames a second, first as the view draws at once and
then as it draws after it has found its pace, and the memory of JavaScript. Drawn in software unless `--gpu` is given."""

import sys
import time

from browser import Browser

TURN = """new Promise((done) => {
  const view = document.querySelector(".bernal-view").bernal, act = view.actions();
  const start = performance.now(), first = view.frames, end = start + %d;
  const step = (now) => {
    act.turn(0.02, 0.002);
    if (now < end) return requestAnimationFrame(step);
    const seconds = (performance.now() - start) / 1000;
    act.rest();
    done({ rate: (view.frames - first) / seconds, scale: view.pace.scale, rings: view.pace.rings,
           shell: view.pace.shell, width: view.renderer.width, height: view.renderer.height });
  };
  requestAnimationFrame(step);
})"""


def main():
    words = [word for word in sys.argv[1:] if not word.startswith("--")]
    width, height = map(int, (words[1] if len(words) > 1 else "1160x900").split("x"))
    with Browser(width, height, software="--gpu" not in sys.argv) as browser:
        start = time.monotonic()
        browser.open(words[0], timeout=300)
        print(f"opened after {time.monotonic() - start:.1f} s")
        view = 'document.querySelector(".bernal-view").bernal'
        browser.run('document.querySelector(".bernal-view").scrollIntoView({block: "center"})')
        browser.settle()
        gl = browser.run(f"(() => {{ const gl = {view}.renderer.gl, info = gl.getExtension('WEBGL_debug_renderer_info');"
                         "return gl.getParameter(info.UNMASKED_RENDERER_WEBGL); })()")
        shown, canvas = browser.run(f"{view}.data.shown"), browser.run(f"[{view}.canvas.width, {view}.canvas.height]")
        print(f"{shown} spheres on {canvas[0]} x {canvas[1]} pixels, {gl}")
        for what in ("at once", "at its pace"):
            turned = browser.run(TURN % 6000, timeout=300)
            print(f"{what}: {turned['rate']:.1f} frames/s, drawn as {turned['width']} x {turned['height']}, "
                  f"{turned['rings']} rings of shading, {'shell' if turned['shell'] else 'all spheres'}")
        browser.settle(1)
        still = browser.run(f"(() => {{ const v = {view}, t = performance.now(); v.drawNow(v.scaleAtRest());"
                            "v.renderer.gl.readPixels(0, 0, 1, 1, v.renderer.gl.RGBA, v.renderer.gl.UNSIGNED_BYTE,"
                            "new Uint8Array(4)); return performance.now() - t; })()")
        print(f"a picture at rest: {still:.0f} ms")
        browser.call("HeapProfiler.collectGarbage")
        memory = browser.run("performance.memory.usedJSHeapSize")
        arrays = browser.run(f"(() => {{ const d = {view}.data; return [d.spheres, d.indices, d.depths, "
                             f"{view}.bytes, ...d.columns.map((c) => c.values)].reduce((s, a) => s + a.byteLength, 0); }})()")
        print(f"memory of JavaScript: {memory / 2**20:.1f} MiB; numbers of spheres among it or beside it: "
              f"{arrays / 2**20:.1f} MiB")


main()
