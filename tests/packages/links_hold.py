#!/usr/bin/python3
"""Whether every link of installed pages leads to a file that is installed: links_hold.py FOLDER, that of the README."""

import pathlib
import re
import sys
import urllib.parse

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE.parent / "guide"), str(HERE.parents[1] / "data/guide/site")]
import check  # noqa: E402
import links  # noqa: E402

folder = pathlib.Path(sys.argv[1]).resolve()
pages = [page for page in sorted(folder.rglob("*.md")) if "site" not in page.relative_to(folder).parts]
problems, count = [], 0
for page in pages:
    for link in links.LINK.findall(links.prose_of(page.read_text())):
        path = urllib.parse.unquote(link).partition("#")[0]
        if re.match(r"[a-z]+:", link) or not path:
            continue
        count += 1
        target = (page.parent / path).resolve()
        if not target.exists() or not target.is_relative_to(folder):
            problems.append(f"{page}: {link} leads nowhere")
problems += check.problems_of(folder / "site")
print("\n".join(problems) or f"{count} links of {len(pages)} pages, and those of the site, lead somewhere")
sys.exit(bool(problems) or count < 100)
