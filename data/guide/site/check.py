"""Whether every link and picture of a site leads to a file that is there, and to a place in it."""

import html.parser
import pathlib
import re
import sys
import urllib.parse


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


def problems_of(folder):
    pages = {file: read(file) for file in sorted(folder.rglob("*.html")) if "files" not in file.relative_to(folder).parts}
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


if __name__ == "__main__":
    found = problems_of(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(found) or "every link leads somewhere")
    sys.exit(bool(found))
