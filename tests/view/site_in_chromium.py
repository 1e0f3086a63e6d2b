#!/usr/bin/env python3
"""`site_in_chromium.py SITE [FOLDER]`: opens every page of the site on a telephone, where none may scroll sideways and
nothing may be cut without a place to scroll it; and types the questions of tests/guide/search.py into its search.
Pictures of some pages go to FOLDER. Exits 77 where Chromium or the site is missing."""

import pathlib
import sys

import browser as chromium

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "guide"))
import search  # noqa: E402

SITE = pathlib.Path(sys.argv[1]).resolve()
if not chromium.executable():
    sys.exit(print("skipped: install chromium") or 77)
if not (SITE / "index.html").exists():
    sys.exit(print("skipped: there is no site; install pandoc and build") or 77)

SHOWN = ["index", "guide/part", "guide/measure", "guide/formats", "results/reaches", "reference/scene", "reference/report"]
# What reaches beyond the window, and beyond all that could be scrolled or was made to be seen elsewhere.
CUT = """[...document.querySelectorAll("main *, nav *")].filter((element) => {
  if (element.getBoundingClientRect().right <= innerWidth + 1) return false;
  for (let at = element; at !== document.body; at = at.parentElement)
    if (["auto", "scroll"].includes(getComputedStyle(at).overflowX)) return false;
  return true;
}).slice(0, 3).map((element) => `<${element.localName}> ${element.textContent.trim().slice(0, 40)}`)"""
FOUND = '[...document.querySelectorAll("#found a")].map((a) => a.getAttribute("href"))'
ASK = """(() => { const box = document.getElementById("search"); box.value = %r;
  box.dispatchEvent(new Event("input")); })()"""


def narrow_problems(page, file):
    page.open(file)
    name = file.relative_to(SITE)
    if page.run("document.documentElement.scrollWidth > innerWidth"):
        yield f"{name} scrolls sideways at 400 px"
    for cut in page.run(CUT):
        yield f"{name} is cut at 400 px: {cut}"
    for complaint in page.complaints():
        yield f"{name}: the console says {complaint}"


def answers(page):
    """The addresses that the page itself shows for each question."""
    page.open(SITE / "index.html")
    page.run(ASK % "packing")  # which loads the index
    for _ in range(100):
        if page.run(FOUND):
            break
        page.settle(0.1)
    for question in search.QUESTIONS:
        page.run(ASK % question)
        yield page.run(FOUND)


def main():
    pictures = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
    files = sorted(file for file in SITE.rglob("*.html") if "files" not in file.relative_to(SITE).parts)
    problems = [] if len(files) > 50 else [f"there are only {len(files)} pages"]
    for width, height, dark in ((400, 800, False), (1280, 900, True)):
        with chromium.Browser(width=width, height=height, dark=dark) as page:
            if width == 400:
                for file in files:
                    problems += narrow_problems(page, file)
            for name in SHOWN if pictures else []:
                page.open(SITE / f"{name}.html")
                pictures.mkdir(parents=True, exist_ok=True)
                page.screenshot(pictures / f"{name.replace('/', '_')}_{width}.png")
            problems += search.problems_of(list(answers(page)))
    print("\n".join(problems) or f"{len(files)} pages are as they should be at 400 px; {len(search.QUESTIONS)} questions find theirs")
    sys.exit(bool(problems))


main()
