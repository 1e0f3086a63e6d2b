#!/usr/bin/python3
"""Whether every link in the project's Markdown leads to a file that is there, and to a heading in it."""

import pathlib
import re
import sys
import urllib.parse

SOURCE = pathlib.Path(sys.argv[1]).resolve()
LINK = re.compile(r"\]\(([^()\s]+(?:\([^()]*\)[^()\s]*)*)\)")


def prose_of(text):
    """Without blocks of code and code in lines."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.S | re.M)
    return re.sub(r"`[^`\n]*`", "", text)


def anchors_of(text):
    """Of the headings, as GitHub and pandoc's gfm make them."""
    anchors, counts = set(), {}
    for heading in re.findall(r"^#+ +(.*?) *$", re.sub(r"^```.*?^```$", "", text, flags=re.S | re.M), flags=re.M):
        plain = re.sub(r"<[^>]*>|\[([^\]]*)\]\([^)]*\)|[`*]", lambda m: m[1] or "", heading)
        slug = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        number = counts.get(slug, 0)
        counts[slug] = number + 1
        anchors.add(slug if number == 0 else f"{slug}-{number}")
    return anchors


def main():
    files = [SOURCE / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "src/README.md")]
    files += sorted(SOURCE.glob("data/**/*.md")) + sorted(SOURCE.glob("tests/bench/*.md"))
    problems, links = [], 0
    for file in files:
        for link in LINK.findall(prose_of(file.read_text())):
            links += 1
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = urllib.parse.unquote(link).partition("#")
            target = (file.parent / path).resolve() if path else file
            if not target.exists() or not target.is_relative_to(SOURCE):
                problems.append(f"{file}: {link} leads nowhere")
            elif anchor and target.suffix == ".md" and anchor not in anchors_of(target.read_text()):
                problems.append(f"{file}: {link}: no heading makes that anchor")
    print("\n".join(problems) or f"{links} links in {len(files)} files lead somewhere")
    sys.exit(bool(problems) or links < 50)


if __name__ == "__main__":
    main()
