#!/usr/bin/python3
"""Whether every link and picture of a site leads to a file that is there, and to a place in it; and, where tidy is
installed, whether its HTML is right.

  data/guide/site/check.py SITE
"""

import html.parser
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse
from concurrent.futures import ThreadPoolExecutor


class Reader(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.ids, self.links = [], []

    def handle_starttag(self, tag, attributes):
        of = dict(attributes)
        if "id" in of:
            self.ids.append(of["id"])
        self.links += [of[name] for name in ("href", "src") if of.get(name)]


def read(file):
    reader = Reader()
    reader.feed(file.read_text())
    return reader


def pages_of(folder):
    return sorted(page for page in folder.rglob("*.html") if "files" not in page.relative_to(folder).parts)


def problems_of(folder):
    pages = {file: read(file) for file in pages_of(folder)}
    problems = []
    for file, page in pages.items():
        for name in sorted({i for i in page.ids if page.ids.count(i) > 1}):
            problems.append(f"{file}: two places are called {name}")
        for link in page.links:
            if re.match(r"(https?|mailto):", link):
                continue
            path, _, anchor = urllib.parse.unquote(link).partition("#")
            target = (file.parent / path).resolve() if path else file
            if not target.is_file():
                problems.append(f"{file}: {link} leads nowhere")
            elif anchor and target in pages and anchor not in pages[target].ids:
                problems.append(f"{file}: no place is called {link}")
    return problems


# Newer pandoc writes the attribute, which HTML has; tidy does not know that.
MISTAKEN = '<ol> attribute "type" not allowed for HTML5'


def tidied(folder):
    """What tidy says of the pages; nothing where it is not installed."""
    if not shutil.which("tidy"):
        return []

    def complaints(page):
        said = subprocess.run(["tidy", "-quiet", "-errors", "--show-warnings", "yes", "--drop-empty-elements", "no",
                               "--warn-proprietary-attributes", "no", page], capture_output=True, text=True).stderr
        return [f"{page}: {line}" for line in said.splitlines() if MISTAKEN not in line]

    with ThreadPoolExecutor() as pool:
        return sum(pool.map(complaints, pages_of(folder)), [])


if __name__ == "__main__":
    site = pathlib.Path(sys.argv[1]).resolve()
    pages = len(pages_of(site))
    found = problems_of(site) + tidied(site)
    print("\n".join(found) or f"{pages} pages, every link leads somewhere")
    sys.exit(bool(found) or pages < 50)
